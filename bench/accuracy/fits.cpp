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

[[maybe_unused]] Candidate<3> candidate_of(const std::string& name, const TrajectoryProblem<3>& problem,
                                           const SpringNetwork<3, double>& prior, const TrajectoryReport& report) {
    stop_if_interrupted();
    Candidate<3> candidate{.name = name, .network = prior};
    candidate.trajectory = report;
    candidate.seconds = report.seconds;
    if (usable(report.status)) {
        apply(problem, report, candidate.network);
    }
    return candidate;
}

} // namespace

ExactSolver exact_solver() {
#ifdef SPRINGFIT_STUDY_IPOPT
    return [](const AccelerationProblem& problem, const ExactOptions& options) {
        return ipopt::exact(problem, {.progress = options.progress});
    };
#else
    return {};
#endif
}

std::optional<Candidate<3>> ipopt_fit([[maybe_unused]] const TrajectoryProblem<3>& problem,
                                      [[maybe_unused]] const SpringNetwork<3, double>& prior,
                                      [[maybe_unused]] int max_iterations) {
#ifdef SPRINGFIT_STUDY_IPOPT
    ipopt::TrajectoryFitOptions options;
    options.max_iterations = max_iterations;
    options.progress = until_interrupted();
    return candidate_of("ipopt", problem, prior, ipopt::trajectory(problem, options));
#else
    return {};
#endif
}

std::optional<Candidate<3>> search_fit([[maybe_unused]] Search search,
                                       [[maybe_unused]] const TrajectoryProblem<3>& problem,
                                       [[maybe_unused]] const SpringNetwork<3, double>& prior,
                                       [[maybe_unused]] double seconds, [[maybe_unused]] unsigned seed) {
#ifdef SPRINGFIT_STUDY_SEARCH
    const auto run = [&](const char* name, auto options, const auto& engine) {
        options.seconds = seconds;
        options.seed = seed;
        options.progress = until_interrupted();
        return candidate_of(name, problem, prior, engine(options).fit);
    };
    if (search == Search::genetic) {
        search::GeneticOptions options;
        options.generations = 1000000; // as many as the time allows
        return run("genetic", options, [&](const auto& own) { return search::genetic(problem, own); });
    }
    return run("annealing", search::AnnealingOptions{},
               [&](const auto& own) { return search::annealing(problem, own); });
#else
    return {};
#endif
}

} // namespace study
