// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <springfit/calibrate/calibrate.hpp>

namespace springfit::detail {

/// Units in which a network has the size, the mass and the mean stiffness 1. A calibration works in them, on numbers
/// rounded to fewer bits than rounding errors reach: it takes the same course whatever units it is given in.
template <int Dim>
class NetworkUnits {
public:
    explicit NetworkUnits(const SpringNetwork<Dim, double>& network)
        : m_length((network.rest_positions.rowwise().maxCoeff() - network.rest_positions.rowwise().minCoeff()).norm()),
          m_mass(network.mass.sum()), m_time(std::sqrt(m_mass / network.stiffness.mean())) {}

    [[nodiscard]] double time() const { return m_time; }

    [[nodiscard]] SpringNetwork<Dim, double> to_own(SpringNetwork<Dim, double> network) const {
        network.rest_positions = rest_positions_in_own(network.rest_positions);
        network.mass = rounded(network.mass / m_mass);
        network.stiffness = rounded(network.stiffness * (m_time * m_time / m_mass));
        network.damping = rounded(network.damping * (m_time / m_mass));
        network.rest_length = rounded(network.rest_length / m_length);
        network.rest_volume = rounded(network.rest_volume / std::pow(m_length, Dim));
        network.volume_stiffness = rounded(network.volume_stiffness / modulus());
        return network;
    }

    /// The fitted values of a network of these units, in those of `like`; the rest of it is that of `like`.
    [[nodiscard]] SpringNetwork<Dim, double> from_own(const SpringNetwork<Dim, double>& fitted,
                                                      SpringNetwork<Dim, double> like) const {
        const auto own = to_own(like);
        like.stiffness = fitted.stiffness * (m_mass / (m_time * m_time));
        like.damping = fitted.damping * (m_mass / m_time);
        like.volume_stiffness = fitted.volume_stiffness * modulus();
        if (fitted.rest_length != own.rest_length) {
            like.rest_length = fitted.rest_length * m_length;
        }
        return like;
    }

    [[nodiscard]] RecordedCases<Dim, double> to_own(const RecordedCases<Dim, double>& cases) const {
        RecordedCases<Dim, double> own = cases;
        const int bits = cases.period > 0 ? bits_of_simulations : bits_of_recordings;
        for (auto* set : {&own.training, &own.held_out}) {
            for (std::size_t c = 0; c < set->size(); ++c) {
                set->motions[c] = to_own(std::move(set->motions[c]), bits);
                set->cases[c].scenario = to_own(std::move(set->cases[c].scenario));
            }
        }
        own.stiffness_damping = cases.stiffness_damping / m_time;
        own.period = cases.period / m_time;
        return own;
    }

private:
    using Frames = std::vector<Points<Dim, double>>;

    [[nodiscard]] double acceleration() const { return m_length / (m_time * m_time); }
    [[nodiscard]] double force() const { return m_mass * acceleration(); }
    [[nodiscard]] double modulus() const { return force() / std::pow(m_length, Dim - 1); }

    /// To 36 bits each.
    static Values<double> rounded(const Values<double>& values) {
        return values.unaryExpr([](double value) {
            int exponent = 0;
            const double part = std::frexp(value, &exponent);
            return std::ldexp(std::round(std::ldexp(part, 36)), exponent - 36);
        });
    }

    static Points<Dim, double> on_grid(const Points<Dim, double>& points, double grid) {
        return grid > 0 ? Points<Dim, double>((points / grid).array().round().matrix() * grid) : points;
    }

    [[nodiscard]] Points<Dim, double> rest_positions_in_own(const Points<Dim, double>& points) const {
        return on_grid(points / m_length, std::ldexp(1., -36));
    }

    static constexpr int bits_of_simulations = 20; ///< they end at less
    static constexpr int bits_of_recordings = 34;  ///< which are the same but for the last of their 52 bits

    /// All to so many bits of the largest.
    static void round(Frames& frames, int bits) {
        double largest = 0;
        for (const auto& frame : frames) {
            largest = std::max(largest, frame.cwiseAbs().maxCoeff());
        }
        const double grid = largest > 0 ? std::ldexp(1., std::ilogb(largest) - bits) : 0.;
        for (auto& frame : frames) {
            frame = on_grid(frame, grid);
        }
    }

    [[nodiscard]] Motion<Dim, double> to_own(Motion<Dim, double> motion, int bits) const {
        const auto rest = rest_positions_in_own(motion.rest_positions);
        const auto scale = [bits](Frames& frames, double factor) {
            for (auto& frame : frames) {
                frame *= factor;
            }
            round(frames, bits);
        };
        for (auto& positions : motion.positions) {
            positions -= motion.rest_positions;
        }
        scale(motion.positions, 1 / m_length);
        for (auto& positions : motion.positions) {
            positions += rest;
        }
        scale(motion.velocities, m_time / m_length);
        scale(motion.accelerations, 1 / acceleration());
        scale(motion.external_forces, 1 / force());
        motion.rest_positions = rest;
        motion.noise /= m_length;
        Values<double> times = Values<double>::Map(motion.times.data(), motion.n_frames()) / m_time;
        times = rounded(times);
        motion.times.assign(times.begin(), times.end());
        return motion;
    }

    [[nodiscard]] Amplitude<double> to_own(const Amplitude<double>& amplitude) const {
        if (!amplitude) {
            return amplitude;
        }
        return [amplitude, unit = m_time](double time) { return amplitude(time * unit); };
    }

    [[nodiscard]] Scenario<Dim, double> to_own(Scenario<Dim, double> scenario) const {
        for (auto& clamp : scenario.clamps) {
            if (clamp.position) {
                clamp.position = [position = clamp.position, length = m_length,
                                  unit = m_time](const Vector<Dim, double>& rest, double time) -> Vector<Dim, double> {
                    return position(rest * length, time * unit) / length;
                };
            }
        }
        for (auto& gravity : scenario.gravity) {
            gravity.acceleration /= acceleration();
            gravity.amplitude = to_own(gravity.amplitude);
        }
        for (auto& load : scenario.loads) {
            load.forces /= force();
            load.amplitude = to_own(load.amplitude);
        }
        scenario.initial_positions /= m_length;
        scenario.initial_velocities *= m_time / m_length;
        return scenario;
    }

    double m_length; ///< m
    double m_mass;   ///< kg
    double m_time;   ///< s
};

} // namespace springfit::detail
