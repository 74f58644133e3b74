// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>

#include <springfit/motion/motion.hpp>

namespace springfit {

/// Part of the mean time between frames by which evenly spaced frames may be off: recordings give times in few digits.
inline constexpr double even_within = 1e-3;

/// True where the frames of a motion are evenly spaced, to `even_within`.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] bool has_even_frames(const Motion<Dim, Scalar>& motion) {
    const auto n = static_cast<Scalar>(motion.n_frames() - 1);
    for (std::size_t t = 1; t < motion.times.size(); ++t) {
        const Scalar mean = (motion.times.back() - motion.times.front()) / n;
        if (!(std::abs(motion.times[t] - motion.times[t - 1] - mean) <= static_cast<Scalar>(even_within) * mean)) {
            return false;
        }
    }
    return true;
}

/// The motion at as many frames, evenly spaced from the first to the last. Positions are Hermite's cubic between two
/// frames, of their positions and velocities, and velocities its derivative; accelerations and forces are linear.
///
/// The error of a position is about (gap)^4 / 384 times its fourth derivative. Throws InvalidArgument for an invalid
/// motion and for fewer than two frames. O(frames x nodes).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Motion<Dim, Scalar> resample(const Motion<Dim, Scalar>& motion) {
    validate(motion);
    require(motion.n_frames() >= 2, text("motion '", motion.name, "'"), "at least two frames", motion.n_frames());
    Motion<Dim, Scalar> result = motion;
    const std::size_t n = motion.times.size();
    for (std::size_t t = 1; t + 1 < n; ++t) {
        const Scalar time = motion.times.front() + (motion.times.back() - motion.times.front()) *
                                                       static_cast<Scalar>(t) / static_cast<Scalar>(n - 1);
        const auto after = std::upper_bound(motion.times.begin() + 1, motion.times.end() - 1, time);
        const auto b = static_cast<std::size_t>(after - motion.times.begin());
        const std::size_t a = b - 1;
        const Scalar gap = motion.times[b] - motion.times[a];
        const Scalar s = (time - motion.times[a]) / gap;
        const auto linear = [&](const auto& frames) -> Points<Dim, Scalar> {
            return (1 - s) * frames[a] + s * frames[b];
        };
        const auto& xa = motion.positions[a];
        const auto& xb = motion.positions[b];
        const auto& va = motion.velocities[a];
        const auto& vb = motion.velocities[b];
        result.times[t] = time;
        result.positions[t] = (1 + 2 * s) * (1 - s) * (1 - s) * xa + s * s * (3 - 2 * s) * xb +
                              gap * s * (1 - s) * ((1 - s) * va - s * vb);
        result.velocities[t] = 6 * s * (1 - s) / gap * (xb - xa) + (1 - s) * (1 - 3 * s) * va + s * (3 * s - 2) * vb;
        result.accelerations[t] = linear(motion.accelerations);
        result.external_forces[t] = linear(motion.external_forces);
        if (!motion.unobserved.empty()) { // what either frame lacks
            result.unobserved[t].clear();
            std::set_union(motion.unobserved[a].begin(), motion.unobserved[a].end(), motion.unobserved[b].begin(),
                           motion.unobserved[b].end(), std::back_inserter(result.unobserved[t]));
        }
    }
    return result;
}

} // namespace springfit
