// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>

#include <springfit/core/execution.hpp>
#include <springfit/fit/problem.hpp>
#include <springfit/fit/trajectory.hpp>
#include <springfit/io/report_json.hpp>

#include "cases.hpp"

namespace program {

/// A calibrated network with its errors on motion.
template <int Dim>
struct Candidate {
    std::string name;
    springfit::SpringNetwork<Dim, double> network;
    std::optional<springfit::FitReport> fit;               ///< empty for a closed form
    std::optional<springfit::TrajectoryReport> trajectory; ///< of matching motion alone
    springfit::Values<double> data_share; ///< of each spring, of matching motion: above 1/2 the data sets its stiffness
    springfit::Index n_clamped = 0;       ///< springs of a closed form that would be negative and are 0
    std::string caveat;                   ///< for what a closed form is exact, where not for this body
    double seconds = 0;
    double held_out = std::numeric_limits<double>::infinity(); ///< until it is scored in full
    double training = std::numeric_limits<double>::infinity();
    std::vector<double> held_out_cases; ///< error of each held-out case on its own, once scored
    /// Elastic energy in the reference's training motion beside that of the first closed form: below 1 the springs
    /// resist that motion less.
    double relative_stiffness = 1;
};

/// Every candidate that `options.method` asks for, closed forms first, unscored. A Ctrl-C ends it early with those that
/// are there. Throws InvalidArgument where no closed form holds and one was asked for.
template <int Dim>
[[nodiscard]] std::vector<Candidate<Dim>> make_candidates(const Discretisation<Dim>& body,
                                                          const ReferenceCases<Dim>& cases, const FitOptions& options,
                                                          const springfit::Execution& execution);

/// Fills in the errors of every candidate on the held-out load cases, fits first, and then on at most 12 of the
/// training's, evenly spread; a Ctrl-C leaves those not reached infinite. A candidate that fails on held-out motion is
/// not tried on the training's.
template <int Dim>
void score(std::vector<Candidate<Dim>>& candidates, const ReferenceCases<Dim>& cases,
           const springfit::Execution& execution);

/// Error of a candidate on the parts of the held-out set: motions in time, equilibria under loads of the kinds that
/// training has, equilibria under kinds that it never shows; those that there are.
template <int Dim>
[[nodiscard]] springfit::io::NamedNumbers held_out_parts(const Candidate<Dim>& candidate, const CaseSet<Dim>& held_out);

/// The report's part on one candidate.
[[nodiscard]] springfit::io::Json describe(const springfit::FitReport& fit);
[[nodiscard]] springfit::io::Json describe(const springfit::TrajectoryReport& fit);

/// Matches the network's own motion to that of the training cases: their equilibria where there are any, else windows
/// of the recorded motions. Starts from `prior`. No value where not even that can be simulated.
template <int Dim>
[[nodiscard]] std::optional<Candidate<Dim>> match_motion(const springfit::SpringNetwork<Dim, double>& prior,
                                                         const ReferenceCases<Dim>& cases, const FitOptions& options,
                                                         const springfit::Execution& execution);

} // namespace program
