// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/motion/state.hpp>
#include <springfit/simulate/detail/clamped_stiffness.hpp>

namespace springfit {

template <int Dim, std::floating_point Scalar>
struct EquilibriumOptions {
    Scalar time = 0;                 ///< when the loads and clamps are read, s
    Points<Dim, Scalar> start{};     ///< first guess [Dim x n_nodes], m; empty: the scenario's initial positions
    Scalar tolerance = Scalar(1e-8); ///< largest unbalanced force relative to the largest load or spring force, > 0;
                                     ///< rounding of the positions is the floor
    int max_iterations = 500;        ///< Newton iterations, >= 1
};

/// The rest of a network under loads.
template <int Dim, std::floating_point Scalar>
struct Equilibrium {
    Status status = Status::failed;
    Points<Dim, Scalar> positions; ///< [Dim x n_nodes], m
    Scalar residual = 0;           ///< largest unbalanced force component, N
    int iterations = 0;
    /// The stiffness at `positions` is positive definite well above rounding. Where it is not, there is a mechanism (a
    /// motion that no spring resists), a free rigid motion or an instability: the positions are one of many, or a
    /// saddle.
    bool stable = false;
};

/// A network whose energy has lengths at rest: `SpringNetwork` or `BiquadraticNetwork`.
template <class N>
concept ElasticNetwork = requires(const N& network) {
    network.rest_positions;
    network.rest_length;
    network.mass;
};

namespace detail {

/// True where the smallest eigenvalue, found by a few inverse iterations, stands clear of rounding.
template <std::floating_point Scalar>
bool is_positive_definite(SymmetricSolver<Scalar>& solver, const SparseMatrix<Scalar>& lower) {
    if (lower.cols() == 0) {
        return true;
    }
    if (!solver.factorise(lower) || solver.shift() > 0) {
        return false;
    }
    Values<Scalar> x(lower.cols());
    for (Index i = 0; i < x.size(); ++i) {
        x(i) = std::sin(static_cast<Scalar>(i) + 1); // any vector that is orthogonal to nothing in particular
    }
    x.normalize();
    Scalar growth = 0;
    for (int iteration = 0; iteration < 8; ++iteration) {
        x = solver.apply_factor(x).eval();
        growth = x.norm();
        x /= growth;
    }
    const Scalar largest = lower.diagonal().maxCoeff();
    return std::isfinite(growth) && 1 / growth > 1000 * std::numeric_limits<Scalar>::epsilon() * largest;
}

/// Throws InvalidArgument for a scenario or option that does not fit the network.
template <class Network, int Dim, std::floating_point Scalar>
void check(const Network& network, const Scenario<Dim, Scalar>& scenario,
           const EquilibriumOptions<Dim, Scalar>& options) {
    validate(scenario, network.n_nodes());
    require(options.tolerance > 0, "tolerance", "a positive tolerance", options.tolerance);
    require(options.max_iterations > 0, "max_iterations", "at least one", options.max_iterations);
    require(options.start.size() == 0 || options.start.cols() == network.n_nodes(), "start",
            text(network.n_nodes(), " columns, one per node"), options.start.cols());
}

/// The farthest that a network that is held at all may go from its start, m: a thousand times its size.
template <class Network, int Dim, std::floating_point Scalar>
Scalar reach(const Network& network, const Points<Dim, Scalar>& start) {
    const auto extent = [](const Points<Dim, Scalar>& x) {
        return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
    };
    const Scalar longest = network.rest_length.size() > 0 ? network.rest_length.maxCoeff() : Scalar(0);
    return 1000 * (extent(network.rest_positions) + extent(start) + longest);
}

/// The same as the function of this name, for a scenario whose clamped nodes are those of `held`. Whether it is stable
/// is found where `find_stability` says so; that takes a factorisation of its own.
template <class Network, int Dim, std::floating_point Scalar>
Equilibrium<Dim, Scalar> equilibrium(const ClampedStiffness<Network>& held, const Scenario<Dim, Scalar>& scenario,
                                     const EquilibriumOptions<Dim, Scalar>& options, bool find_stability) {
    const auto& network = held.network();
    const FreeNodes& free = held.free_nodes();
    check(network, scenario, options);
    Equilibrium<Dim, Scalar> result;
    result.positions = options.start.size() > 0 ? options.start : initial_positions(scenario, network.rest_positions);
    apply_clamps<Dim, Scalar>(scenario, network.rest_positions, options.time, result.positions);
    if (free.n_free() == 0) {
        result.status = Status::converged;
        result.stable = true;
        return result;
    }
    const Points<Dim, Scalar> external = external_forces<Dim, Scalar>(scenario, network.mass, options.time);
    auto potential = held.potential();
    potential.set_statics(network, result.positions, external, Scalar(statics_floor));
    potential.set_reach(reach(network, result.positions));
    potential.start_exact();
    Values<Scalar> x = free.template gather<Dim, Scalar>(result.positions);
    Values<Scalar> gradient(x.size());
    potential.gradient(x, gradient);
    const Scalar force = std::max(gradient.template lpNorm<Eigen::Infinity>(), external.cwiseAbs().maxCoeff());
    const Scalar rounding = potential.gradient_rounding(result.positions);
    potential.set_exact_below(Scalar(1e-2) * force);
    CorotatedSolver<Dim, Scalar> solver;
    solver.set_factor(held.factor());
    NewtonOptions<Scalar> newton;
    newton.max_iterations = options.max_iterations;
    newton.gradient_tolerance = std::max(options.tolerance * force, rounding / 16);
    newton.loose_tolerance = Scalar(0.1);
    const auto report = minimise(potential, x, solver, newton);
    const bool at_rounding = usable(report.status) && report.gradient_max <= 64 * rounding;
    result.status = at_rounding ? Status::converged : report.status;
    result.iterations = report.iterations;
    result.residual = report.gradient_max;
    free.template scatter<Dim, Scalar>(x, result.positions);
    if (find_stability && usable(result.status)) {
        potential.set_statics(network, result.positions, external);
        potential.set_exact_below(std::numeric_limits<Scalar>::infinity());
        potential.gradient(x, gradient);
        result.stable = is_positive_definite<Scalar>(solver.fallback(), potential.hessian(x));
    }
    return result;
}

} // namespace detail

/// The static equilibrium of a network under a scenario at one time: the minimum of the potential energy
/// E(x) - f_ext . x over the free nodes, by Newton's method with a line search. Its linear systems are solved by
/// conjugate gradients with the factor of the stiffness at rest, turned with the body.
///
/// The network need not hold a shape, as springs alone, or a flat
/// membrane across its plane: see `Equilibrium::stable`. Where the matrix is singular or indefinite, Newton's step
/// still goes downhill. Status `converged` only where the forces balance, to `tolerance` or to rounding; `diverged`
/// where a node goes farther than a thousand times the network's size, which nothing holds then. Throws InvalidArgument
/// for a scenario or option that does not fit.
template <ElasticNetwork Network>
[[nodiscard]] auto equilibrium(const Network& network,
                               const Scenario<Network::dimension, typename Network::Scalar>& scenario,
                               const EquilibriumOptions<Network::dimension, typename Network::Scalar>& options = {})
    -> Equilibrium<Network::dimension, typename Network::Scalar> {
    validate(network);
    detail::check(network, scenario, options);
    const detail::ClampedStiffness<Network> held(network, clamped_nodes(scenario, network.n_nodes()));
    return detail::equilibrium(held, scenario, options, true);
}

} // namespace springfit
