// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/network/biquadratic_network.hpp>
#include <springfit/network/forces.hpp>

namespace springfit {

namespace detail {

/// A triangle as it stands: W = 1/2 D'S D, with dW/dD_i = s_i the pull along the edge that faces corner i.
template <int Dim, std::floating_point Scalar>
struct BiquadraticTriangle {
    Eigen::Matrix<int, 3, 1> nodes;
    Eigen::Matrix<Scalar, Dim, 3> sides; ///< from corner i + 1 to corner i + 2
    Vector<3, Scalar> lengths2;          ///< L^2
    Vector<3, Scalar> change;            ///< D
    Eigen::Matrix<Scalar, 3, 3> s;       ///< S

    BiquadraticTriangle(const BiquadraticNetwork<Dim, Scalar>& network, Index t, const Points<Dim, Scalar>& positions)
        : nodes(network.triangles.col(t)) {
        const auto k = network.tensile.col(t);
        const auto c = network.angular.col(t);
        for (int i = 0; i < 3; ++i) {
            sides.col(i) = positions.col(nodes((i + 2) % 3)) - positions.col(nodes((i + 1) % 3));
            s(i, i) = k(i) / 2;
            s((i + 1) % 3, (i + 2) % 3) = s((i + 2) % 3, (i + 1) % 3) = c(i) / 2;
        }
        lengths2 = sides.colwise().squaredNorm().transpose();
        change = lengths2 - network.rest_length.col(t).cwiseAbs2();
    }

    /// dD/dt.
    [[nodiscard]] Vector<3, Scalar> rate(const Points<Dim, Scalar>& velocities) const {
        Vector<3, Scalar> result;
        for (int i = 0; i < 3; ++i) {
            result(i) = 2 * sides.col(i).dot(velocities.col(nodes((i + 2) % 3)) - velocities.col(nodes((i + 1) % 3)));
        }
        return result;
    }

    /// Adds the forces of the pulls s = S `d`.
    void add_forces(const Vector<3, Scalar>& d, Points<Dim, Scalar>& forces) const {
        const Vector<3, Scalar> pull = 2 * (s * d);
        for (int i = 0; i < 3; ++i) {
            const Vector<Dim, Scalar> force = pull(i) * sides.col(i);
            forces.col(nodes((i + 1) % 3)) += force;
            forces.col(nodes((i + 2) % 3)) -= force;
        }
    }

    /// Weights w_i = 4 L_i sum_j |S_ij| L_j: 4 sum S_ij (r_i . u_i) (r_j . u_j) <= sum w_i |u_i|^2 for any vectors u.
    [[nodiscard]] Vector<3, Scalar> axial_bounds() const {
        const Vector<3, Scalar> lengths = lengths2.cwiseSqrt();
        return 4 * lengths.cwiseProduct(s.cwiseAbs() * lengths);
    }
};

} // namespace detail

/// Elastic energy sum_i k_i/4 D_i^2 + sum_i c_i/2 D_j D_m over the triangles at `positions` `[Dim x n_nodes]`, J.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Scalar elastic_energy(const BiquadraticNetwork<Dim, Scalar>& network,
                                    const Points<Dim, Scalar>& positions) {
    Scalar twice = 0;
    for (Index t = 0; t < network.n_triangles(); ++t) {
        const detail::BiquadraticTriangle<Dim, Scalar> triangle(network, t, positions);
        twice += triangle.change.dot(triangle.s * triangle.change);
    }
    return twice / 2;
}

/// Adds the elastic forces to `forces` `[Dim x n_nodes]`, N: minus the gradient of the energy.
template <int Dim, std::floating_point Scalar>
void add_elastic_forces(const BiquadraticNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions,
                        Points<Dim, Scalar>& forces) {
    for (Index t = 0; t < network.n_triangles(); ++t) {
        const detail::BiquadraticTriangle<Dim, Scalar> triangle(network, t, positions);
        triangle.add_forces(triangle.change, forces);
    }
}

/// Adds elastic and damping forces, those of D + beta dD/dt, to `forces` `[Dim x n_nodes]`, N. Momentum and angular
/// momentum are kept. One pass over the triangles, no allocation.
template <int Dim, std::floating_point Scalar>
void add_forces(const BiquadraticNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions,
                const Points<Dim, Scalar>& velocities, Points<Dim, Scalar>& forces) {
    for (Index t = 0; t < network.n_triangles(); ++t) {
        const detail::BiquadraticTriangle<Dim, Scalar> triangle(network, t, positions);
        triangle.add_forces(triangle.change + network.damping * triangle.rate(velocities), forces);
    }
}

/// Writes a_i = (f_i + external_i) / m_i `[Dim x n_nodes]`, m/s^2, of every node, clamped or not. No allocation where
/// `accelerations` has its size already.
template <int Dim, std::floating_point Scalar>
void compute_accelerations(const BiquadraticNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions,
                           const Points<Dim, Scalar>& velocities, const Points<Dim, Scalar>& external_forces,
                           Points<Dim, Scalar>& accelerations) {
    accelerations = external_forces;
    add_forces<Dim, Scalar>(network, positions, velocities, accelerations);
    for (Index i = 0; i < network.n_nodes(); ++i) {
        accelerations.col(i) /= network.mass(i);
    }
}

/// The matrix of a biquadratic network over its free nodes, filled by `add_stiffness`.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] BlockMatrix<Dim, Scalar> network_matrix(const BiquadraticNetwork<Dim, Scalar>& network,
                                                      const FreeNodes& free) {
    return BlockMatrix<Dim, Scalar>(free, cliques_of(network.triangles));
}

/// Adds the Hessian of the elastic energy at `positions`, N/m, to a `network_matrix`: 4 sum S_ij r_i r_j' and, for
/// each edge, 2 s_i I, which `HessianForm::positive_semidefinite` leaves out where s_i < 0. O(triangles).
template <int Dim, std::floating_point Scalar>
void add_stiffness(const BiquadraticNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions,
                   HessianForm curvature, BlockMatrix<Dim, Scalar>& matrix) {
    using Block = Eigen::Matrix<Scalar, 3 * Dim, 3 * Dim>;
    for (Index t = 0; t < network.n_triangles(); ++t) {
        const detail::BiquadraticTriangle<Dim, Scalar> triangle(network, t, positions);
        const Vector<3, Scalar> pull = triangle.s * triangle.change;
        Eigen::Matrix<Scalar, 3 * Dim, 3> slopes = Eigen::Matrix<Scalar, 3 * Dim, 3>::Zero(); // dD_i/dx
        for (int i = 0; i < 3; ++i) {
            slopes.template block<Dim, 1>(Dim * ((i + 1) % 3), i) = -2 * triangle.sides.col(i);
            slopes.template block<Dim, 1>(Dim * ((i + 2) % 3), i) = 2 * triangle.sides.col(i);
        }
        Block block = slopes * triangle.s * slopes.transpose();
        for (int i = 0; i < 3; ++i) {
            const bool left_out = curvature == HessianForm::positive_semidefinite && pull(i) < 0;
            const Scalar across = left_out ? Scalar(0) : 2 * pull(i);
            const int p = Dim * ((i + 1) % 3);
            const int q = Dim * ((i + 2) % 3);
            for (int d = 0; d < Dim; ++d) {
                block(p + d, p + d) += across;
                block(q + d, q + d) += across;
                block(p + d, q + d) -= across;
                block(q + d, p + d) -= across;
            }
        }
        matrix.add(t, block);
    }
}

} // namespace springfit
