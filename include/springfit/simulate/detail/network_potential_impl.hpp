// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/simulate/detail/network_potential.hpp>

namespace springfit::detail {

template <class Network>
bool NetworkPotential<Network>::use_semidefinite() {
    const bool changes = !m_is_semidefinite && !m_is_near;
    m_is_semidefinite = m_is_semidefinite || changes;
    return changes;
}

template <class Network>
auto NetworkPotential<Network>::energy(const Values<Scalar>& x) -> Scalar {
    free_nodes().template scatter<dimension, Scalar>(x, m_points);
    Scalar energy = elastic_energy<dimension, Scalar>(*m_network, m_points);
    for (int i : free_nodes().nodes()) {
        energy -= m_external->col(i).dot(m_points.col(i) - m_start.col(i));
    }
    return energy;
}

template <class Network>
void NetworkPotential<Network>::gradient(const Values<Scalar>& x, Values<Scalar>& gradient) {
    free_nodes().template scatter<dimension, Scalar>(x, m_points);
    m_forces = *m_external;
    add_elastic_forces<dimension, Scalar>(*m_network, m_points, m_forces);
    gradient = -free_nodes().template gather<dimension, Scalar>(m_forces);
    m_is_near = gradient.template lpNorm<Eigen::Infinity>() <= m_exact_below;
}

template <class Network>
auto NetworkPotential<Network>::hessian(const Values<Scalar>& x) -> const SparseMatrix<Scalar>& {
    free_nodes().template scatter<dimension, Scalar>(x, m_points);
    m_matrix.set_zero();
    add_stiffness<dimension, Scalar>(
        *m_network, m_points, m_is_near || !m_is_semidefinite ? HessianForm::exact : HessianForm::positive_semidefinite,
        m_matrix);
    if (m_floor > 0) {
        const Scalar stiffest = m_matrix.matrix().diagonal().maxCoeff();
        for (Index f = 0; f < free_nodes().n_free(); ++f) {
            m_matrix.add_diagonal(f, m_floor * stiffest);
        }
    }
    return m_matrix.matrix();
}

template <class Network>
auto NetworkPotential<Network>::energy_rounding() const -> Scalar {
    Scalar terms = energy_terms(*m_network, m_points);
    for (int i : free_nodes().nodes()) {
        terms += std::abs(m_external->col(i).dot(m_points.col(i) - m_start.col(i)));
    }
    return 4 * std::numeric_limits<Scalar>::epsilon() * terms;
}

template <class Network>
auto NetworkPotential<Network>::gradient_rounding(const Points<dimension, Scalar>& positions) const -> Scalar {
    return std::numeric_limits<Scalar>::epsilon() * largest_stiffness(*m_network, positions) *
           positions.cwiseAbs().maxCoeff();
}

} // namespace springfit::detail
