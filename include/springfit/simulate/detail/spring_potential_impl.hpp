// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/simulate/detail/spring_potential.hpp>

namespace springfit::detail {

template <int Dim, std::floating_point Scalar>
bool SpringPotential<Dim, Scalar>::use_semidefinite() {
    const bool changes = !m_is_semidefinite && !m_is_near;
    m_is_semidefinite = m_is_semidefinite || changes;
    return changes;
}

template <int Dim, std::floating_point Scalar>
auto SpringPotential<Dim, Scalar>::energy(const Values<Scalar>& x) -> Scalar {
    free_nodes().template scatter<Dim, Scalar>(x, m_points);
    Scalar energy = elastic_energy<Dim, Scalar>(*m_network, m_points);
    for (int i : free_nodes().nodes()) {
        energy -= m_external->col(i).dot(m_points.col(i) - m_start.col(i));
    }
    return energy;
}

template <int Dim, std::floating_point Scalar>
void SpringPotential<Dim, Scalar>::gradient(const Values<Scalar>& x, Values<Scalar>& gradient) {
    free_nodes().template scatter<Dim, Scalar>(x, m_points);
    m_forces = *m_external;
    add_elastic_forces<Dim, Scalar>(*m_network, m_points, m_forces);
    gradient = -free_nodes().template gather<Dim, Scalar>(m_forces);
    m_is_near = gradient.template lpNorm<Eigen::Infinity>() <= m_exact_below;
}

template <int Dim, std::floating_point Scalar>
auto SpringPotential<Dim, Scalar>::hessian(const Values<Scalar>& x) -> const SparseMatrix<Scalar>& {
    free_nodes().template scatter<Dim, Scalar>(x, m_points);
    m_matrix.set_zero();
    add_stiffness<Dim, Scalar>(
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

template <int Dim, std::floating_point Scalar>
auto SpringPotential<Dim, Scalar>::energy_rounding() const -> Scalar {
    Scalar terms = 0;
    for (Index e = 0; e < m_network->n_springs(); ++e) {
        const SpringVector<Dim, Scalar> spring(m_network->springs, e, m_points);
        const Scalar tension = m_network->stiffness(e) * std::abs(spring.length - m_network->rest_length(e));
        terms += tension * (spring.length + m_network->rest_length(e));
    }
    for (Index c = 0; c < m_network->n_cells(); ++c) {
        const VolumeCell<Dim, Scalar> cell(*m_network, c, m_points);
        const SimplexCorners<Dim, Scalar> sides = cell.corners.colwise() - cell.corners.col(0);
        const Scalar size = cell.gradient().colwise().norm().dot(sides.colwise().norm()); // of the sums in V
        terms += std::abs(m_network->volume_stiffness(c) * cell.dilation) * (size + m_network->rest_volume(c));
    }
    for (int i : free_nodes().nodes()) {
        terms += std::abs(m_external->col(i).dot(m_points.col(i) - m_start.col(i)));
    }
    return 4 * std::numeric_limits<Scalar>::epsilon() * terms;
}

template <int Dim, std::floating_point Scalar>
auto SpringPotential<Dim, Scalar>::gradient_rounding(const Points<Dim, Scalar>& positions) const -> Scalar {
    Values<Scalar> stiffness = Values<Scalar>::Zero(m_network->n_nodes());
    for (Index e = 0; e < m_network->n_springs(); ++e) {
        const Scalar value = m_network->stiffness(e);
        stiffness(m_network->springs(0, e)) += value;
        stiffness(m_network->springs(1, e)) += value;
    }
    for (Index c = 0; c < m_network->n_cells(); ++c) {
        const VolumeCell<Dim, Scalar> cell(*m_network, c, positions);
        const Scalar kappa = std::abs(m_network->volume_stiffness(c));
        const auto slopes = cell.gradient().colwise().norm().eval();
        const auto curvature = cell.curvature();
        for (int a = 0; a <= Dim; ++a) {
            stiffness(m_network->cells(a, c)) +=
                kappa * (slopes(a) * slopes.sum() / m_network->rest_volume(c) + std::abs(cell.dilation) * curvature(a));
        }
    }
    return std::numeric_limits<Scalar>::epsilon() * stiffness.maxCoeff() * positions.cwiseAbs().maxCoeff();
}

} // namespace springfit::detail
