// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <variant>

#include <springfit/fit/trajectory/gauss_newton.hpp>

namespace springfit::ipopt {

struct TrajectoryFitOptions {
    /// Largest entry of the gradient up to which the status is `converged`, in (0, 1), of the scaled problem: 1 at the
    /// start.
    double tolerance = 1e-4;
    int max_iterations = 300; ///< >= 0
    int memory = 30;          ///< pairs of gradients that the approximate Hessian is made of, >= 1
    /// Trial points with an entry of theta farther than this from the best so far are stepped back from unseen; > 0.
    double max_step = 1.5;
    int probes = 16;             ///< random vectors for the curvature that scales the unknowns, >= 1
    int print_level = 0;         ///< what Ipopt writes to standard output, 0 (nothing) to 12
    ProgressCallback progress{}; ///< called once per iteration; may end the search with the best so far
    /// Further options of Ipopt by its own names; they win over what this header sets.
    std::map<std::string, std::variant<std::string, double, int>> ipopt{};
};

/// Trajectory matching by Ipopt's interior-point method [Waechter2006] with the exact adjoint gradient and a
/// limited-memory Hessian: the problem of `gauss_newton`, for many unknowns and for bounds that bind.
///
/// Starts where `gauss_newton` does. Unknowns are scaled to unit curvature there and the objective to a largest
/// gradient of 1. A trial point that is singular, unstable or does not come to balance is backtracked from; static
/// equilibria are looked for next to those of the best point so far. What is returned is the best stable point that was
/// simulated, never worse than the prior, within the bounds to the last bit and on a bound where that is better;
/// `status` is `failed` where there is nothing to start from. `history` is J of Ipopt's iterates, which need not fall
/// each time. An exception from the callback ends the solve and is thrown on.
///
/// Throws InvalidArgument for an option out of range or one that Ipopt refuses. Cost per trial point: one simulation of
/// all cases, one adjoint, one factorisation per set of clamps; memory: that of two points, and 2 `memory` n_unknowns.
template <int Dim>
[[nodiscard]] TrajectoryReport trajectory(const TrajectoryProblem<Dim>& problem,
                                          const TrajectoryFitOptions& options = {});

} // namespace springfit::ipopt

#include <springfit/ipopt/detail/trajectory_impl.hpp>
