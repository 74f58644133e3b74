// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include <springfit/calibrate/options.hpp>
#include <springfit/mesh/mesh.hpp>
#include <springfit/motion/transfer.hpp>

#include "report.hpp"

/// The accuracy study: every method on every mesh, material, resolution and setup, scored on motion it has not seen.
namespace study {

using springfit::Index;

struct Settings {
    bool quick = false;         ///< a few small rows of each part
    std::filesystem::path data; ///< folder of surfaces; empty: parts that need them are skipped
    unsigned seed = 1;
    springfit::Execution execution{};
};

/// True once the user asked to stop.
[[nodiscard]] bool interrupted();

/// What `stop_if_interrupted` throws; what was not yet reported is lost, what was is on disk.
struct Interrupted {};

/// Throws Interrupted once the user asked to stop.
void stop_if_interrupted();

/// Ends long work once the user asked to stop.
[[nodiscard]] springfit::ProgressCallback until_interrupted();

// The parts.

void study_plane(Report& report, const Settings& settings);
void study_solids(Report& report, const Settings& settings);
void study_surfaces(Report& report, const Settings& settings);
void study_setups(Report& report, const Settings& settings);
void study_recovery(Report& report, const Settings& settings);
void study_dynamics(Report& report, const Settings& settings);
void study_coarse(Report& report, const Settings& settings);
void study_strangers(Report& report, const Settings& settings);
void study_time(Report& report, const Settings& settings);

// What needs CGAL, in the one translation unit that includes it; without CGAL, boxes and rectangles are cut from
// jittered grids, and there is nothing else.

[[nodiscard]] springfit::Mesh<2, double, springfit::Tri3> rectangle_mesh(double length, double height, Index n_nodes);
/// With a round hole in its middle; without CGAL, without the hole.
[[nodiscard]] springfit::Mesh<2, double, springfit::Tri3> perforated_rectangle(double length, double height,
                                                                               double radius, Index n_nodes);
[[nodiscard]] springfit::Mesh<3, double, springfit::Tet4> box_mesh(const std::array<double, 3>& size, Index n_nodes);
/// Two boxes side by side along x; nothing without CGAL.
[[nodiscard]] std::optional<springfit::Mesh<3, double, springfit::Tet4>>
two_boxes_mesh(const std::array<double, 3>& size, double apart, Index n_nodes);
/// A ring around z with a round section, of the radius of its middle line and that of the section; nothing without
/// CGAL.
[[nodiscard]] std::optional<springfit::Mesh<3, double, springfit::Tet4>> ring_mesh(double radius, double section,
                                                                                   Index n_nodes);
/// The inside of a surface; nothing, with the reason on standard output, where there is no such file or no solid.
[[nodiscard]] std::optional<springfit::Mesh<3, double, springfit::Tet4>> solid_mesh(const std::filesystem::path& path,
                                                                                    Index n_nodes);
/// Interpolation from the nodes of a mesh at points; nothing without CGAL.
[[nodiscard]] std::optional<springfit::Interpolation<double>>
interpolation_at(const springfit::Mesh<3, double, springfit::Tet4>& mesh, const springfit::Points<3, double>& points);

/// Jittered hexahedra cut into tetrahedra at random, which favours no direction.
[[nodiscard]] springfit::Mesh<3, double, springfit::Tet4>
random_cut_box(const std::array<int, 3>& cells, const std::array<double, 3>& size, unsigned seed);

/// The exact minimiser of the acceleration fit by Ipopt, the reference; empty where it is not built in, which takes the
/// library's own.
[[nodiscard]] springfit::ExactSolver exact_solver();

} // namespace study
