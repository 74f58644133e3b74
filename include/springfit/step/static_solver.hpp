// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <springfit/step/equilibrium.hpp>

namespace springfit {

/// Static equilibria of a network under one load case after another. A model of the concept StaticSolver.
template <int Dim, std::floating_point ScalarType>
class NetworkStatics {
public:
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    /// Keeps a copy of the network.
    explicit NetworkStatics(SpringNetwork<Dim, Scalar> network) : m_network(std::move(network)) { validate(m_network); }
    NetworkStatics(const NetworkStatics&) = delete; // m_springs refers to m_network
    NetworkStatics& operator=(const NetworkStatics&) = delete;

    [[nodiscard]] const Points<Dim, Scalar>& rest_positions() const { return m_network.rest_positions; }
    [[nodiscard]] const Values<Scalar>& masses() const { return m_network.mass; }

    /// The positions `[Dim x n_nodes]` that `equilibrium` ends with, whether it is stable or not.
    /// What the clamps determine is kept while the same nodes are clamped.
    Status balance(const Scenario<Dim, Scalar>& scenario, Scalar time, Points<Dim, Scalar>& positions) {
        EquilibriumOptions<Dim, Scalar> options;
        options.time = time;
        use_clamps(scenario);
        if (!m_springs) {
            m_springs.emplace(m_network, m_clamped);
        }
        auto found = detail::equilibrium(*m_springs, scenario, options, false);
        positions = std::move(found.positions);
        return found.status;
    }

    /// K u = f with K at the rest positions and f the loads and the springs' own forces there: displacement
    /// `[Dim x n_nodes]`, m. The factorisation is kept while the same nodes are clamped. A flat network in space
    /// answers loads in its plane. Status `failed` where the springs do not resist the loads.
    Status linear_response(const Scenario<Dim, Scalar>& scenario, Scalar time, Points<Dim, Scalar>& displacement) {
        use_clamps(scenario);
        prepare_linear();
        const Points<Dim, Scalar>& rest = m_network.rest_positions;
        Points<Dim, Scalar> moved = rest;
        apply_clamps<Dim, Scalar>(scenario, rest, time, moved);
        displacement = moved - rest;
        if (m_free.n_free() == 0) {
            return Status::converged;
        }
        Points<Dim, Scalar> forces = external_forces<Dim, Scalar>(scenario, m_network.mass, time);
        add_elastic_forces<Dim, Scalar>(m_network, rest, forces);
        const Values<Scalar> way = displacement.reshaped();
        const Values<Scalar> pull = m_full.matrix().template selfadjointView<Eigen::Lower>() * way;
        forces -= pull.reshaped(Dim, rest.cols());
        const Values<Scalar> push = m_free.template gather<Dim, Scalar>(forces);
        const SymmetricMatrix<Scalar> stiffness = m_held.matrix();
        Values<Scalar> values;
        Values<Scalar> answer(push.size());
        if (m_is_held) {
            values = m_solver.apply_factor(push);
        } else if (!m_solver.solve(stiffness, push, values, std::sqrt(std::numeric_limits<Scalar>::epsilon()))) {
            return Status::failed;
        }
        stiffness.multiply(values, answer);
        if (!((answer - push).norm() <= Scalar(0.01) * push.norm())) {
            return Status::failed;
        }
        m_free.template scatter<Dim, Scalar>(values, displacement);
        return Status::converged;
    }

private:
    void use_clamps(const Scenario<Dim, Scalar>& scenario) {
        validate(scenario, m_network.n_nodes());
        std::vector<int> clamped = clamped_nodes(scenario, m_network.n_nodes());
        if (clamped != m_clamped) {
            m_clamped = std::move(clamped);
            m_springs.reset();
            m_is_linear_ready = false;
        }
    }

    void prepare_linear() {
        if (m_is_linear_ready) {
            return;
        }
        m_is_linear_ready = true;
        m_free = FreeNodes(m_network.n_nodes(), m_clamped);
        m_full = spring_matrix(m_network, FreeNodes(m_network.n_nodes(), {}));
        add_stiffness<Dim, Scalar>(m_network, m_network.rest_positions, Curvature::exact, m_full);
        m_held = spring_matrix(m_network, m_free);
        add_stiffness<Dim, Scalar>(m_network, m_network.rest_positions, Curvature::exact, m_held);
        m_solver.reset();
        m_solver.set_max_diagonal_iterations(0);
        m_is_held = detail::is_positive_definite<Scalar>(m_solver, m_held.matrix());
        if (!m_is_held) { // singular: conjugate gradients stay within what the springs resist
            m_solver.reset();
            m_solver.set_max_diagonal_iterations(2000);
        }
    }

    SpringNetwork<Dim, Scalar> m_network;
    std::vector<int> m_clamped;
    std::optional<detail::HeldSprings<Dim, Scalar>> m_springs; ///< of m_network, for `balance`
    bool m_is_linear_ready = false;                            ///< the rest is of the present clamps
    FreeNodes m_free;
    CliqueMatrix<Dim, Scalar> m_full; ///< stiffness of all nodes at rest
    CliqueMatrix<Dim, Scalar> m_held; ///< of the free ones
    SymmetricSolver<Scalar> m_solver; ///< holds its factor where it is positive definite
    bool m_is_held = false;
};

/// `SpringNetwork` is a model of the concept StaticReference (`motion/record_static.hpp`).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] NetworkStatics<Dim, Scalar> make_static_solver(const SpringNetwork<Dim, Scalar>& network) {
    return NetworkStatics<Dim, Scalar>(network);
}

} // namespace springfit
