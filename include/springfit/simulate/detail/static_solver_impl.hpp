// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/simulate/static_solver.hpp>

namespace springfit {

template <int Dim, std::floating_point Scalar>
Status NetworkStatics<Dim, Scalar>::solve_equilibrium(const Scenario<Dim, Scalar>& scenario, Scalar time,
                                                      Points<Dim, Scalar>& positions) {
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

template <int Dim, std::floating_point Scalar>
Status NetworkStatics<Dim, Scalar>::linear_response(const Scenario<Dim, Scalar>& scenario, Scalar time,
                                                    Points<Dim, Scalar>& displacement) {
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

template <int Dim, std::floating_point Scalar>
void NetworkStatics<Dim, Scalar>::use_clamps(const Scenario<Dim, Scalar>& scenario) {
    validate(scenario, m_network.n_nodes());
    std::vector<int> clamped = clamped_nodes(scenario, m_network.n_nodes());
    if (clamped != m_clamped) {
        m_clamped = std::move(clamped);
        m_springs.reset();
        m_is_linear_ready = false;
    }
}

template <int Dim, std::floating_point Scalar>
void NetworkStatics<Dim, Scalar>::prepare_linear() {
    if (m_is_linear_ready) {
        return;
    }
    m_is_linear_ready = true;
    m_free = FreeNodes(m_network.n_nodes(), m_clamped);
    m_full = network_matrix(m_network, FreeNodes(m_network.n_nodes(), {}));
    add_stiffness<Dim, Scalar>(m_network, m_network.rest_positions, HessianForm::exact, m_full);
    m_held = network_matrix(m_network, m_free);
    add_stiffness<Dim, Scalar>(m_network, m_network.rest_positions, HessianForm::exact, m_held);
    m_solver.reset();
    m_solver.set_max_diagonal_iterations(0);
    m_is_held = detail::is_positive_definite<Scalar>(m_solver, m_held.matrix());
    if (!m_is_held) { // singular: conjugate gradients stay within what the springs resist
        m_solver.reset();
        m_solver.set_max_diagonal_iterations(2000);
    }
}

} // namespace springfit
