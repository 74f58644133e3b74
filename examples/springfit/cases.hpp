// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <springfit/core/execution.hpp>
#include <springfit/io/json_value.hpp>
#include <springfit/motion/motion.hpp>

#include "reference.hpp"

namespace program {

/// Load cases with the reference's motion under each.
template <int Dim>
struct CaseSet {
    std::vector<springfit::Scenario<Dim, double>> scenarios;
    std::vector<springfit::Motion<Dim, double>> motions;
};

/// What the reference did, split into what the fit sees and what it does not.
template <int Dim>
struct ReferenceCases {
    CaseSet<Dim> training;
    CaseSet<Dim> held_out;
    double stiffness_damping = 0; ///< beta, s, of the reference; as far as it is known
    bool interrupted = false;     ///< not all cases that were asked for are there
    std::vector<std::string> warnings;
    springfit::io::Json description; ///< for the report
};

/// Records the FEM reference under random load cases, scaled to the wanted deformation and to the body's own time.
/// `body` is that of the reference; `network` sets the damping that is light for its springs, where no other was asked
/// for. Equilibria whose clamped nodes `holds` does not accept are left out, with a warning.
template <int Dim>
[[nodiscard]] ReferenceCases<Dim>
record_cases(const FemReference<Dim>& reference, springfit::Specimen<Dim, double> body,
             const Discretisation<Dim>& network, const FitOptions& options, const springfit::Execution& execution,
             const std::function<bool(const std::vector<int>&)>& holds);

/// Splits recorded motions: the last quarter of several, or the last third of the time of a single one, is held out.
/// Throws InvalidArgument where a motion has another number of nodes than the body, or too few frames.
template <int Dim>
[[nodiscard]] ReferenceCases<Dim> split_recorded(std::vector<springfit::Motion<Dim, double>> motions,
                                                 const Discretisation<Dim>& body, const FitOptions& options);

} // namespace program
