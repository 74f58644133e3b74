// SPDX-License-Identifier: BSD-3-Clause
#include "trial.hpp"

#include <springfit/fit/acceleration/dominant_term.hpp>
#include <springfit/fit/acceleration/objective.hpp>
#include <springfit/score/motion_error.hpp>

namespace study {

TrajectoryOptions trajectory_options(const FitSettings& fit, const Settings& settings) {
    TrajectoryOptions options;
    options.prior_weight = fit.prior_weight;
    options.parameters.damping_per_stiffness = fit.damping_per_stiffness;
    options.horizon = fit.horizon;
    options.steps_per_frame = fit.steps_per_frame;
    options.window_stride = fit.window_stride;
    options.execution = settings.execution;
    return options;
}

template <int Dim>
MotionFit<Dim> match_motion(const SpringNetwork<Dim, double>& prior, const std::vector<Motion<Dim, double>>& training,
                            const FitSettings& fit, const Settings& settings) {
    const Stopwatch watch;
    MotionFit<Dim> result{prior, {}, 0};
    const TrajectoryProblem<Dim> problem(prior, training, trajectory_options(fit, settings));
    GaussNewtonOptions options;
    options.max_iterations = fit.max_iterations;
    options.tolerance = fit.tolerance;
    options.progress = until_interrupted();
    result.report = gauss_newton(problem, options);
    stop_if_interrupted();
    if (usable(result.report.status)) {
        apply(problem, result.report, result.network);
    }
    result.seconds = watch.seconds();
    return result;
}

template <int Dim>
double error(const SpringNetwork<Dim, double>& network, const Cases<Dim>& cases, const Settings& settings) {
    if (cases.motions.empty()) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    MotionErrorOptions<double> options;
    options.max_iterations = 100;
    options.step.max_substeps = 100000;
    options.execution = settings.execution;
    const double result = motion_error(network, cases.scenarios, cases.motions, until_interrupted(), options).error;
    stop_if_interrupted();
    return result;
}

template <int Dim>
Errors errors(const SpringNetwork<Dim, double>& network, const CaseSets<Dim>& sets, const Settings& settings) {
    return {error(network, sets.loads, settings), error(network, sets.kinds, settings),
            error(network, sets.clamp, settings)};
}

template <int Dim>
Score trajectory_score(SpringNetwork<Dim, double>& network, const CaseSets<Dim>& sets, const FitSettings& fit,
                       const Settings& settings) {
    auto [fitted, report, seconds] = match_motion(network, sets.training.motions, fit, settings);
    Score score{"trajectory", false, {}, seconds, std::string(to_string(report.status))};
    if (usable(report.status)) {
        network = std::move(fitted);
        score.errors = errors(network, sets, settings);
    } else {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        score.errors = {infinity, infinity, infinity};
    }
    score.note += text(", misfit ", report.misfit_start, " to ", report.misfit, ", ", report.iterations,
                       " iterations, ", report.n_set_by_data(), " of ", report.theta.size(), " values set by data");
    return score;
}

template <int Dim>
std::vector<AccelerationFit<Dim>> acceleration_fits(const SpringNetwork<Dim, double>& prior,
                                                    const std::vector<Motion<Dim, double>>& training,
                                                    const Settings& settings, int max_sweeps) {
    const Stopwatch watch;
    const AccelerationProblem problem = acceleration_problem<Dim, double>(prior, training, {}, settings.execution);
    const double assembly = watch.seconds();
    std::vector<AccelerationFit<Dim>> fits;
    const auto add = [&](const char* name, const auto& solve) {
        const Stopwatch solving;
        const std::optional<AccelerationReport> fit = solve();
        stop_if_interrupted();
        if (fit) {
            fits.push_back({name, prior, fit->objective, assembly + solving.seconds()});
            apply(problem, *fit, fits.back().network);
        }
    };
    add("one pass", [&] { return one_pass(problem, {.execution = settings.execution}); });
    add("dominant term", [&] {
        return dominant_term(problem, {.max_sweeps = max_sweeps,
                                       .tolerance = 1e-12,
                                       .execution = settings.execution,
                                       .progress = until_interrupted()});
    });
    add("exact", [&] { return exact_fit(problem); });
    return fits;
}

template <int Dim>
void add_fits(Row& row, SpringNetwork<Dim, double>& network, const CaseSets<Dim>& sets, const Methods& methods,
              const Settings& settings) {
    row.nodes = static_cast<long>(network.n_nodes());
    row.springs = static_cast<long>(network.n_springs());
    if (methods.acceleration) {
        for (const auto& fit : acceleration_fits(network, sets.training.motions, settings)) {
            row.scores.push_back(
                {fit.method, false, errors(fit.network, sets, settings), fit.seconds, text("Phi ", fit.objective)});
        }
    }
    row.scores.push_back(trajectory_score(network, sets, methods.fit, settings));
}

// Compiled here once for all parts.
template MotionFit<2> match_motion(const SpringNetwork<2, double>&, const std::vector<Motion<2, double>>&,
                                   const FitSettings&, const Settings&);
template MotionFit<3> match_motion(const SpringNetwork<3, double>&, const std::vector<Motion<3, double>>&,
                                   const FitSettings&, const Settings&);
template double error(const SpringNetwork<2, double>&, const Cases<2>&, const Settings&);
template double error(const SpringNetwork<3, double>&, const Cases<3>&, const Settings&);
template Errors errors(const SpringNetwork<2, double>&, const CaseSets<2>&, const Settings&);
template Errors errors(const SpringNetwork<3, double>&, const CaseSets<3>&, const Settings&);
template Score trajectory_score(SpringNetwork<2, double>&, const CaseSets<2>&, const FitSettings&, const Settings&);
template Score trajectory_score(SpringNetwork<3, double>&, const CaseSets<3>&, const FitSettings&, const Settings&);
template std::vector<AccelerationFit<2>> acceleration_fits(const SpringNetwork<2, double>&,
                                                           const std::vector<Motion<2, double>>&, const Settings&, int);
template std::vector<AccelerationFit<3>> acceleration_fits(const SpringNetwork<3, double>&,
                                                           const std::vector<Motion<3, double>>&, const Settings&, int);
template void add_fits(Row&, SpringNetwork<2, double>&, const CaseSets<2>&, const Methods&, const Settings&);
template void add_fits(Row&, SpringNetwork<3, double>&, const CaseSets<3>&, const Methods&, const Settings&);

} // namespace study
