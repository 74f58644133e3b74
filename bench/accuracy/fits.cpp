// SPDX-License-Identifier: BSD-3-Clause
#include "fits.hpp"

#ifdef SPRINGFIT_STUDY_IPOPT
#include <springfit/ipopt/exact.hpp>
#include <springfit/ipopt/trajectory.hpp>
#endif
#ifdef SPRINGFIT_STUDY_SEARCH
#include <springfit/search/annealing.hpp>
#include <springfit/search/genetic.hpp>
#endif

namespace study {

namespace {

[[maybe_unused]] TimedFit timed(const TrajectoryProblem<3>& problem, const SpringNetwork<3, double>& prior,
                                const TrajectoryReport& report) {
    stop_if_interrupted();
    TimedFit fit{report.seconds, report.objective, prior};
    if (usable(report.status)) {
        apply(problem, report, fit.network);
    }
    return fit;
}

} // namespace

std::optional<AccelerationReport> exact_fit([[maybe_unused]] const AccelerationProblem& problem) {
#ifdef SPRINGFIT_STUDY_IPOPT
    return ipopt::exact(problem);
#else
    return {};
#endif
}

std::optional<TimedFit> ipopt_fit([[maybe_unused]] const SpringNetwork<3, double>& prior,
                                  [[maybe_unused]] const std::vector<Motion<3, double>>& training,
                                  [[maybe_unused]] int max_iterations, [[maybe_unused]] const FitSettings& fit,
                                  [[maybe_unused]] const Settings& settings) {
#ifdef SPRINGFIT_STUDY_IPOPT
    const TrajectoryProblem<3> problem(prior, training, trajectory_options(fit, settings));
    ipopt::TrajectoryFitOptions options;
    options.max_iterations = max_iterations;
    options.progress = until_interrupted();
    return timed(problem, prior, ipopt::trajectory(problem, options));
#else
    return {};
#endif
}

std::optional<TimedFit> search_fit([[maybe_unused]] Search search,
                                   [[maybe_unused]] const SpringNetwork<3, double>& prior,
                                   [[maybe_unused]] const std::vector<Motion<3, double>>& training,
                                   [[maybe_unused]] double seconds, [[maybe_unused]] const FitSettings& fit,
                                   [[maybe_unused]] const Settings& settings) {
#ifdef SPRINGFIT_STUDY_SEARCH
    const TrajectoryProblem<3> problem(prior, training, trajectory_options(fit, settings));
    const auto run = [&](auto options, const auto& engine) {
        options.seconds = seconds;
        options.seed = settings.seed;
        options.progress = until_interrupted();
        return timed(problem, prior, engine(options).fit);
    };
    if (search == Search::genetic) {
        search::GeneticOptions options;
        options.generations = 1000000; // as many as the time allows
        return run(options, [&](const auto& own) { return search::genetic(problem, own); });
    }
    return run(search::AnnealingOptions{}, [&](const auto& own) { return search::annealing(problem, own); });
#else
    return {};
#endif
}

} // namespace study
