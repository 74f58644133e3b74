// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>

#include <springfit/network/volume.hpp>

namespace springfit {

namespace detail {

/// As `stable_step_at`, of a network that is known to be valid, in loops.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Scalar stable_step_unchecked(const SpringNetwork<Dim, Scalar>& network,
                                           const Points<Dim, Scalar>& positions, const std::vector<int>& fixed = {}) {
    Values<Scalar> inverse_mass = network.mass.cwiseInverse();
    for (int node : fixed) {
        require(node >= 0 && node < network.n_nodes(), "fixed", text("node numbers in [0, ", network.n_nodes(), ")"),
                node);
        inverse_mass(node) = 0;
    }
    Values<Scalar> stiffness = Values<Scalar>::Zero(network.n_nodes()); // d_i / m_i
    Values<Scalar> damping = Values<Scalar>::Zero(network.n_nodes());   // g_i / m_i
    Values<Scalar> geometric = Values<Scalar>::Zero(network.n_nodes()); // p_i / m_i
    for (Index e = 0; e < network.n_springs(); ++e) {
        for (int end = 0; end < 2; ++end) {
            const int node = network.springs(end, e);
            stiffness(node) += network.stiffness(e) * inverse_mass(node);
            damping(node) += network.damping(e) * inverse_mass(node);
        }
    }
    using Corners = Eigen::Matrix<Scalar, Dim + 1, 1>;
    const auto slopes = [](const detail::VolumeCell<Dim, Scalar>& cell) {
        return Corners(cell.gradient().colwise().norm().transpose());
    };
    for (Index c = 0; c < network.n_cells(); ++c) {
        const detail::VolumeCell<Dim, Scalar> cell(network, c, positions);
        const Scalar kappa = network.volume_stiffness(c);
        const Corners slope = slopes(cell);
        const Corners along = (std::max(kappa, Scalar(0)) / network.rest_volume(c) * slope.sum() / 2) * slope;
        const Corners across = std::abs(kappa * cell.dilation) * cell.curvature();
        for (int a = 0; a <= Dim; ++a) {
            const int node = network.cells(a, c);
            stiffness(node) += along(a) * inverse_mass(node);
            geometric(node) += across(a) * inverse_mass(node);
        }
    }
    Scalar step = std::numeric_limits<Scalar>::infinity();
    const Scalar everywhere = geometric.size() > 0 ? geometric.maxCoeff() : Scalar(0);
    const auto bind = [&](Scalar a, Scalar b) {
        const Scalar rate = b / 2 + std::sqrt(b * b / 4 + a + everywhere);
        if (rate > 0) {
            step = std::min(step, 2 / rate);
        }
    };
    bind(0, 0);
    for (Index e = 0; e < network.n_springs(); ++e) {
        if (network.stiffness(e) > 0 || network.damping(e) > 0) {
            const int i = network.springs(0, e);
            const int j = network.springs(1, e);
            bind(stiffness(i) + stiffness(j), damping(i) + damping(j));
        }
    }
    for (Index c = 0; c < network.n_cells(); ++c) {
        const Corners slope = slopes(detail::VolumeCell<Dim, Scalar>(network, c, positions));
        if (network.volume_stiffness(c) > 0 && slope.sum() > 0) {
            Scalar a = 0;
            Scalar b = 0;
            for (int corner = 0; corner <= Dim; ++corner) {
                a += slope(corner) * stiffness(network.cells(corner, c));
                b += slope(corner) * damping(network.cells(corner, c));
            }
            bind(2 * a / slope.sum(), 2 * b / slope.sum());
        }
    }
    return step;
}

} // namespace detail

/// A time step, s, below which the explicit step of a network is stable at `positions` `[Dim x n_nodes]`; no
/// eigensolver.
///
/// With d_i the sum of k and g_i the sum of c over the springs at node i, and for each spring (i, j)
///
///     a = d_i / m_i + d_j / m_j ,   b = g_i / m_i + g_j / m_j ,   h_ij = 2 / (b/2 + sqrt(b^2/4 + a)) ,
///
/// the step is the least h_ij. It follows from the condition of the explicit step with damping at the old velocity,
/// M - h/2 C - h^2/4 K positive definite: K and C are bounded by the graph Laplacians with weights k and c, since
/// k n n' + k (1 - l/L) (I - n n') <= k I, and those by the row sums of their edge form. Without damping this is
/// 2 / sqrt(max a). For a spring alone it is exact; in meshes the true limit is up to about twice as long. Springs
/// hold this at every deformation.
///
/// A cell of kappa > 0 with w_a = |dV/dx_a| and w = sum_a w_a / 2 (so that it counts as two ends) adds kappa / V_c w_a
/// w to d_a and is one more row, a = sum_a w_a / w d_a / m_a, b = sum_a w_a / w g_a / m_a. Away from its rest volume
/// the second derivative of V adds max_i p_i / m_i to every a, p_i the sum over the cells at i of |kappa (V - V_c) /
/// V_c| sum_b |d^2 V / dx_i dx_b|. For one cell at rest it is exact; the cells' part grows with the deformation, as
/// that of the springs does not.
///
/// The ends in `fixed` do not move: their d / m and g / m count as 0. Infinite where nothing binds the step. Throws
/// InvalidArgument for a network that is not valid, and for positions or fixed nodes that do not fit it.
/// O(springs + cells).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Scalar stable_step_at(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions,
                                    const std::vector<int>& fixed = {}) {
    validate(network);
    require(positions.cols() == network.n_nodes(), "positions", text(network.n_nodes(), " columns, one per node"),
            positions.cols());
    return detail::stable_step_unchecked<Dim, Scalar>(network, positions, fixed);
}

/// The stable step in the rest positions: for a network of springs alone that at every deformation.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Scalar stable_step(const SpringNetwork<Dim, Scalar>& network, const std::vector<int>& fixed = {}) {
    return stable_step_at<Dim, Scalar>(network, network.rest_positions, fixed);
}

} // namespace springfit
