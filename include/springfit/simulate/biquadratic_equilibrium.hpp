// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/simulate/detail/biquadratic_potential.hpp>
#include <springfit/simulate/equilibrium.hpp>

namespace springfit {

/// The static equilibrium of a biquadratic network under a scenario at one time: the minimum of W(x) - f_ext . x over
/// the free nodes, by Newton's method with a line search.
///
/// Options and report are those of springs. A flat membrane resists forces across its plane only once it is stretched;
/// Newton's step is regularised there. Throws InvalidArgument for a scenario or option that does not fit.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Equilibrium<Dim, Scalar> equilibrium(const BiquadraticNetwork<Dim, Scalar>& network,
                                                   const Scenario<Dim, Scalar>& scenario,
                                                   const EquilibriumOptions<Dim, Scalar>& options = {}) {
    validate(network);
    validate(scenario, network.n_nodes());
    require(options.tolerance > 0, "tolerance", "a positive tolerance", options.tolerance);
    require(options.max_iterations > 0, "max_iterations", "at least one", options.max_iterations);
    require(options.start.size() == 0 || options.start.cols() == network.n_nodes(), "start",
            text(network.n_nodes(), " columns, one per node"), options.start.cols());

    Equilibrium<Dim, Scalar> result;
    result.positions = options.start.size() > 0 ? options.start : initial_positions(scenario, network.rest_positions);
    apply_clamps<Dim, Scalar>(scenario, network.rest_positions, options.time, result.positions);
    const FreeNodes free(network.n_nodes(), clamped_nodes(scenario, network.n_nodes()));
    if (free.n_free() == 0) {
        result.status = Status::converged;
        result.stable = true;
        return result;
    }
    const Points<Dim, Scalar> external = external_forces<Dim, Scalar>(scenario, network.mass, options.time);
    detail::BiquadraticPotential<Dim, Scalar> potential(network, free, result.positions, external, Scalar(1e-9));
    Values<Scalar> x = free.template gather<Dim, Scalar>(result.positions);
    Values<Scalar> gradient(x.size());
    potential.gradient(x, gradient);
    const Scalar force = std::max(gradient.template lpNorm<Eigen::Infinity>(), external.cwiseAbs().maxCoeff());
    const Scalar rounding = potential.gradient_rounding();
    SymmetricSolver<Scalar> solver;
    NewtonOptions<Scalar> newton;
    newton.max_iterations = options.max_iterations;
    newton.gradient_tolerance = std::max(options.tolerance * force, 4 * rounding);
    potential.set_exact_below(Scalar(1e-2) * force);
    const auto report = minimise(potential, x, solver, newton);
    const bool at_rounding = usable(report.status) && report.gradient_max <= 64 * rounding;
    result.status = at_rounding ? Status::converged : report.status;
    result.iterations = report.iterations;
    result.residual = report.gradient_max;
    free.template scatter<Dim, Scalar>(x, result.positions);
    potential.set_floor(0);
    potential.set_exact_below(std::numeric_limits<Scalar>::infinity());
    potential.gradient(x, gradient);
    result.stable = usable(result.status) && detail::is_positive_definite<Scalar>(solver, potential.hessian(x));
    return result;
}

} // namespace springfit
