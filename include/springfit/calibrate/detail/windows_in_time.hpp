// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>

#include <springfit/core/stage.hpp>
#include <springfit/fit/trajectory/gauss_newton.hpp>
#include <springfit/network/damping.hpp>
#include <springfit/score/frequency.hpp>

namespace springfit::detail {

inline constexpr int most_steps_per_frame = 16;

/// Part of the misfit that the integrator's own error may be.
inline constexpr double step_error_limit = 0.1;

/// Steps of the implicit midpoint rule in a frame by which a window's phase is off by less than 0.01, 8 at most. At a
/// frequency omega the rule is behind by (omega h)^3 / 12 a step; omega is that of the motion, |a| / |v| in the mean.
template <int Dim>
int steps_per_frame(const std::vector<Motion<Dim, double>>& motions, int horizon) {
    double most = 1;
    for (const auto& motion : motions) {
        double a = 0, v = 0;
        for (std::size_t t = 0; t < motion.times.size() && motion.n_frames() > 1; ++t) {
            a += motion.accelerations[t].squaredNorm();
            v += motion.velocities[t].squaredNorm();
        }
        if (v > 0) {
            const auto frames = static_cast<double>(motion.n_frames() - 1);
            const double angle = std::sqrt(a / v) * (motion.times.back() - motion.times.front()) / frames;
            const double n = horizon > 0 ? std::min<double>(horizon, frames) : frames;
            most = std::max(most, std::sqrt(n * angle * angle * angle / 12 / 0.01));
        }
    }
    return static_cast<int>(std::ceil(std::min(most, 8.)));
}

/// Relative error of a network in the windows of motions, J's misfit.
template <int Dim>
double window_misfit(const SpringNetwork<Dim, double>& network, const std::vector<Motion<Dim, double>>& motions,
                     const TrajectoryOptions& how) {
    const TrajectoryProblem<Dim> problem(network, motions, how);
    return gauss_newton(problem, {.max_iterations = 0}).misfit_start;
}

/// The number in [low, high], both positive, with the least value, and that value, by golden sections of its logarithm.
template <class Function>
std::pair<double, double> least_value(double low, double high, const Function& function) {
    constexpr double golden = 0.6180339887498949;
    low = std::log(low);
    high = std::log(high);
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double at_a = function(std::exp(a)), at_b = function(std::exp(b));
    for (int section = 0; section < 10; ++section) {
        if (at_a < at_b) {
            high = b;
            b = a;
            at_b = at_a;
            a = high - golden * (high - low);
            at_a = function(std::exp(a));
        } else {
            low = a;
            a = b;
            at_a = at_b;
            b = low + golden * (high - low);
            at_b = function(std::exp(b));
        }
    }
    return at_a < at_b ? std::pair{std::exp(a), at_a} : std::pair{std::exp(b), at_b};
}

/// The damping that was found, and where matching may go on from.
struct FoundDamping {
    double beta = 0;      ///< of D = beta K, s
    Values<double> theta; ///< of matching without damping; empty where that failed
};

/// The beta of D = beta K that is best in the windows of at most two motions, stiffness being matched without damping
/// first; 0 where none gains a tenth. (Whole motions out of phase would call for damping.) With a `ratio` of critical
/// it is that of the network's slowest motion.
template <int Dim>
FoundDamping find_damping(SpringNetwork<Dim, double> network, const std::vector<Motion<Dim, double>>& all,
                          TrajectoryOptions how, const std::optional<double>& ratio, const ProgressCallback& progress) {
    std::vector<Motion<Dim, double>> motions;
    std::copy_if(all.begin(), all.end(), std::back_inserter(motions),
                 [&](const auto& motion) { return motion.n_frames() > 1 && motions.size() < 2; });
    how.parameters.damping_per_stiffness = 0;
    network.damping.setZero();
    const TrajectoryProblem<Dim> problem(network, motions, how);
    FoundDamping found;
    const auto report = gauss_newton(problem, {.max_iterations = 8, .tolerance = 0.02, .progress = progress});
    if (usable(report.status)) {
        apply(problem, report, network);
        found.theta = report.theta;
    }
    const double omega = lowest_frequency(network, motions.front().clamped).omega;
    if (!(omega > 0)) {
        return found;
    }
    if (ratio) {
        found.beta = 2 * *ratio / omega;
        return found;
    }
    const auto misfit = [&](double zeta) {
        how.parameters.damping_per_stiffness = 2 * zeta / omega;
        network.damping = stiffness_proportional_damping(network, 2 * zeta / omega);
        return window_misfit(network, motions, how);
    };
    const auto [zeta, least] = least_value(0.001, 0.5, misfit);
    found.beta = least < 0.9 * misfit(0) ? 2 * zeta / omega : 0.;
    return found;
}

} // namespace springfit::detail
