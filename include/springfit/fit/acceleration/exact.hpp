// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/execution.hpp>
#include <springfit/core/progress.hpp>
#include <springfit/fit/acceleration/problem.hpp>

namespace springfit {

struct ExactOptions {
    /// KKT residual up to which the status is `converged`, in (0, 1).
    double tolerance = 1e-10;
    int max_iterations = 500;    ///< active sets, >= 0
    Values<double> initial{};    ///< start, moved into the bounds [n_unknowns]; empty: the prior
    Execution execution{};       ///< for sweeps and products; the bits do not depend on the number of threads
    ProgressCallback progress{}; ///< called once per active set and now and then while its equations are solved
};

/// The exact fit: the global minimiser of Phi over the bounds, by a primal-dual active set. What
///
///     theta - diag(H)^-1 grad Phi(theta)
///
/// takes beyond a bound is put on that bound; for the rest, H_FF theta_F = g_F - H_FA theta_A is solved; until the set
/// stays and the KKT residual is small. The equations are solved by conjugate gradients under sweeps of symmetric
/// Gauss-Seidel [Eisenstat1981], no more accurately than the set deserves, and by sparse Cholesky once they converge so
/// slowly that factorisations are expected to be quicker (`AccelerationReport::factorisations`). Where the sets do not
/// settle, a pull to the best point so far is added, stage after stage a smaller one (docs/theory.md).
///
/// The objective is never above that of the start, and theta within the bounds to the last bit. The status is
/// `converged` up to `tolerance`, `stalled` where rounding allows no more, `iteration_limit`, or `diverged` where the
/// residual is not a number; where the callback asks to stop, the best point so far is returned with the status
/// `interrupted`. Throws InvalidArgument for an option out of range and for an `initial` of the wrong size or not
/// finite. Cost: some tens to hundreds of products with H, each O(nodes * (unknowns at a node)^2); memory, twice that
/// of the problem beside it; with Cholesky, a few factorisations, O(n^2) in space.
template <std::same_as<AccelerationProblem> Problem>
[[nodiscard]] AccelerationReport exact(const Problem& problem, const ExactOptions& options = {});

} // namespace springfit

#include <springfit/fit/acceleration/detail/exact_impl.hpp>
