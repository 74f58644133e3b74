// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>

#include <Eigen/QR>

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

/// Coordinate of motions along their principal motion phi, u = x - x_rest: q = phi' M u, and its equation
/// q'' = -omega^2 q - c q' + gamma phi' f, by least squares over all frames.
struct PrincipalMotion {
    double omega_squared = 0;
    double c = 0;
};

/// The equation of the principal motion; phi is where iterations u (u' M phi) over all frames lead from the largest u.
template <int Dim>
PrincipalMotion principal_motion(const std::vector<Motion<Dim, double>>& motions, const Values<double>& mass) {
    constexpr int n_iterations = 20;
    const Values<double> m = mass.transpose().replicate(Dim, 1).reshaped();
    const auto moved = [](const auto& motion, std::size_t t) -> Values<double> {
        return (motion.positions[t] - motion.rest_positions).reshaped();
    };
    Values<double> phi = Values<double>::Zero(m.size());
    for (const auto& motion : motions) {
        for (std::size_t t = 0; t < motion.positions.size(); ++t) {
            const Values<double> u = moved(motion, t);
            phi = u.squaredNorm() > phi.squaredNorm() ? u : phi;
        }
    }
    for (int iteration = 0; iteration < n_iterations; ++iteration) {
        const Values<double> along = m.cwiseProduct(phi);
        phi.setZero();
        for (const auto& motion : motions) {
            for (std::size_t t = 0; t < motion.positions.size(); ++t) {
                const Values<double> u = moved(motion, t);
                phi += u.dot(along) * u;
            }
        }
        phi /= std::sqrt(phi.dot(m.cwiseProduct(phi)));
    }
    const Values<double> along = m.cwiseProduct(phi);
    Index n_frames = 0;
    for (const auto& motion : motions) {
        n_frames += motion.n_frames();
    }
    DenseMatrix<double> terms(n_frames, 3);
    Values<double> accelerations(n_frames);
    Index row = 0;
    for (const auto& motion : motions) {
        for (std::size_t t = 0; t < motion.positions.size(); ++t, ++row) {
            terms.row(row) << moved(motion, t).dot(along), along.dot(motion.velocities[t].reshaped()),
                phi.dot(motion.external_forces[t].reshaped());
            accelerations(row) = along.dot(motion.accelerations[t].reshaped());
        }
    }
    const Values<double> found = terms.colPivHouseholderQr().solve(accelerations);
    return found.allFinite() ? PrincipalMotion{-found(0), -found(1)} : PrincipalMotion{};
}

/// The damping that was found, and where matching may go on from.
struct FoundDamping {
    double beta = 0;      ///< of D = beta K, s
    Values<double> theta; ///< of the matching that found it; empty where that failed
};

/// The beta of D = beta K, fitted with the stiffness in the windows of at most two motions, from where the decay of
/// their principal motion says; 0 where the windows do not call for it. (Whole motions out of phase would.) With a
/// `ratio` of critical it is that of the network's slowest motion.
template <int Dim>
FoundDamping find_damping(SpringNetwork<Dim, double> network, const std::vector<Motion<Dim, double>>& all,
                          TrajectoryOptions how, const std::optional<double>& ratio, const ProgressCallback& progress) {
    constexpr double least = 0.001, most = 0.5; // parts of critical
    std::vector<Motion<Dim, double>> motions;
    std::copy_if(all.begin(), all.end(), std::back_inserter(motions),
                 [&](const auto& motion) { return motion.n_frames() > 1 && motions.size() < 2; });
    const PrincipalMotion principal = principal_motion(motions, network.mass);
    const double omega = principal.omega_squared > 0 ? std::sqrt(principal.omega_squared)
                                                     : lowest_frequency(network, motions.front().clamped).omega;
    FoundDamping found;
    if (!(omega > 0)) {
        return found;
    }
    auto& fitted = how.parameters;
    fitted.damping_per_stiffness = 2 * std::clamp(principal.c / (2 * omega), least, most) / omega;
    fitted.fit_damping_per_stiffness = true;
    network.damping = stiffness_proportional_damping(network, fitted.damping_per_stiffness);
    const TrajectoryProblem<Dim> problem(network, motions, how);
    const auto report = gauss_newton(problem, {.max_iterations = 8, .tolerance = 0.02, .progress = progress});
    if (usable(report.status)) {
        apply(problem, report, network);
        found.beta = problem.parameters().damping_per_stiffness(report.theta);
        found.theta = report.theta.head(report.theta.size() - 1); // but for beta's
    }
    const double slowest = lowest_frequency(network, motions.front().clamped).omega;
    if (ratio) {
        found.beta = slowest > 0 ? 2 * *ratio / slowest : 0.;
    } else if (found.beta > 0) {
        fitted.damping_per_stiffness = 0;
        fitted.fit_damping_per_stiffness = false;
        network.damping.setZero();
        const double undamped = window_misfit(network, motions, how);
        const bool is_needed = found.beta * slowest / 2 > least && report.misfit < 0.9 * undamped;
        found.beta = is_needed ? found.beta : 0.;
    }
    return found;
}

} // namespace springfit::detail
