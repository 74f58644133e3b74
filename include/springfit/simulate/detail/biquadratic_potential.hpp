// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/network/biquadratic_forces.hpp>
#include <springfit/solve/newton.hpp>

namespace springfit::detail {

/// The potential energy of a biquadratic network, W(x) - f . (x - start), over the coordinates of the free nodes.
///
/// As in `SpringPotential`, its Hessian is the semidefinite one far from the minimum and the exact one near it.
template <int Dim, std::floating_point ScalarType>
class BiquadraticPotential {
public:
    using Scalar = ScalarType;

    /// Clamped nodes stand as in `start`. Keeps references to the network and the forces. `floor`, relative to the
    /// largest entry of the Hessian's diagonal, is added to the diagonal: it keeps the matrix regular where nothing
    /// holds a node, as across a flat membrane, and moves no minimum.
    BiquadraticPotential(const BiquadraticNetwork<Dim, Scalar>& network, const FreeNodes& free,
                         const Points<Dim, Scalar>& start, const Points<Dim, Scalar>& external, Scalar floor)
        : m_network(network), m_matrix(triangle_matrix(network, free)), m_start(start), m_external(external),
          m_points(start), m_floor(floor) {}

    [[nodiscard]] const FreeNodes& free_nodes() const { return m_matrix.free_nodes(); }

    /// The Hessian is exact where no entry of the gradient exceeds this, N.
    void set_exact_below(Scalar gradient) { m_exact_below = gradient; }
    void set_floor(Scalar floor) { m_floor = floor; }

    [[nodiscard]] Scalar energy(const Values<Scalar>& x) {
        free_nodes().template scatter<Dim, Scalar>(x, m_points);
        return elastic_energy<Dim, Scalar>(m_network, m_points) - m_external.cwiseProduct(m_points - m_start).sum();
    }

    void gradient(const Values<Scalar>& x, Values<Scalar>& gradient) {
        free_nodes().template scatter<Dim, Scalar>(x, m_points);
        m_forces = m_external;
        add_elastic_forces<Dim, Scalar>(m_network, m_points, m_forces);
        gradient = -free_nodes().template gather<Dim, Scalar>(m_forces);
        m_is_near = gradient.template lpNorm<Eigen::Infinity>() <= m_exact_below;
    }

    /// At the point whose gradient was asked for last.
    [[nodiscard]] const SparseMatrix<Scalar>& hessian(const Values<Scalar>& x) {
        free_nodes().template scatter<Dim, Scalar>(x, m_points);
        m_matrix.set_zero();
        add_stiffness<Dim, Scalar>(m_network, m_points,
                                   m_is_near ? HessianForm::exact : HessianForm::positive_semidefinite, m_matrix);
        if (m_floor > 0) {
            const Scalar stiffest = m_matrix.matrix().diagonal().maxCoeff();
            for (Index f = 0; f < free_nodes().n_free(); ++f) {
                m_matrix.add_diagonal(f, m_floor * stiffest);
            }
        }
        return m_matrix.matrix();
    }

    /// The rounding of the energy at the coordinates last used, J: each D is a difference of squares.
    [[nodiscard]] Scalar energy_rounding() const {
        Scalar terms = m_external.cwiseProduct(m_points - m_start).cwiseAbs().sum();
        for (Index t = 0; t < m_network.n_triangles(); ++t) {
            const BiquadraticTriangle<Dim, Scalar> triangle(m_network, t, m_points);
            terms += (triangle.s.cwiseAbs() * triangle.change.cwiseAbs()).dot(triangle.lengths2);
        }
        return 4 * std::numeric_limits<Scalar>::epsilon() * terms;
    }

    /// The gradient that rounding of the coordinates alone makes, N.
    [[nodiscard]] Scalar gradient_rounding() const {
        Values<Scalar> stiffness = Values<Scalar>::Zero(m_network.n_nodes());
        for (Index t = 0; t < m_network.n_triangles(); ++t) {
            const BiquadraticTriangle<Dim, Scalar> triangle(m_network, t, m_points);
            const Vector<3, Scalar> weights = triangle.axial_bounds();
            for (int i = 0; i < 3; ++i) {
                stiffness(triangle.nodes(i)) += weights((i + 1) % 3) + weights((i + 2) % 3);
            }
        }
        return std::numeric_limits<Scalar>::epsilon() * stiffness.maxCoeff() * m_points.cwiseAbs().maxCoeff();
    }

private:
    const BiquadraticNetwork<Dim, Scalar>& m_network;
    BlockMatrix<Dim, Scalar> m_matrix;
    Points<Dim, Scalar> m_start;
    const Points<Dim, Scalar>& m_external;
    Points<Dim, Scalar> m_points; ///< all nodes; the free ones at the x last asked for
    Points<Dim, Scalar> m_forces;
    Scalar m_floor;
    Scalar m_exact_below = 0;
    bool m_is_near = false;
};

} // namespace springfit::detail
