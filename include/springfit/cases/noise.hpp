// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <random>

#include <springfit/motion/motion.hpp>

namespace springfit {

/// A motion with Gaussian noise on the positions of its free nodes, as a measurement has it, independent from node to
/// node and frame to frame. Its root mean square length is `level` times that of the displacements of the free nodes
/// from their rest positions, over all frames; the seed fixes it.
///
/// Velocities, accelerations and forces stay as they are. Throws InvalidArgument for an incomplete motion and for a
/// level below 0. O(nodes x frames).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Motion<Dim, Scalar> with_noise(Motion<Dim, Scalar> motion, double level, unsigned seed) {
    validate(motion);
    require(level >= 0 && std::isfinite(level), "level", "a level not below 0", level);
    std::vector<bool> is_held(static_cast<std::size_t>(motion.n_nodes()), false);
    for (int node : motion.clamped) {
        require(node >= 0 && node < motion.n_nodes(), "clamped", text("node numbers in [0, ", motion.n_nodes(), ")"),
                node);
        is_held[static_cast<std::size_t>(node)] = true;
    }
    const auto for_free = [&](const auto& visit) {
        for (auto& positions : motion.positions) {
            for (Index i = 0; i < motion.n_nodes(); ++i) {
                if (!is_held[static_cast<std::size_t>(i)]) {
                    visit(positions.col(i), motion.rest_positions.col(i));
                }
            }
        }
    };
    double sum = 0;
    double count = 0;
    for_free([&](const auto& position, const auto& rest) {
        sum += (position - rest).template cast<double>().squaredNorm();
        count += Dim;
    });
    if (!(sum > 0 && level > 0)) {
        return motion;
    }
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, level * std::sqrt(sum / count));
    for_free([&](auto&& position, const auto&) {
        for (int d = 0; d < Dim; ++d) {
            position(d) += static_cast<Scalar>(noise(random));
        }
    });
    return motion;
}

} // namespace springfit
