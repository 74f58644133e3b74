// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <springfit/calibrate/calibrate.hpp>
#include <springfit/io/calibration_json.hpp>

#include "body.hpp"

namespace program {

/// Reads a recorded motion for trial, in a process of its own: HDF5 crashes on some files that are damaged. Throws
/// FileError where it does; what else is wrong shows when it is read in earnest. To be called before there are threads.
void try_to_read(const std::string& path);

/// A recorded motion in SI units, by `--unit` and `--time-unit`, with what there is to say of it.
template <int Dim>
[[nodiscard]] springfit::io::RecordedMotion<Dim, double>
read_recorded(const std::string& path, const FitOptions& options, std::vector<springfit::Warning>& warnings);

/// The masses of the nodes, kg, that `--mass-from` names. Throws FileError.
[[nodiscard]] springfit::Values<double> read_masses(const std::string& path, springfit::Index n_nodes);

/// The nodes of a finer reference, its surface, and its own motions in the held-out cases.
template <int Dim>
struct FineSide {
    springfit::FineNodes<Dim> nodes;
    FineSurface<Dim> surface;
    springfit::CaseSet<Dim, double> held_out;
};

/// Puts the motion of the reference and of the fitted network under the first held-out case into the files of a run, as
/// far as both go, and where there is a surface that the network carries the same at its points. Says where the network
/// does not come as far as the reference.
template <int Dim>
void write_shown_motion(springfit::io::OutputGroup& outputs, const std::filesystem::path& folder,
                        const springfit::io::MotionTopology& topology, const springfit::Calibration<Dim>& calibration,
                        const std::optional<FineSide<Dim>>& fine, std::vector<std::string>& warnings);

/// The table of candidates and the errors of the chosen one by kind of case, to standard output.
template <int Dim>
void print_table(const springfit::Calibration<Dim>& calibration);

} // namespace program
