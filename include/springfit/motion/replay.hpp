// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <memory>

#include <springfit/motion/motion.hpp>

namespace springfit {

/// Frames [first, last) of a motion, with time counted from the first of them.
/// Throws InvalidArgument unless 0 <= first < last <= n_frames.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Motion<Dim, Scalar> excerpt(const Motion<Dim, Scalar>& motion, Index first, Index last) {
    require(first >= 0 && first < last && last <= motion.n_frames(), "frames",
            text("a range within the ", motion.n_frames(), " frames of the motion"), text("[", first, ", ", last, ")"));
    const auto part = [&](const auto& frames) {
        return std::remove_cvref_t<decltype(frames)>(frames.begin() + first, frames.begin() + last);
    };
    Motion<Dim, Scalar> result{motion.name,
                               motion.rest_positions,
                               motion.clamped,
                               part(motion.times),
                               part(motion.positions),
                               part(motion.velocities),
                               part(motion.accelerations),
                               part(motion.external_forces),
                               {},
                               motion.noise};
    if (!motion.unobserved.empty()) {
        result.unobserved = part(motion.unobserved);
    }
    for (Scalar& time : result.times) {
        time -= motion.times[static_cast<std::size_t>(first)];
    }
    return result;
}

namespace detail {

/// Value at `time` of a sequence of frames, linear between them, constant outside.
template <int Dim, std::floating_point Scalar>
Vector<Dim, Scalar> interpolated(const std::vector<Scalar>& times, const std::vector<Points<Dim, Scalar>>& frames,
                                 int node, Scalar time) {
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    if (after == times.begin()) {
        return frames.front().col(node);
    }
    const auto b = static_cast<std::size_t>(after - times.begin());
    if (after == times.end()) {
        return frames.back().col(node);
    }
    const Scalar s = (time - times[b - 1]) / (times[b] - times[b - 1]);
    return (1 - s) * frames[b - 1].col(node) + s * frames[b].col(node);
}

} // namespace detail

/// The scenario that does to a body what was done in a recorded motion: its start, its external forces and the motion
/// of its clamped nodes, linear in time between frames. Throws InvalidArgument for a motion without frames.
///
/// Cost of one evaluation of its forces: O(nodes with forces) for the two frames around the time.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Scenario<Dim, Scalar> replay(const Motion<Dim, Scalar>& motion) {
    require(motion.n_frames() > 0, "motion", "at least one frame", "none");
    const auto shared = std::make_shared<const Motion<Dim, Scalar>>(motion);
    Scenario<Dim, Scalar> scenario;
    scenario.name = motion.name;
    scenario.initial_positions = motion.positions.front();
    scenario.initial_velocities = motion.velocities.front();
    for (int node : motion.clamped) {
        Clamp<Dim, Scalar> clamp;
        clamp.nodes = {node};
        clamp.position = [shared, node](const Vector<Dim, Scalar>&, Scalar time) {
            return detail::interpolated<Dim, Scalar>(shared->times, shared->positions, node, time);
        };
        scenario.clamps.push_back(std::move(clamp));
    }
    // One load per frame, whose amplitude is the hat function around the frame's time.
    for (std::size_t t = 0; t < motion.times.size(); ++t) {
        const Points<Dim, Scalar>& forces = motion.external_forces[t];
        NodalLoad<Dim, Scalar> load;
        for (Index i = 0; i < forces.cols(); ++i) {
            if (forces.col(i).squaredNorm() > 0) {
                load.nodes.push_back(static_cast<int>(i));
            }
        }
        if (load.nodes.empty()) {
            continue;
        }
        load.forces = forces(Eigen::all, load.nodes);
        load.amplitude = [shared, t](Scalar time) {
            const auto& times = shared->times;
            if (time <= times[t]) {
                return t == 0 ? Scalar(1) : std::max(Scalar(0), 1 - (times[t] - time) / (times[t] - times[t - 1]));
            }
            return t + 1 == times.size() ? Scalar(1)
                                         : std::max(Scalar(0), 1 - (time - times[t]) / (times[t + 1] - times[t]));
        };
        scenario.loads.push_back(std::move(load));
    }
    return scenario;
}

} // namespace springfit
