// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <springfit/motion/state.hpp>

namespace springfit {

/// A recorded motion: positions, velocities, accelerations and external forces at the nodes, frame by frame.
///
/// A static equilibrium is a motion of one frame at rest.
template <int Dim, std::floating_point ScalarType>
struct Motion {
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    std::string name;                   ///< of the load case
    Points<Dim, Scalar> rest_positions; ///< [Dim x n_nodes], m
    std::vector<int> clamped;           ///< nodes whose motion is prescribed, ascending

    std::vector<Scalar> times;                        ///< [n_frames], s
    std::vector<Points<Dim, Scalar>> positions;       ///< n_frames of [Dim x n_nodes], m
    std::vector<Points<Dim, Scalar>> velocities;      ///< m/s
    std::vector<Points<Dim, Scalar>> accelerations;   ///< m/s^2
    std::vector<Points<Dim, Scalar>> external_forces; ///< N

    /// Nodes that were not seen in each frame, ascending; empty: all were. What stands for them was filled in, and has
    /// no weight in a fit or an error.
    std::vector<std::vector<int>> unobserved{};
    Scalar noise = 0; ///< standard deviation of a recorded coordinate, m; 0: none is known

    [[nodiscard]] Index n_nodes() const { return rest_positions.cols(); }
    [[nodiscard]] Index n_frames() const { return static_cast<Index>(times.size()); }
};

/// Calls `visit(node)` for those of `nodes`, ascending, that were seen in a frame.
template <int Dim, std::floating_point Scalar, class Visit>
void for_observed(const Motion<Dim, Scalar>& motion, std::size_t frame, const std::vector<int>& nodes,
                  const Visit& visit) {
    if (motion.unobserved.empty()) {
        std::for_each(nodes.begin(), nodes.end(), visit);
        return;
    }
    auto hidden = motion.unobserved[frame].begin();
    for (int node : nodes) {
        hidden = std::lower_bound(hidden, motion.unobserved[frame].end(), node);
        if (hidden == motion.unobserved[frame].end() || *hidden != node) {
            visit(node);
        }
    }
}

/// Throws InvalidArgument unless every frame holds every array at full size with finite values and times increase.
template <int Dim, std::floating_point Scalar>
void validate(const Motion<Dim, Scalar>& motion) {
    const auto check = [&](const std::vector<Points<Dim, Scalar>>& frames, std::string_view name) {
        require(static_cast<Index>(frames.size()) == motion.n_frames(), name, text(motion.n_frames(), " frames"),
                frames.size());
        for (std::size_t t = 0; t < frames.size(); ++t) {
            require(frames[t].cols() == motion.n_nodes(), name, text(motion.n_nodes(), " nodes"),
                    text(frames[t].cols(), " in frame ", t));
            require(frames[t].allFinite(), name, "finite values", text("a value that is not finite in frame ", t));
        }
    };
    check(motion.positions, "positions");
    check(motion.velocities, "velocities");
    check(motion.accelerations, "accelerations");
    check(motion.external_forces, "external_forces");
    require(motion.unobserved.empty() || motion.unobserved.size() == motion.times.size(), "unobserved",
            text(motion.n_frames(), " lists of nodes, one per frame, or none"), motion.unobserved.size());
    require(motion.noise >= 0 && std::isfinite(motion.noise), "noise", "a length not below 0", motion.noise);
    for (std::size_t t = 1; t < motion.times.size(); ++t) {
        require(motion.times[t] > motion.times[t - 1], "times", "increasing values",
                text(motion.times[t], " after ", motion.times[t - 1]));
    }
}

} // namespace springfit
