// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <springfit/fit/acceleration_objective.hpp>
#include <springfit/motion/motion.hpp>
#include <springfit/network/forces.hpp>

namespace bench {

/// What the springs are fitted to.
enum class Excitation {
    rich, ///< twelve waves of about the body's size, and accelerations with three times their size in noise: 13 % of
          ///< the springs end on their bound
    poor  ///< two longer waves, and a tenth in noise: hardly anything tells one spring from the next
};

/// 200 frames of smooth motion with the network's own accelerations and noise.
template <int Dim, class Scalar>
[[nodiscard]] springfit::Motion<Dim, Scalar> smooth_motion(const springfit::SpringNetwork<Dim, Scalar>& network,
                                                           Excitation excitation) {
    using namespace springfit;
    const bool rich = excitation == Excitation::rich;
    std::mt19937 random(3);
    std::normal_distribution<Scalar> normal;
    const auto vector = [&] {
        Vector<Dim, Scalar> v;
        for (int d = 0; d < Dim; ++d) {
            v(d) = normal(random);
        }
        return v;
    };
    struct Wave {
        Vector<Dim, Scalar> direction, wave_vector;
        Scalar frequency, phase;
    };
    std::vector<Wave> waves;
    for (int w = 0; w < (rich ? 12 : 2); ++w) {
        waves.push_back({Scalar(0.02) * vector(), Scalar(rich ? 4 : 1) * vector(), 1 + normal(random), normal(random)});
    }
    Motion<Dim, Scalar> motion;
    motion.rest_positions = network.rest_positions;
    const Points<Dim, Scalar> zero = Points<Dim, Scalar>::Zero(Dim, network.n_nodes());
    for (int t = 0; t < 200; ++t) {
        const Scalar time = Scalar(0.05) * static_cast<Scalar>(t);
        Points<Dim, Scalar> x = network.rest_positions;
        Points<Dim, Scalar> v = zero;
        for (const Wave& wave : waves) {
            for (Index i = 0; i < x.cols(); ++i) {
                const Scalar angle =
                    wave.wave_vector.dot(network.rest_positions.col(i)) + wave.frequency * time + wave.phase;
                x.col(i) += std::sin(angle) * wave.direction;
                v.col(i) += wave.frequency * std::cos(angle) * wave.direction;
            }
        }
        Points<Dim, Scalar> a;
        compute_accelerations<Dim, Scalar>(network, x, v, zero, a);
        const Scalar noise = Scalar(rich ? 3 : 0.1) * a.norm() / std::sqrt(static_cast<Scalar>(a.size()));
        for (Index i = 0; i < a.cols(); ++i) {
            a.col(i) += noise * vector();
        }
        motion.times.push_back(time);
        motion.positions.push_back(x);
        motion.velocities.push_back(v);
        motion.accelerations.push_back(a);
        motion.external_forces.push_back(zero);
    }
    return motion;
}

/// The fit of a network's springs, from a stiffness of 1000 N/m on, to its own noisy motion.
template <int Dim, class Scalar>
[[nodiscard]] springfit::FitProblem fit_problem(springfit::SpringNetwork<Dim, Scalar> network,
                                                const springfit::Motion<Dim, Scalar>& motion) {
    network.stiffness.setConstant(1000);
    return springfit::acceleration_problem<Dim, Scalar>(network, {motion});
}

} // namespace bench
