// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>

#include <pagmo/algorithms/sga.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include <springfit/search/detail/record.hpp>

namespace springfit::search {

struct GeneticOptions {
    int population = 20;          ///< individuals, even and >= 4
    int generations = 200;        ///< >= 0
    double spread = 0.5;          ///< standard deviation of the first population about the start, > 0
    double crossover = 0.9;       ///< probability that two parents are mixed, in [0, 1]
    double mutations = 2;         ///< entries of theta that change in each child, on average; > 0
    double mutation_width = 0.03; ///< standard deviation of such a change as part of the box, in (0, 1]
    SearchBox box{};
    double seconds = std::numeric_limits<double>::infinity(); ///< budget, > 0; looked at before every simulation
    unsigned seed = 1;
    ProgressCallback progress{}; ///< called before every simulation; may end the search with the best so far
};

/// Baseline: a genetic algorithm on the error of the model's own motion, the idea of [Bianchi2004] for the stiffness of
/// springs; here on logarithms of the values, with pagmo's `sga` (real numbers, tournaments of two, simulated binary
/// crossover, normal mutation, the best of parents and children survive). Operators and settings are ours.
///
/// The first population is the prior, the start of `gauss_newton` and normally distributed ones about that. `history`
/// has the best J of each generation, the first one included. Ends with `iteration_limit` after the last generation or
/// when the seconds are over, with `failed` where there is no start. The same seed gives the same result, but for a
/// budget in seconds. Throws InvalidArgument for an option out of range. Cost: population (generations + 1) simulations
/// of all cases.
template <int Dim>
[[nodiscard]] SearchReport genetic(const TrajectoryProblem<Dim>& problem, const GeneticOptions& options = {}) {
    require(options.population >= 4 && options.population % 2 == 0, "population", "an even number, 4 or more",
            options.population);
    require(options.generations >= 0, "generations", "a number not below 0", options.generations);
    require(options.spread > 0 && std::isfinite(options.spread), "spread", "a positive value", options.spread);
    require(options.crossover >= 0 && options.crossover <= 1, "crossover", "a probability", options.crossover);
    require(options.mutations > 0, "mutations", "a positive number", options.mutations);
    require(options.mutation_width > 0 && options.mutation_width <= 1, "mutation_width", "a part in (0, 1]",
            options.mutation_width);
    require(options.seconds > 0, "seconds", "a positive time", options.seconds);

    detail::SearchRecord<Dim> record(
        TrajectoryMatch<Dim>(detail::borrowed(problem), options.box),
        {static_cast<double>(options.population) * (options.generations + 1.), options.population, options.seconds},
        options.progress, "genetic");
    if (!record.has_start()) {
        return record.finish();
    }
    const auto& match = record.match();
    const Values<double>& start = record.start();
    const double rate = std::min(1., options.mutations / static_cast<double>(start.size()));
    const pagmo::sga generation(1, options.crossover, 10., rate, options.mutation_width, 2, "sbx", "gaussian",
                                "tournament", options.seed);
    std::mt19937 engine(options.seed);
    std::normal_distribution<double> normal(0., options.spread);
    try {
        pagmo::population population{pagmo::problem(detail::RecordedMatch<Dim>(record)), 0, options.seed};
        for (int i = 0; i < options.population; ++i) {
            Values<double> theta = i == 0 ? match.prior() : start;
            if (i > 1) {
                for (double& value : theta) {
                    value += normal(engine);
                }
            }
            theta = theta.cwiseMax(match.lower()).cwiseMin(match.upper());
            population.push_back({theta.begin(), theta.end()});
        }
        for (int g = 0; g < options.generations; ++g) {
            population = generation.evolve(population);
        }
    } catch (const detail::SearchEnd&) { // the record says why
    }
    return record.finish();
}

} // namespace springfit::search
