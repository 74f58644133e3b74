// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <springfit/network/volume.hpp>
#include <springfit/solve/block_matrix.hpp>

namespace springfit {

namespace detail {

/// A spring as it stands: r = x_j - x_i, L = |r| and 1 / L, which is 0 where the ends meet (no direction, no force).
template <int Dim, std::floating_point Scalar>
struct SpringVector {
    int i;
    int j;
    Vector<Dim, Scalar> r;
    Scalar length;
    Scalar inverse_length;

    SpringVector(const NodePairs& springs, Index e, const Points<Dim, Scalar>& positions)
        : i(springs(0, e)), j(springs(1, e)), r(positions.col(j) - positions.col(i)), length(r.norm()),
          inverse_length(length > 0 ? 1 / length : Scalar(0)) {}
};

} // namespace detail

/// Elastic energy sum_e 1/2 k_e (L_e - l_e)^2, with that of the cells (`volume_energy`), at `positions`
/// `[Dim x n_nodes]`, J. O(springs + cells).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Scalar elastic_energy(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions) {
    Scalar twice = 0;
    for (Index e = 0; e < network.n_springs(); ++e) {
        const detail::SpringVector<Dim, Scalar> spring(network.springs, e, positions);
        const Scalar stretch = spring.length - network.rest_length(e);
        twice += network.stiffness(e) * stretch * stretch;
    }
    return twice / 2 + volume_energy<Dim, Scalar>(network, positions);
}

/// Adds the elastic forces k_e (L_e - l_e) n_e and those of the cells (`add_volume_forces`) to `forces`
/// `[Dim x n_nodes]`, N: minus the gradient of the energy. O(springs + cells).
template <int Dim, std::floating_point Scalar>
void add_elastic_forces(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions,
                        Points<Dim, Scalar>& forces) {
    for (Index e = 0; e < network.n_springs(); ++e) {
        const detail::SpringVector<Dim, Scalar> spring(network.springs, e, positions);
        const Scalar tension = network.stiffness(e) * (spring.length - network.rest_length(e));
        const Vector<Dim, Scalar> force = tension * spring.inverse_length * spring.r;
        forces.col(spring.i) += force;
        forces.col(spring.j) -= force;
    }
    add_volume_forces<Dim, Scalar>(network, positions, forces);
}

/// Adds elastic and axial damping forces, (k_e (L_e - l_e) + c_e (v_j - v_i) . n_e) n_e on i and the opposite on j, and
/// the elastic forces of the cells, which have no damping, to `forces` `[Dim x n_nodes]`, N. One pass over springs and
/// cells, no allocation.
template <int Dim, std::floating_point Scalar>
void add_spring_forces(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions,
                       const Points<Dim, Scalar>& velocities, Points<Dim, Scalar>& forces) {
    for (Index e = 0; e < network.n_springs(); ++e) {
        const detail::SpringVector<Dim, Scalar> spring(network.springs, e, positions);
        const Vector<Dim, Scalar> n = spring.inverse_length * spring.r;
        const Scalar rate = n.dot(velocities.col(spring.j) - velocities.col(spring.i));
        const Scalar tension =
            network.stiffness(e) * (spring.length - network.rest_length(e)) + network.damping(e) * rate;
        const Vector<Dim, Scalar> force = tension * n;
        forces.col(spring.i) += force;
        forces.col(spring.j) -= force;
    }
    add_volume_forces<Dim, Scalar>(network, positions, forces);
}

/// Writes a_i = (f_i + external_i) / m_i `[Dim x n_nodes]`, m/s^2, of every node, clamped or not. No allocation where
/// `accelerations` has its size already.
template <int Dim, std::floating_point Scalar>
void compute_accelerations(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions,
                           const Points<Dim, Scalar>& velocities, const Points<Dim, Scalar>& external_forces,
                           Points<Dim, Scalar>& accelerations) {
    accelerations = external_forces;
    add_spring_forces<Dim, Scalar>(network, positions, velocities, accelerations);
    for (Index i = 0; i < network.n_nodes(); ++i) {
        accelerations.col(i) /= network.mass(i);
    }
}

/// The form of the second derivative of the elastic energy.
enum class HessianForm {
    /// Springs k n n' + k (1 - l/L) (I - n n'), indefinite under compression; cells
    /// kappa/V_c (g g' + (V - V_c) d^2 V/dx^2), g = dV/dx, indefinite away from rest and where kappa < 0.
    exact,
    /// The same without the geometric part of compressed springs (L < l) and without the second derivative of V; cells
    /// with kappa < 0 have none.
    positive_semidefinite
};

