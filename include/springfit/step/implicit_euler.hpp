// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <springfit/step/detail/driven_scenario.hpp>
#include <springfit/step/detail/spring_potential.hpp>

namespace springfit {

template <std::floating_point Scalar>
struct ImplicitEulerOptions {
    Scalar tolerance = Scalar(1e-8); ///< largest unbalanced force relative to the largest force that moves a node, > 0;
                                     ///< rounding of the positions is the floor
    int max_iterations = 50;         ///< Newton iterations in a step, >= 1
};

/// Implicit Euler: each step of h minimises the incremental potential over the free nodes,
///
///     1/(2 h^2) |x - x_n - h v_n|_M^2 + E(x) - f_ext(t_n + h) . x + 1/(2h) sum_e c_e (n_e . (r_e - r_e^n))^2 ,
///
/// n_e lagged, by Newton's method with a line search. First order in h, stable at any h, and
/// it damps what it does not resolve. The analysis and factorisation are kept from step to step while the same nodes
/// are clamped. `state.accelerations` is the network's own at the frame's positions and velocities.
///
/// `advance` returns Newton's status where it is not `converged`, with the state as it was. Model of `Stepper`.
template <int Dim, std::floating_point ScalarType>
class ImplicitEuler {
public:
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    /// Throws InvalidArgument for a network or an option that cannot be used.
    explicit ImplicitEuler(SpringNetwork<Dim, Scalar> network, const ImplicitEulerOptions<Scalar>& options = {})
        : m_network(std::move(network)), m_options(options) {
        validate(m_network);
        require(options.tolerance > 0, "tolerance", "a positive tolerance", options.tolerance);
        require(options.max_iterations > 0, "max_iterations", "at least one", options.max_iterations);
    }

    [[nodiscard]] const SpringNetwork<Dim, Scalar>& network() const { return m_network; }
    [[nodiscard]] const Points<Dim, Scalar>& rest_positions() const { return m_network.rest_positions; }
    [[nodiscard]] const Values<Scalar>& masses() const { return m_network.mass; }
    [[nodiscard]] int n_factorisations() const { return m_solver.n_factorisations(); }

    [[nodiscard]] State<Dim, Scalar> start(const Scenario<Dim, Scalar>& scenario) const {
        return detail::start_network<Dim, Scalar>(m_network, scenario);
    }

    [[nodiscard]] Status advance(State<Dim, Scalar>& state, const Scenario<Dim, Scalar>& scenario, Scalar dt) {
        require(dt > 0 && std::isfinite(dt), "dt", "a positive time step", dt);
        const std::vector<int> clamped = clamped_nodes(scenario, m_network.n_nodes());
        if (!m_potential || clamped != m_clamped) {
            m_potential.emplace(m_network, FreeNodes(m_network.n_nodes(), clamped));
            m_clamped = clamped;
            m_solver.reset();
        }
        const FreeNodes& free = m_potential->free_nodes();
        State<Dim, Scalar> next;
        next.time = state.time + dt;
        const Points<Dim, Scalar> external = external_forces<Dim, Scalar>(scenario, m_network.mass, next.time);
        const Points<Dim, Scalar> target = state.positions + dt * state.velocities;
        next.positions = target;
        apply_clamps<Dim, Scalar>(scenario, m_network.rest_positions, next.time, next.positions);
        m_potential->set_statics(m_network, next.positions, external);
        m_potential->set_dynamics(target, state.positions, dt);

        Values<Scalar> x = free.template gather<Dim, Scalar>(next.positions);
        if (free.n_free() > 0) {
            Values<Scalar> gradient(x.size());
            m_potential->gradient(x, gradient);
            Points<Dim, Scalar> elastic = Points<Dim, Scalar>::Zero(Dim, m_network.n_nodes());
            add_elastic_forces<Dim, Scalar>(m_network, state.positions, elastic);
            const Scalar force = std::max({gradient.template lpNorm<Eigen::Infinity>(), elastic.cwiseAbs().maxCoeff(),
                                           external.cwiseAbs().maxCoeff()});
            const Scalar rounding = m_potential->gradient_rounding(next.positions);
            NewtonOptions<Scalar> newton;
            newton.max_iterations = m_options.max_iterations;
            newton.gradient_tolerance = std::max(m_options.tolerance * force, 4 * rounding);
            m_potential->set_exact_below(Scalar(1e-2) * force);
            const auto report = minimise(*m_potential, x, m_solver, newton);
            const bool at_rounding = usable(report.status) && report.gradient_max <= 64 * rounding;
            if (report.status != Status::converged && !at_rounding) {
                return report.status;
            }
        }
        free.template scatter<Dim, Scalar>(x, next.positions);
        next.velocities = (next.positions - state.positions) / dt;
        detail::finish_frame<Dim, Scalar>(m_network, external, clamped, state, next);
        if (!detail::is_finite<Dim, Scalar>(next)) {
            return Status::diverged;
        }
        state = std::move(next);
        return Status::converged;
    }

private:
    SpringNetwork<Dim, Scalar> m_network;
    ImplicitEulerOptions<Scalar> m_options;
    std::optional<detail::SpringPotential<Dim, Scalar>> m_potential;
    std::vector<int> m_clamped;
    SymmetricSolver<Scalar> m_solver;
};

} // namespace springfit
