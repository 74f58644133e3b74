// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/motion/motion.hpp>

namespace springfit {

/// The motion in m and s, where lengths were in units of `length` m and times in units of `time` s; forces are in N.
/// Throws InvalidArgument unless both are positive. O(nodes x frames).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Motion<Dim, Scalar> in_si_units(Motion<Dim, Scalar> motion, std::type_identity_t<Scalar> length,
                                              std::type_identity_t<Scalar> time) {
    require(length > 0 && std::isfinite(length), "length", "a positive unit, m", length);
    require(time > 0 && std::isfinite(time), "time", "a positive unit, s", time);
    const auto scale = [](std::vector<Points<Dim, Scalar>>& frames, Scalar factor) {
        for (auto& frame : frames) {
            frame *= factor;
        }
    };
    motion.rest_positions *= length;
    motion.noise *= length;
    scale(motion.positions, length);
    scale(motion.velocities, length / time);
    scale(motion.accelerations, length / (time * time));
    for (Scalar& t : motion.times) {
        t *= time;
    }
    return motion;
}

} // namespace springfit