/// The matrix of a network's springs and cells over its free nodes, filled by `add_stiffness` and `add_damping`. Its
/// cliques are the springs, then the cells: clique n_springs + c is cell c.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] BlockMatrix<Dim, Scalar> network_matrix(const SpringNetwork<Dim, Scalar>& network,
                                                      const FreeNodes& free) {
    Cliques cliques = cliques_of(network.springs);
    const Cliques cells = cliques_of(network.cells);
    cliques.insert(cliques.end(), cells.begin(), cells.end());
    return BlockMatrix<Dim, Scalar>(free, cliques);
}

namespace detail {

/// Adds [B -B; -B B] for a spring.
template <int Dim, std::floating_point Scalar>
void add_spring_block(BlockMatrix<Dim, Scalar>& matrix, Index spring, const Eigen::Matrix<Scalar, Dim, Dim>& b) {
    Eigen::Matrix<Scalar, 2 * Dim, 2 * Dim> block;
    block.template topLeftCorner<Dim, Dim>() = b;
    block.template topRightCorner<Dim, Dim>() = -b;
    block.template bottomLeftCorner<Dim, Dim>() = -b;
    block.template bottomRightCorner<Dim, Dim>() = b;
    matrix.add(spring, block);
}

/// Adds the Hessian of the energy of the cells.
template <int Dim, std::floating_point Scalar>
void add_volume_stiffness(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions,
                          HessianForm curvature, BlockMatrix<Dim, Scalar>& matrix) {
    constexpr int size = Dim * (Dim + 1);
    for (Index c = 0; c < network.n_cells(); ++c) {
        const Scalar kappa = network.volume_stiffness(c);
        if (kappa == 0 || (kappa < 0 && curvature == HessianForm::positive_semidefinite)) {
            continue;
        }
        const VolumeCell<Dim, Scalar> cell(network, c, positions);
        const SimplexCorners<Dim, Scalar> gradient = cell.gradient();
        const Eigen::Map<const Eigen::Matrix<Scalar, size, 1>> g(gradient.data());
        Eigen::Matrix<Scalar, size, size> block = (kappa / network.rest_volume(c)) * g * g.transpose();
        if (curvature == HessianForm::exact) {
            block += (kappa * cell.dilation) * volume_hessian<Dim, Scalar>(cell.corners);
        }
        matrix.add(network.n_springs() + c, block);
    }
}

} // namespace detail

/// Adds the Hessian of the elastic energy at `positions`, N/m, to a `network_matrix`. O(springs + cells).
template <int Dim, std::floating_point Scalar>
void add_stiffness(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions,
                   HessianForm curvature, BlockMatrix<Dim, Scalar>& matrix) {
    using Block = Eigen::Matrix<Scalar, Dim, Dim>;
    for (Index e = 0; e < network.n_springs(); ++e) {
        const detail::SpringVector<Dim, Scalar> spring(network.springs, e, positions);
        const Vector<Dim, Scalar> n = spring.inverse_length * spring.r;
        Scalar geometric = 1 - network.rest_length(e) * spring.inverse_length;
        if (curvature == HessianForm::positive_semidefinite) {
            geometric = std::max(geometric, Scalar(0));
        }
        const Block b = network.stiffness(e) * (geometric * Block::Identity() + (1 - geometric) * n * n.transpose());
        detail::add_spring_block<Dim, Scalar>(matrix, e, b);
    }
    detail::add_volume_stiffness<Dim, Scalar>(network, positions, curvature, matrix);
}

/// Adds `factor` times the damping matrix sum_e c_e n_e n_e' at `positions`, N s/m, to a `network_matrix`. O(springs).
template <int Dim, std::floating_point Scalar>
void add_damping(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions, Scalar factor,
                 BlockMatrix<Dim, Scalar>& matrix) {
    for (Index e = 0; e < network.n_springs(); ++e) {
        const detail::SpringVector<Dim, Scalar> spring(network.springs, e, positions);
        const Vector<Dim, Scalar> n = spring.inverse_length * spring.r;
        detail::add_spring_block<Dim, Scalar>(matrix, e, factor * network.damping(e) * n * n.transpose());
    }
}

} // namespace springfit
