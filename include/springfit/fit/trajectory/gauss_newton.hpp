// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/progress.hpp>
#include <springfit/fit/trajectory/problem.hpp>
#include <springfit/fit/trajectory/report.hpp>

namespace springfit {

/// The form of the Gauss-Newton matrix.
enum class GaussNewtonForm {
    automatic,  ///< dense where `TrajectoryPoint::has_dense`, else matrix-free
    dense,      ///< the Hadamard form and a Cholesky factor
    matrix_free ///< conjugate gradients on products
};

struct GaussNewtonOptions {
    int max_iterations = 40;
    /// Stop when an iteration lowers J by less than this part, twice running, and gains do not grow; > 0.
    double tolerance = 1e-3;
    GaussNewtonForm form = GaussNewtonForm::automatic;
    int max_cg_iterations = 40;  ///< of each matrix-free step
    double cg_tolerance = 0.05;  ///< relative residual of each matrix-free step, in (0, 1)
    double max_step = 1.5;       ///< largest change of an entry of theta in one iteration, > 0
    Values<double> start{};      ///< theta to start from [n_unknowns]; empty: the prior, or a stiffer one
    int probes = 16;             ///< random vectors for the diagonal in matrix-free form, >= 1
    ProgressCallback progress{}; ///< asked before each product; may end the search with the best so far
};

/// Trajectory matching by a damped Gauss-Newton method (Levenberg and Marquardt) with exact gradients, projected onto
/// the bounds.
///
/// Each iteration: one simulation of all cases, one adjoint, one factorisation per set of clamps; a dense Hadamard
/// matrix for small static problems (n_unknowns^2 memory), else at most `max_cg_iterations` products of two solves per
/// case. A trial point that is worse, singular, unstable or diverging is stepped back from by raising the damping, and
/// is never returned. Starts from the prior, or from 2, 4 or 8 times its stiffness where the prior fails or that halves
/// J. Deterministic.
template <int Dim>
[[nodiscard]] TrajectoryReport gauss_newton(const TrajectoryProblem<Dim>& problem,
                                            const GaussNewtonOptions& options = {});

/// Gives a network the values that a trajectory fit found; in its own scalar. Throws InvalidArgument unless the network
/// has as many nodes, springs and cells as the one that the problem was made from.
template <int Dim, std::floating_point Scalar>
void apply(const TrajectoryProblem<Dim>& problem, const TrajectoryReport& report, SpringNetwork<Dim, Scalar>& network) {
    const SpringNetwork<Dim, double> fitted = problem.parameters().network(report.theta);
    const auto size = [](const auto& any) {
        return text(any.n_nodes(), " nodes, ", any.n_springs(), " springs and ", any.n_cells(), " cells");
    };
    require(size(network) == size(fitted), "network", size(fitted), size(network));
    network.stiffness = fitted.stiffness.template cast<Scalar>();
    network.damping = fitted.damping.template cast<Scalar>();
    network.rest_length = fitted.rest_length.template cast<Scalar>();
    network.volume_stiffness = fitted.volume_stiffness.template cast<Scalar>();
}

} // namespace springfit

#include <springfit/fit/trajectory/detail/gauss_newton_impl.hpp>
