// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <springfit/fit/acceleration/objective.hpp>
#include <springfit/motion/motion.hpp>
#include <springfit/network/forces.hpp>

namespace bench {

/// What the springs are fitted to.
enum class Excitation {
    rich, ///< twelve waves of about the body's size, and accelerations with three times their size in noise: 13 % of
          ///< the springs end on their bound
    poor  ///< two longer waves, and a tenth in noise: hardly anything tells one spring from the next
};

/// Frames of smooth motion with a network's own accelerations and noise, one after another.
template <int Dim, class Scalar>
class Waves {
public:
    Waves(const springfit::SpringNetwork<Dim, Scalar>& network, Excitation excitation)
        : m_network(network), m_rich(excitation == Excitation::rich),
          m_zero(springfit::Points<Dim, Scalar>::Zero(Dim, network.n_nodes())) {
        for (int w = 0; w < (m_rich ? 12 : 2); ++w) {
            m_waves.push_back({Scalar(0.02) * vector(), Scalar(m_rich ? 4 : 1) * vector(), 1 + m_normal(m_random),
                               m_normal(m_random)});
        }
    }

    static constexpr int n_frames = 200;
    [[nodiscard]] static Scalar time(int frame) { return Scalar(0.05) * static_cast<Scalar>(frame); }

    /// Calls `take(positions, velocities, accelerations, external forces)`.
    template <class Take>
    void next(int frame, const Take& take) {
        springfit::Points<Dim, Scalar> x = m_network.rest_positions;
        springfit::Points<Dim, Scalar> v = m_zero;
        springfit::Points<Dim, Scalar> a;
        for (const Wave& wave : m_waves) {
            for (springfit::Index i = 0; i < x.cols(); ++i) {
                const Scalar angle =
                    wave.wave_vector.dot(m_network.rest_positions.col(i)) + wave.frequency * time(frame) + wave.phase;
                x.col(i) += std::sin(angle) * wave.direction;
                v.col(i) += wave.frequency * std::cos(angle) * wave.direction;
            }
        }
        springfit::compute_accelerations<Dim, Scalar>(m_network, x, v, m_zero, a);
        const Scalar noise = Scalar(m_rich ? 3 : 0.1) * a.norm() / std::sqrt(static_cast<Scalar>(a.size()));
        for (springfit::Index i = 0; i < a.cols(); ++i) {
            a.col(i) += noise * vector();
        }
        take(x, v, a, m_zero);
    }

private:
    struct Wave {
        springfit::Vector<Dim, Scalar> direction, wave_vector;
        Scalar frequency, phase;
    };

    springfit::Vector<Dim, Scalar> vector() {
        springfit::Vector<Dim, Scalar> v;
        for (int d = 0; d < Dim; ++d) {
            v(d) = m_normal(m_random);
        }
        return v;
    }

    const springfit::SpringNetwork<Dim, Scalar>& m_network;
    bool m_rich;
    springfit::Points<Dim, Scalar> m_zero;
    std::mt19937 m_random{3};
    std::normal_distribution<Scalar> m_normal;
    std::vector<Wave> m_waves;
};

/// All frames.
template <int Dim, class Scalar>
[[nodiscard]] springfit::Motion<Dim, Scalar> smooth_motion(const springfit::SpringNetwork<Dim, Scalar>& network,
                                                           Excitation excitation) {
    using Points = springfit::Points<Dim, Scalar>;
    springfit::Motion<Dim, Scalar> motion;
    motion.rest_positions = network.rest_positions;
    Waves<Dim, Scalar> waves(network, excitation);
    for (int t = 0; t < waves.n_frames; ++t) {
        waves.next(t, [&](const Points& x, const Points& v, const Points& a, const Points& f) {
            motion.times.push_back(waves.time(t));
            motion.positions.push_back(x);
            motion.velocities.push_back(v);
            motion.accelerations.push_back(a);
            motion.external_forces.push_back(f);
        });
    }
    return motion;
}

/// The stiffness that fits begin with, N/m.
inline constexpr double start_stiffness = 1000;

/// The fit of a network's springs to its own noisy motion.
template <int Dim, class Scalar>
[[nodiscard]] springfit::AccelerationProblem fit_problem(springfit::SpringNetwork<Dim, Scalar> network,
                                                         const springfit::Motion<Dim, Scalar>& motion) {
    network.stiffness.setConstant(Scalar(start_stiffness));
    return springfit::acceleration_problem<Dim, Scalar>(network, {motion});
}

} // namespace bench
