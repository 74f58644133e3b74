// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

#include <springfit/ipopt/detail/box_program.hpp>
#include <springfit/ipopt/detail/polish.hpp>
#include <springfit/ipopt/exact.hpp>

namespace springfit::ipopt {

namespace detail {

inline void set_option(Ipopt::IpoptApplication& application, const std::string& name,
                       const std::variant<std::string, double, int>& value) {
    Ipopt::OptionsList& list = *application.Options();
    bool accepted = false;
    if (const auto* word = std::get_if<std::string>(&value)) {
        accepted = list.SetStringValue(name, *word);
    } else if (const auto* number = std::get_if<double>(&value)) {
        accepted = list.SetNumericValue(name, *number);
    } else {
        accepted = list.SetIntegerValue(name, std::get<int>(value));
    }
    require(accepted, text("ipopt option ", name), "an option and value that Ipopt knows",
            std::visit([](const auto& v) { return text(v); }, value));
}

inline Ipopt::SmartPtr<Ipopt::IpoptApplication> make_application(const ExactOptions& options) {
    // Ipopt writes to its own streams from the first option on, so that the console is made only where it is asked for.
    Ipopt::SmartPtr<Ipopt::IpoptApplication> application =
        new Ipopt::IpoptApplication(/*create_console_out*/ options.print_level > 0);
    application->RethrowNonIpoptException(true);
    std::map<std::string, std::variant<std::string, double, int>> all{
        {"tol", options.tolerance},
        {"dual_inf_tol", options.tolerance},
        {"compl_inf_tol", options.tolerance},
        {"max_iter", options.max_iterations},
        {"print_level", options.print_level},
        {"sb", options.print_level > 0 ? "no" : "yes"},
        {"hessian_constant", "yes"},
        {"mehrotra_algorithm", "yes"},
        {"nlp_scaling_method", "none"},
        {"bound_relax_factor", 0.},
    };
    for (const auto& [name, value] : options.ipopt) {
        all[name] = value;
    }
    for (const auto& [name, value] : all) {
        set_option(*application, name, value);
    }
    const Ipopt::ApplicationReturnStatus status = application->Initialize(std::string()); // no file of options
    require(status == Ipopt::Solve_Succeeded, "ipopt options", "options that fit together", static_cast<int>(status));
    return application;
}

inline Status status_of(Ipopt::ApplicationReturnStatus status) {
    switch (status) {
    case Ipopt::Solve_Succeeded: return Status::converged;
    case Ipopt::Solved_To_Acceptable_Level:
    case Ipopt::Search_Direction_Becomes_Too_Small:
    case Ipopt::Restoration_Failed: return Status::stalled;
    case Ipopt::User_Requested_Stop: return Status::interrupted;
    case Ipopt::Maximum_Iterations_Exceeded:
    case Ipopt::Maximum_CpuTime_Exceeded: return Status::iteration_limit;
    case Ipopt::Diverging_Iterates:
    case Ipopt::Invalid_Number_Detected: return Status::diverged;
    default: return Status::failed;
    }
}

/// x as values of the unknowns, within the bounds to the last bit, and on a bound where x is.
inline Values<double> unscaled(const FitProblem& problem, const ScaledProblem& scaled, const Values<double>& x) {
    Values<double> theta = problem.lower;
    for (Index p = 0; p < scaled.size(); ++p) {
        const int u = scaled.moving[static_cast<std::size_t>(p)];
        theta(u) = x(p) <= scaled.lower(p)   ? problem.lower(u)
                   : x(p) >= scaled.upper(p) ? problem.upper(u)
                                             : std::clamp(x(p) * scaled.scale(p), problem.lower(u), problem.upper(u));
    }
    return theta;
}

/// Puts on its bound what lies closer to it than its multiplier is large.
inline void snap(const ScaledProblem& scaled, const BoxProgram& program, Values<double>& x) {
    for (Index p = 0; p < x.size(); ++p) {
        if (x(p) - scaled.lower(p) < program.lower_multipliers(p)) {
            x(p) = scaled.lower(p);
        } else if (scaled.upper(p) - x(p) < program.upper_multipliers(p)) {
            x(p) = scaled.upper(p);
        }
    }
}

} // namespace detail

inline FitReport exact(const FitProblem& problem, const ExactOptions& options) {
    require(options.tolerance > 0 && options.tolerance < 1, "tolerance", "a value in (0, 1)", options.tolerance);
    require(options.max_iterations >= 0, "max_iterations", "a number not below 0", options.max_iterations);
    require(options.print_level >= 0 && options.print_level <= 12, "print_level", "a number from 0 to 12",
            options.print_level);
    require(options.initial.size() == 0 || options.initial.size() == problem.n_unknowns(), "initial",
            text(problem.n_unknowns(), " values, one per unknown"), options.initial.size());
    require(options.initial.allFinite(), "initial", "finite values", "a value that is not finite");
    const auto begin = std::chrono::steady_clock::now();
    FitReport report;
    report.theta = options.initial.size() > 0 ? options.initial.cwiseMax(problem.lower).cwiseMin(problem.upper).eval()
                                              : problem.prior;
    report.objective_start = problem.objective.value(report.theta);

    const auto application = detail::make_application(options);
    const detail::ScaledProblem scaled(problem);
    report.status = Status::converged;
    bool polished = true;
    Values<double> lower_multipliers = Values<double>::Zero(problem.n_unknowns());
    Values<double> upper_multipliers = lower_multipliers;
    if (scaled.size() > 0) {
        const Values<double> start = report.theta(scaled.moving).cwiseQuotient(scaled.scale);
        const Ipopt::SmartPtr<detail::BoxProgram> program =
            new detail::BoxProgram(scaled, start, options.progress, std::max(options.max_iterations, 1));
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
            detail::snap(scaled, *program, x);
            polished = detail::Polish(scaled).improve(x);
            const double unit = scaled.objective_unit;
            lower_multipliers(scaled.moving) = unit * program->lower_multipliers.cwiseQuotient(scaled.scale);
            upper_multipliers(scaled.moving) = unit * program->upper_multipliers.cwiseQuotient(scaled.scale);
        }
        report.theta = detail::unscaled(problem, scaled, x);
    }
    complete(problem, report);
    if (!polished) {
        report.lower_multipliers = lower_multipliers;
        report.upper_multipliers = upper_multipliers;
    }
    if (report.status == Status::converged || report.status == Status::stalled) {
        report.status = report.kkt_residual <= options.tolerance ? Status::converged : Status::stalled;
    }
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return report;
}

} // namespace springfit::ipopt
