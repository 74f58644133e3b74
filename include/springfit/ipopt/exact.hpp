// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <variant>

#include <springfit/core/progress.hpp>
#include <springfit/fit/acceleration/problem.hpp>

namespace springfit::ipopt {

struct ExactOptions {
    /// KKT residual up to which the status is `converged`, in (0, 1); elsewhere it is `stalled`.
    double tolerance = 1e-9;
    int max_iterations = 200;    ///< >= 0
    Values<double> initial{};    ///< start, moved into the bounds [n_unknowns]; empty: the prior
    int print_level = 0;         ///< what Ipopt writes to standard output, 0 (nothing) to 12
    ProgressCallback progress{}; ///< called once per iteration
    /// Further options of Ipopt by its own names; they win over what this header sets.
    std::map<std::string, std::variant<std::string, double, int>> ipopt{};
};

/// The exact fit: the global minimiser of Phi over the bounds, by Ipopt's interior-point method with exact gradient and
/// the constant exact sparse Hessian. Unknowns are scaled to unit curvature and the objective to unit size, so that
/// stiffness and damping may differ by orders of magnitude.
///
/// Ipopt's point is then polished by an active set that starts there, since an interior point keeps a gap from bounds.
/// `theta` is within the bounds to the last bit. Where the callback asks to stop, the best point so far is returned
/// with the status `interrupted`; an exception from the callback ends the solve and is thrown on. Throws
/// InvalidArgument for an option that Ipopt refuses and for an `initial` of the wrong size or not finite. Cost per
/// iteration: one sparse factorisation of the Hessian.
[[nodiscard]] AccelerationReport exact(const AccelerationProblem& problem, const ExactOptions& options = {});

} // namespace springfit::ipopt

#include <springfit/ipopt/detail/exact_impl.hpp>
