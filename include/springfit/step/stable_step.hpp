// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>

#include <springfit/network/spring_network.hpp>

namespace springfit {

/// A time step, s, below which the explicit step of a network is stable at every deformation; no eigensolver.
///
/// With d_i the sum of k and g_i the sum of c over the springs at node i, and for each spring (i, j)
///
///     a = d_i / m_i + d_j / m_j ,   b = g_i / m_i + g_j / m_j ,   h_ij = 2 / (b/2 + sqrt(b^2/4 + a)) ,
///
/// the step is the least h_ij. It follows from the condition of the explicit step with damping at the old velocity,
/// M - h/2 C - h^2/4 K positive definite: K and C are bounded by the graph Laplacians with weights k and c, since
/// k n n' + k (1 - l/L) (I - n n') <= k I, and those by the row sums of their edge form. Without damping this is
/// 2 / sqrt(max a). For a spring alone it is exact; in meshes the true limit is up to about twice as long.
///
/// The ends in `fixed` do not move: their d / m and g / m count as 0. Infinite where nothing binds the step.
/// O(springs).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Scalar stable_step(const SpringNetwork<Dim, Scalar>& network, const std::vector<int>& fixed = {}) {
    Values<Scalar> stiffness = Values<Scalar>::Zero(network.n_nodes()); // d_i / m_i
    Values<Scalar> damping = Values<Scalar>::Zero(network.n_nodes());   // g_i / m_i
    for (Index e = 0; e < network.n_springs(); ++e) {
        for (int end = 0; end < 2; ++end) {
            const int node = network.springs(end, e);
            stiffness(node) += network.stiffness(e) / network.mass(node);
            damping(node) += network.damping(e) / network.mass(node);
        }
    }
    for (int node : fixed) {
        require(node >= 0 && node < network.n_nodes(), "fixed", text("node numbers in [0, ", network.n_nodes(), ")"),
                node);
        stiffness(node) = 0;
        damping(node) = 0;
    }
    Scalar step = std::numeric_limits<Scalar>::infinity();
    for (Index e = 0; e < network.n_springs(); ++e) {
        const int i = network.springs(0, e);
        const int j = network.springs(1, e);
        const Scalar a = stiffness(i) + stiffness(j);
        const Scalar b = damping(i) + damping(j);
        const Scalar rate = b / 2 + std::sqrt(b * b / 4 + a);
        if (rate > 0) {
            step = std::min(step, 2 / rate);
        }
    }
    return step;
}

} // namespace springfit
