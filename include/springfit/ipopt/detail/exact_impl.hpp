// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/stopwatch.hpp>
#include <springfit/ipopt/detail/application.hpp>
#include <springfit/ipopt/detail/box_program.hpp>
#include <springfit/ipopt/detail/polish.hpp>
#include <springfit/ipopt/exact.hpp>

namespace springfit::ipopt {

inline AccelerationReport exact(const AccelerationProblem& problem, const ExactOptions& options) {
    require(options.initial.size() == 0 || options.initial.size() == problem.n_unknowns(), "initial",
            text(problem.n_unknowns(), " values, one per unknown"), options.initial.size());
    require(options.initial.allFinite(), "initial", "finite values", "a value that is not finite");
    const Stopwatch watch;
    AccelerationReport report;
    report.theta = options.initial.size() > 0 ? options.initial.cwiseMax(problem.lower).cwiseMin(problem.upper).eval()
                                              : problem.prior;
    report.objective_start = problem.objective.value(report.theta);

    const auto application =
        detail::make_application(options, {{"hessian_constant", "yes"}, {"mehrotra_algorithm", "yes"}});
    const detail::ScaledQuadratic scaled(problem);
    report.status = Status::converged;
    bool polished = true;
    Values<double> lower_multipliers = Values<double>::Zero(problem.n_unknowns());
    Values<double> upper_multipliers = lower_multipliers;
    if (scaled.size() > 0) {
        const Values<double> start = report.theta(scaled.moving).cwiseQuotient(scaled.scale);
        using Program = detail::BoxProgram<const detail::ScaledQuadratic>;
        const Ipopt::SmartPtr<Program> program =
            new Program(scaled, start, options.progress, "exact fit", options.max_iterations);
        report.status = detail::status_of(application->OptimizeTNLP(Ipopt::GetRawPtr(program)));
        if (program->exception) {
            std::rethrow_exception(program->exception);
        }
        report.iterations = program->iterations;
        const double offset = report.objective_start - scaled.objective_unit * scaled.value(start);
        for (double value : program->history) {
            report.history.push_back(std::max(offset + scaled.objective_unit * value, 0.));
        }
        Values<double> x = program->best();
        if (report.status == Status::converged || report.status == Status::stalled) {
            x = program->x;
            scaled.snap(program->lower_multipliers, program->upper_multipliers, x);
            polished = detail::Polish(scaled).improve(x);
            const double unit = scaled.objective_unit;
            lower_multipliers(scaled.moving) = unit * program->lower_multipliers.cwiseQuotient(scaled.scale);
            upper_multipliers(scaled.moving) = unit * program->upper_multipliers.cwiseQuotient(scaled.scale);
        }
        report.theta = scaled.unscaled(x, problem.lower, problem.upper);
    }
    complete(problem, report);
    if (!polished) {
        report.lower_multipliers = lower_multipliers;
        report.upper_multipliers = upper_multipliers;
    }
    if (report.status == Status::converged || report.status == Status::stalled) {
        report.status = report.kkt_residual <= options.tolerance ? Status::converged : Status::stalled;
    }
    report.seconds = watch.seconds();
    return report;
}

} // namespace springfit::ipopt
