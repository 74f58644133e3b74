// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <springfit/motion/motion.hpp>

namespace springfit::test {

/// A motion that can be told in closed form, for readers in other languages to compare with: at times 0.1 t + 0.01 t^2,
///
///     displacement(t, i, d) = 0.1 sin(3 time + i + 2 d),  velocity and acceleration its derivatives,
///     force(t, i, d) = t + 10 i + 100 d.
///
/// Nodes 0 and 2 are called clamped.
template <int Dim, std::floating_point Scalar>
Motion<Dim, Scalar> analytic_motion(const Points<Dim, Scalar>& rest_positions, int n_frames) {
    Motion<Dim, Scalar> motion;
    motion.name = "analytic <case> & more";
    motion.rest_positions = rest_positions;
    motion.clamped = {0, 2};
    for (int t = 0; t < n_frames; ++t) {
        const double time = 0.1 * t + 0.01 * t * t;
        Points<Dim, Scalar> u(Dim, motion.n_nodes());
        Points<Dim, Scalar> v = u;
        Points<Dim, Scalar> a = u;
        Points<Dim, Scalar> f = u;
        for (int i = 0; i < motion.n_nodes(); ++i) {
            for (int d = 0; d < Dim; ++d) {
                const double phase = 3 * time + i + 2 * d;
                u(d, i) = static_cast<Scalar>(0.1 * std::sin(phase));
                v(d, i) = static_cast<Scalar>(0.3 * std::cos(phase));
                a(d, i) = static_cast<Scalar>(-0.9 * std::sin(phase));
                f(d, i) = static_cast<Scalar>(t + 10 * i + 100 * d);
            }
        }
        motion.times.push_back(static_cast<Scalar>(time));
        motion.positions.push_back(rest_positions + u);
        motion.velocities.push_back(v);
        motion.accelerations.push_back(a);
        motion.external_forces.push_back(f);
    }
    return motion;
}

} // namespace springfit::test
