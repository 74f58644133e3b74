// SPDX-License-Identifier: BSD-3-Clause
#include "study.hpp"

#ifdef SPRINGFIT_STUDY_IPOPT
#include <springfit/ipopt/exact.hpp>
#endif
#ifdef SPRINGFIT_STUDY_SEARCH
#include <springfit/search/annealing.hpp>
#include <springfit/search/genetic.hpp>
#endif

namespace study {

using namespace springfit;

std::optional<FitReport> exact_fit([[maybe_unused]] const FitProblem& problem) {
#ifdef SPRINGFIT_STUDY_IPOPT
    return ipopt::exact(problem);
#else
    return {};
#endif
}

std::vector<SearchResult> searches([[maybe_unused]] const TrajectoryProblem<3>& problem,
                                   [[maybe_unused]] double seconds, [[maybe_unused]] unsigned seed) {
    std::vector<SearchResult> results;
#ifdef SPRINGFIT_STUDY_SEARCH
    const ProgressCallback progress = [](const Progress&) { return !interrupted(); };
    search::GeneticOptions genetic;
    genetic.generations = 1000000; // as many as the time allows
    genetic.seconds = seconds;
    genetic.seed = seed;
    genetic.progress = progress;
    auto found = search::genetic(problem, genetic);
    results.push_back({"genetic", found.fit.seconds, found.fit.theta});
    search::AnnealingOptions annealing;
    annealing.seconds = seconds;
    annealing.seed = seed;
    annealing.progress = progress;
    found = search::annealing(problem, annealing);
    results.push_back({"annealing", found.fit.seconds, found.fit.theta});
#endif
    return results;
}

} // namespace study
