// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pagmo/algorithms/simulated_annealing.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include <springfit/search/detail/record.hpp>

namespace springfit::search {

struct AnnealingOptions {
    double start_temperature = 1e-2; ///< as part of J at the start, > end_temperature
    double end_temperature = 1e-5;   ///< likewise, > 0
    int temperatures = 40;           ///< steps of the schedule, >= 1
    int rounds = 1;                  ///< adjustments of the step lengths at each temperature, >= 1
    int trials = 5;                  ///< changes of each unknown between two adjustments, >= 1
    double start_range = 0.2;        ///< first step length as part of the box, in (0, 1]
    SearchBox box{};
    double seconds = std::numeric_limits<double>::infinity(); ///< budget, > 0; looked at before every simulation
    unsigned seed = 1;
    ProgressCallback progress{}; ///< called before every simulation; may end the search with the best so far
};

/// Baseline: simulated annealing of the error of the model's own motion, the idea of [Deussen1995] for the values of
/// springs; here on their logarithms, with pagmo's `simulated_annealing` (one unknown at a time, steps that adapt to
/// half of them being accepted). Schedule and settings are ours.
///
/// Starts where `gauss_newton` does. `history` has the best J after each temperature. Ends with `iteration_limit` after
/// the last temperature or when the seconds are over, with `failed` where there is no start. The same seed gives the
/// same result, but for a budget in seconds. Throws InvalidArgument for an option out of range. Cost: temperatures
/// rounds trials n_unknowns simulations of all cases.
template <int Dim>
[[nodiscard]] SearchReport annealing(const TrajectoryProblem<Dim>& problem, const AnnealingOptions& options = {}) {
    require(options.end_temperature > 0, "end_temperature", "a positive value", options.end_temperature);
    require(options.start_temperature > options.end_temperature && std::isfinite(options.start_temperature),
            "start_temperature", "a finite value above the end temperature", options.start_temperature);
    require(options.temperatures >= 1, "temperatures", "at least one", options.temperatures);
    require(options.rounds >= 1, "rounds", "at least one", options.rounds);
    require(options.trials >= 1, "trials", "at least one", options.trials);
    require(options.start_range > 0 && options.start_range <= 1, "start_range", "a part in (0, 1]",
            options.start_range);
    require(options.seconds > 0, "seconds", "a positive time", options.seconds);

    const Index per_temperature = Index(options.rounds) * options.trials * problem.n_unknowns();
    detail::SearchRecord<Dim> record(
        TrajectoryMatch<Dim>(detail::borrowed(problem), options.box),
        {static_cast<double>(per_temperature) * options.temperatures, per_temperature, options.seconds},
        options.progress, "annealing");
    if (!record.has_start()) {
        return record.finish();
    }
    const Values<double>& start = record.start();
    try {
        pagmo::population population{pagmo::problem(detail::RecordedMatch<Dim>(record)), 0, options.seed};
        population.push_back({start.begin(), start.end()}, {record.start_value()});
        const double unit = record.start_value() > 0 ? record.start_value() : 1.;
        (void)pagmo::simulated_annealing(unit * options.start_temperature, unit * options.end_temperature,
                                         static_cast<unsigned>(options.temperatures),
                                         static_cast<unsigned>(options.rounds), static_cast<unsigned>(options.trials),
                                         options.start_range, options.seed)
            .evolve(population);
    } catch (const detail::SearchEnd&) { // the record says why
    }
    return record.finish();
}

} // namespace springfit::search
