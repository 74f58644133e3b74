// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <springfit/core/maximum.hpp>
#include <springfit/fit/trajectory/problem.hpp>
#include <springfit/fit/trajectory/report.hpp>

/// Shared by the engines of trajectory matching: where they start, and what they report.
namespace springfit::detail {

/// Marks unknowns that sit at a bound and would leave it along minus the gradient.
inline std::vector<bool> at_active_bound(const Values<double>& theta, const Values<double>& gradient,
                                         const Values<double>& lower, const Values<double>& upper) {
    std::vector<bool> active(static_cast<std::size_t>(theta.size()));
    for (Index u = 0; u < theta.size(); ++u) {
        active[static_cast<std::size_t>(u)] =
            (theta(u) <= lower(u) && gradient(u) > 0) || (theta(u) >= upper(u) && gradient(u) < 0);
    }
    return active;
}

/// NaN where an entry is.
inline double largest_projected(const Values<double>& gradient, const std::vector<bool>& active) {
    double largest = 0;
    for (Index u = 0; u < gradient.size(); ++u) {
        largest = maximum(largest, active[static_cast<std::size_t>(u)] ? 0. : std::abs(gradient(u)));
    }
    return largest;
}

/// The curvature of the data along each unknown, and what part the data has in it beside the prior.
inline void set_curvature(Values<double> curvature, double lambda, TrajectoryReport& report) {
    report.data_share = curvature.array() / (curvature.array() + std::max(lambda, 1e-300));
    report.curvature = std::move(curvature);
}

/// Moves `point` to given values, one per unknown, within the bounds, and fills the start of a report. False where none
/// are given or they cannot be simulated.
template <int Dim>
[[nodiscard]] bool move_to_given(const TrajectoryProblem<Dim>& problem, const Values<double>& start,
                                 TrajectoryPoint<Dim>& point, Values<double>& gradient, TrajectoryReport& report) {
    require(start.size() == 0 || start.size() == problem.n_unknowns(), "start",
            text(problem.n_unknowns(), " values, one per unknown"), start.size());
    const auto& parameters = problem.parameters();
    if (start.size() == 0 || !point.move_to(start.cwiseMax(parameters.lower()).cwiseMin(parameters.upper())) ||
        !point.gradient(gradient)) {
        return false;
    }
    report.theta = point.theta();
    report.objective_start = point.value();
    report.misfit_start = point.misfit();
    return true;
}

/// Moves `point` to the prior, or to 2, 4 or 8 times its stiffness where the prior fails or that halves J, within the
/// bounds, and fills the start of a report. False where none of them can be simulated. `trial` is working memory.
template <int Dim>
[[nodiscard]] bool move_to_start(const TrajectoryProblem<Dim>& problem, const Values<double>& lower,
                                 const Values<double>& upper, std::unique_ptr<TrajectoryPoint<Dim>>& point,
                                 std::unique_ptr<TrajectoryPoint<Dim>>& trial, Values<double>& gradient,
                                 TrajectoryReport& report) {
    const Index n = problem.n_unknowns();
    report.theta = Values<double>::Zero(n).cwiseMax(lower).cwiseMin(upper);
    report.objective_start = report.misfit_start = std::numeric_limits<double>::infinity();
    report.curvature = report.data_share = Values<double>::Zero(n);
    bool started = false;
    for (double factor : {1., 2., 4., 8.}) { // a prior that is too soft folds under its loads, or cannot hold them
        const Values<double> theta = problem.parameters().uniform_stiffness(factor).cwiseMax(lower).cwiseMin(upper);
        Values<double> own_gradient;
        ++report.evaluations;
        const bool is_stable = trial->move_to(theta) && trial->gradient(own_gradient);
        if (is_stable && factor == 1.) {
            report.objective_start = trial->value();
            report.misfit_start = trial->misfit();
        }
        if (is_stable && (!started || trial->value() < point->value() / 2)) {
            point.swap(trial);
            gradient.swap(own_gradient);
            started = true;
        } else if (started) {
            break;
        }
    }
    return started;
}

} // namespace springfit::detail
