// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fit/acceleration/detail/node_estimate.hpp>
#include <springfit/fit/acceleration/dominant_term.hpp>

namespace springfit {

template <std::same_as<AccelerationProblem> Problem>
AccelerationReport one_pass(const Problem& problem, const OnePassOptions& options) {
    const Stopwatch watch;
    AccelerationReport report;
    report.theta = detail::one_pass_values(problem, options.execution);
    report.objective_start = problem.objective.value(problem.prior);
    report.iterations = 1;
    complete(problem, report);
    report.history = {report.objective};
    report.status = report.kkt_residual <= options.tolerance ? Status::converged : Status::iteration_limit;
    report.seconds = watch.seconds();
    return report;
}

} // namespace springfit
