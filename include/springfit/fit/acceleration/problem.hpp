// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/maximum.hpp>
#include <springfit/core/status.hpp>
#include <springfit/fit/acceleration/node_quadratic.hpp>
#include <springfit/fit/acceleration/parameters.hpp>

namespace springfit {

/// Minimise a convex quadratic over a box: what every solver of the acceleration fit takes.
///
///     minimise Phi(theta)  subject to  lower <= theta <= upper
///
/// An unknown that no motion excites has `lower == upper`, its prior; so has one that the caller fixed.
struct AccelerationProblem {
    using Unknowns = NodeQuadratic::Unknowns;

    NodeQuadratic objective;         ///< Phi
    Parameters parameters;           ///< which spring has which unknown
    Values<double> lower, upper;     ///< [n_unknowns]; infinite where there is no bound
    Values<double> prior;            ///< [n_unknowns], within the bounds
    std::vector<int> not_identified; ///< unknowns that no motion excites, ascending

    [[nodiscard]] Index n_unknowns() const { return prior.size(); }
    [[nodiscard]] bool held(Index u) const { return !(lower(u) < upper(u)); }
};

/// The result of a solver of the acceleration fit.
struct AccelerationReport {
    Status status = Status::failed;
    Values<double> theta;             ///< [n_unknowns], within the bounds to the last bit
    double objective_start = 0;       ///< Phi where the iteration began
    double objective = 0;             ///< Phi(theta)
    std::vector<double> history;      ///< Phi after each sweep or iteration
    int iterations = 0;               ///< sweeps or iterations
    int products = 0;                 ///< products with H, or two sweeps over it, of `exact`
    int factorisations = 0;           ///< sparse factorisations of H, of `exact`; 0: conjugate gradients were enough
    double seconds = 0;               ///< wall clock of the solver
    double kkt_residual = 0;          ///< `kkt_residual(problem, theta)`
    Values<double> lower_multipliers; ///< >= 0 [n_unknowns]; gradient = lower_multipliers - upper_multipliers
    Values<double> upper_multipliers; ///< >= 0 [n_unknowns]
    std::vector<SpringParameter> at_lower;        ///< values that lie on their lower bound
    std::vector<SpringParameter> at_upper;        ///< values that lie on their upper bound
    std::vector<SpringParameter> not_identified;  ///< values that no motion excites: they got their prior
    std::vector<SpringParameter> without_unknown; ///< springs between nodes that never move freely: they kept theirs
};

/// Distance of theta from the optimum, free of units: with x = sqrt(H_uu) theta_u and its gradient q,
/// max |x - clip(x - q, bounds)| / max |q at theta = 0|; 0 exactly at the minimiser, NaN where anything is. `gradient`
/// is that of Phi at theta.
[[nodiscard]] inline double kkt_residual(const AccelerationProblem& problem, const Values<double>& theta,
                                         const Values<double>& gradient) {
    const Values<double> curvature = problem.objective.curvature();
    const Values<double> linear = problem.objective.linear();
    double largest = 0;
    double scale = 0;
    for (Index u = 0; u < problem.n_unknowns(); ++u) {
        if (problem.held(u) || curvature(u) <= 0) {
            continue;
        }
        const double step = gradient(u) / curvature(u);
        const double moved = std::clamp(theta(u) - step, problem.lower(u), problem.upper(u));
        const double root = std::sqrt(curvature(u));
        largest = maximum(largest, root * std::abs(theta(u) - moved));
        scale = maximum(scale, std::abs(linear(u)) / root);
    }
    return scale == 0 ? largest : largest / scale;
}

[[nodiscard]] inline double kkt_residual(const AccelerationProblem& problem, const Values<double>& theta) {
    return kkt_residual(problem, theta, problem.objective.product(theta) - problem.objective.linear());
}

/// Fills in what follows from `report.theta`: objective, residual, multipliers (from the gradient), active bounds.
inline void complete(const AccelerationProblem& problem, AccelerationReport& report) {
    const Values<double>& theta = report.theta;
    Values<double> gradient;
    report.objective = problem.objective.evaluate(theta, gradient);
    report.kkt_residual = kkt_residual(problem, theta, gradient);
    report.lower_multipliers = Values<double>::Zero(theta.size());
    report.upper_multipliers = Values<double>::Zero(theta.size());
    std::vector<int> low;
    std::vector<int> high;
    for (Index u = 0; u < theta.size(); ++u) {
        if (problem.held(u)) {
            continue;
        }
        if (theta(u) <= problem.lower(u)) {
            low.push_back(static_cast<int>(u));
            report.lower_multipliers(u) = std::max(gradient(u), 0.);
        } else if (theta(u) >= problem.upper(u)) {
            high.push_back(static_cast<int>(u));
            report.upper_multipliers(u) = std::max(-gradient(u), 0.);
        }
    }
    report.at_lower = problem.parameters.springs(low);
    report.at_upper = problem.parameters.springs(high);
    report.not_identified = problem.parameters.springs(problem.not_identified);
    report.without_unknown = problem.parameters.without_unknown();
}

/// Writes fitted values into the network that the problem was made from; what was not fitted stays.
///
/// A fitted preload moves the rest length to l = l^0 + q / k. Where k is 0 or l would not be positive, no rest length
/// can express q, and l^0 stays. Throws InvalidArgument unless the network has as many springs as that one.
template <int Dim, std::floating_point Scalar>
void apply(const AccelerationProblem& problem, const Values<double>& theta, SpringNetwork<Dim, Scalar>& network) {
    const Parameters& parameters = problem.parameters;
    require(network.n_springs() == parameters.n_springs(), "network", text(parameters.n_springs(), " springs"),
            network.n_springs());
    if (parameters.fits(ParameterKind::stiffness)) {
        network.stiffness = parameters.per_spring(ParameterKind::stiffness, theta).template cast<Scalar>();
    }
    if (parameters.damping_per_stiffness() > 0) {
        network.damping = static_cast<Scalar>(parameters.damping_per_stiffness()) * network.stiffness;
    }
    if (parameters.fits(ParameterKind::damping)) {
        network.damping = parameters.per_spring(ParameterKind::damping, theta).template cast<Scalar>();
    }
    if (parameters.fits(ParameterKind::preload)) {
        const Values<double> preload = parameters.per_spring(ParameterKind::preload, theta);
        for (Index e = 0; e < network.n_springs(); ++e) {
            const double given = parameters.rest_length()(e);
            const double length = given + preload(e) / static_cast<double>(network.stiffness(e));
            network.rest_length(e) = static_cast<Scalar>(std::isfinite(length) && length > 0 ? length : given);
        }
    }
}

template <int Dim, std::floating_point Scalar>
void apply(const AccelerationProblem& problem, const AccelerationReport& report, SpringNetwork<Dim, Scalar>& network) {
    apply(problem, report.theta, network);
}

} // namespace springfit
