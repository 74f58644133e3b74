// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/execution.hpp>
#include <springfit/core/progress.hpp>
#include <springfit/fit/acceleration/problem.hpp>

namespace springfit {

/// The start of the sweeps.
enum class SweepStart {
    one_pass, ///< the result of `one_pass`
    given,    ///< `initial`, or the prior where that is empty
    better    ///< whichever of the two has the lower Phi
};

struct OnePassOptions {
    double tolerance = 1e-6; ///< KKT residual up to which the status is `converged`
    Execution execution{};   ///< nodes are independent of each other
};

struct DominantTermOptions {
    int max_sweeps = 50;     ///< budget, >= 0
    double tolerance = 1e-9; ///< stop when `kkt_residual` is not above it
    SweepStart start = SweepStart::one_pass;
    Values<double> initial{};    ///< moved into the bounds [n_unknowns]
    Execution execution{};       ///< for the one pass
    ProgressCallback progress{}; ///< called after every sweep
};

/// The dominant-term approximation, one pass: each node term is minimised on its own over the unknowns at the node,
/// within the bounds; the estimates that an unknown gets from its nodes are averaged with weights
///
///     1 / [H_i^-1]_uu ,
///
/// the curvature of Phi_i along u with all others at the node free. Directions that a node does not determine are
/// taken from the prior and have no weight. Exact where the motion is one of a spring model within the bounds and every
/// unknown is determined at one of its nodes at least. Elsewhere Phi may be above that of the prior.
/// O(nodes * (unknowns at a node)^3); the same bits on any number of threads.
template <std::same_as<AccelerationProblem> Problem>
[[nodiscard]] AccelerationReport one_pass(const Problem& problem, const OnePassOptions& options = {});

/// The dominant-term approximation with sweeps: block descent on Phi. A block is the set of unknowns at a node; each
/// sweep visits every block once, next always the one whose node term is largest now, and minimises Phi over it
/// within the bounds. Phi never rises, and the sweeps converge to the exact minimiser (docs/theory.md). Status
/// `diverged` where the residual is not a number.
/// O(nodes * (unknowns at a node)^3) per sweep. Throws InvalidArgument where `initial` has the wrong size or is NaN.
template <std::same_as<AccelerationProblem> Problem>
[[nodiscard]] AccelerationReport dominant_term(const Problem& problem, const DominantTermOptions& options = {});

} // namespace springfit

#include <springfit/fit/acceleration/detail/one_pass.hpp>
#include <springfit/fit/acceleration/detail/sweeps.hpp>
