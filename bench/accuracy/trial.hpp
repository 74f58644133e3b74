// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

#include <springfit/closed_form/all.hpp>
#include <springfit/closed_form/cauchy_split.hpp>
#include <springfit/fit/acceleration_objective.hpp>
#include <springfit/fit/dominant_term.hpp>
#include <springfit/fit/trajectory.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/motion/load_cases.hpp>
#include <springfit/motion/record_static.hpp>
#include <springfit/motion/strain.hpp>
#include <springfit/network/topology.hpp>
#include <springfit/score/motion_error.hpp>
#include <springfit/step/static_solver.hpp>

#include "study.hpp"

/// One trial: load cases recorded, methods run and scored.
namespace study {

using namespace springfit;

/// Load cases with what the reference did; cases without an equilibrium are left out.
template <int Dim>
struct Cases {
    std::vector<Scenario<Dim, double>> scenarios;
    std::vector<Motion<Dim, double>> motions;
    int left_out = 0;
};

template <int Dim>
struct CaseSets {
    Cases<Dim> training, loads, kinds, clamp;
    double strain = 0; ///< of the linear response, 95th percentile over the edges
};

/// How many cases, and how large.
struct CaseSettings {
    int training = 120;
    int clamps = 3;
    int kinds = 10;
    int clamp = 9;
    double strain = 1e-4; ///< small: geometry hardly changes
};

/// Scales scenarios to a strain and records them.
template <class Reference>
[[nodiscard]] Cases<Reference::dimension>
recorded(const Reference& reference, const NodePairs& pairs, std::vector<Scenario<Reference::dimension, double>> cases,
         double strain, const Execution& execution) {
    constexpr int dim = Reference::dimension;
    const StaticRecordOptions<double> options{.execution = execution};
    (void)scale_to_strain<dim, double>(cases, pairs, make_static_solver(reference).rest_positions(), strain,
                                       [&](const auto& all) { return linear_responses(reference, all, options); });
    auto recordings = record_statics(reference, cases, options);
    Cases<dim> result;
    for (std::size_t c = 0; c < cases.size(); ++c) {
        if (recordings[c].status == Status::converged) {
            result.scenarios.push_back(std::move(cases[c]));
            result.motions.push_back(std::move(recordings[c].motion));
        } else {
            ++result.left_out;
        }
    }
    return result;
}

/// The four sets of a body. Held-out cases depend on the seed alone, not on how many are trained on.
template <class Reference>
[[nodiscard]] CaseSets<Reference::dimension>
record_sets(const Reference& reference, const NodePairs& pairs, const Body<Reference::dimension, double>& body,
            const CaseSettings& cases, const Settings& settings) {
    const auto held_out = random_load_cases(body, {.training = cases.clamps,
                                                   .clamps = cases.clamps,
                                                   .held_out_loads = 9,
                                                   .held_out_kinds = cases.kinds,
                                                   .held_out_clamp = cases.clamp,
                                                   .seed = 1000 + settings.seed});
    const auto training = random_load_cases(body, {.training = cases.training,
                                                   .clamps = cases.clamps,
                                                   .held_out_loads = 0,
                                                   .held_out_kinds = 0,
                                                   .held_out_clamp = cases.clamp > 0 ? 1 : 0,
                                                   .seed = settings.seed});
    const auto record = [&](const auto& scenarios) {
        return recorded(reference, pairs, scenarios, cases.strain, settings.execution);
    };
    return {record(training.training), record(held_out.held_out_loads), record(held_out.held_out_kinds),
            record(held_out.held_out_clamp), cases.strain};
}

/// The cases that are clamped like case `like`.
template <int Dim>
[[nodiscard]] Cases<Dim> under_clamps(const Cases<Dim>& cases, const std::vector<std::vector<int>>& clamps) {
    Cases<Dim> result;
    for (std::size_t c = 0; c < cases.motions.size(); ++c) {
        if (std::find(clamps.begin(), clamps.end(), cases.motions[c].clamped) != clamps.end()) {
            result.scenarios.push_back(cases.scenarios[c]);
            result.motions.push_back(cases.motions[c]);
        }
    }
    return result;
}

template <int Dim>
[[nodiscard]] double error(const SpringNetwork<Dim, double>& network, const Cases<Dim>& cases,
                           const Settings& settings) {
    if (cases.motions.empty()) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    MotionErrorOptions<double> options;
    options.max_iterations = 100;
    options.execution = settings.execution;
    return motion_error(network, cases.scenarios, cases.motions, {}, options).error;
}

template <int Dim>
[[nodiscard]] Errors errors(const SpringNetwork<Dim, double>& network, const CaseSets<Dim>& sets,
                            const Settings& settings) {
    return {error(network, sets.loads, settings), error(network, sets.kinds, settings),
            error(network, sets.clamp, settings)};
}

struct FitSettings {
    double prior_weight = 1e-4;
    double least_prior = 0.02;
    int max_iterations = 15;
    double tolerance = 5e-3;
    int horizon = 0;
    double damping_per_stiffness = 0;
};

[[nodiscard]] inline double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <int Dim>
[[nodiscard]] TrajectoryOptions trajectory_options(const FitSettings& fit, const Settings& settings) {
    TrajectoryOptions options;
    options.prior_weight = fit.prior_weight;
    options.parameters.least_prior = fit.least_prior;
    options.parameters.damping_per_stiffness = fit.damping_per_stiffness;
    options.horizon = fit.horizon;
    options.execution = settings.execution;
    return options;
}

/// Fits a network, whose own values are the prior, and scores it.
template <int Dim>
[[nodiscard]] Score trajectory_score(SpringNetwork<Dim, double>& network,
                                     const std::vector<Motion<Dim, double>>& training, const CaseSets<Dim>& sets,
                                     const FitSettings& fit, const Settings& settings) {
    const auto start = std::chrono::steady_clock::now();
    const TrajectoryProblem<Dim> problem(network, training, trajectory_options<Dim>(fit, settings));
    GaussNewtonOptions options;
    options.max_iterations = fit.max_iterations;
    options.tolerance = fit.tolerance;
    options.progress = [](const Progress&) { return !interrupted(); };
    const TrajectoryReport report = gauss_newton(problem, options);
    Score score{"trajectory", false, {}, seconds_since(start), std::string(to_string(report.status))};
    if (usable(report.status)) {
        apply(problem, report, network);
        score.errors = errors(network, sets, settings);
    } else {
        score.errors = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                        std::numeric_limits<double>::infinity()};
    }
    score.note += text(", misfit ", report.misfit_start, " to ", report.misfit, ", ", report.iterations, " iterations, ",
                       report.n_set_by_data(), " of ", report.theta.size(), " values set by data");
    return score;
}

/// The three acceleration fits of the stiffness.
template <int Dim>
void add_acceleration_scores(Row& row, const SpringNetwork<Dim, double>& prior, const CaseSets<Dim>& sets,
                             const Settings& settings) {
    const auto start = std::chrono::steady_clock::now();
    const FitProblem problem = acceleration_problem(prior, sets.training.motions, {}, settings.execution);
    const double assembly = seconds_since(start);
    const auto add = [&](const char* name, const FitReport& fit, double seconds) {
        auto network = prior;
        apply(problem, fit, network);
        row.scores.push_back({name, false, errors(network, sets, settings), assembly + seconds,
                              text("Phi ", fit.objective)});
    };
    const auto timed = [&](const char* name, const auto& solve) {
        const auto begin = std::chrono::steady_clock::now();
        const FitReport fit = solve();
        add(name, fit, seconds_since(begin));
    };
    timed("one pass", [&] { return one_pass(problem, {.execution = settings.execution}); });
    timed("dominant term", [&] { return dominant_term(problem, {.execution = settings.execution}); });
    const auto begin = std::chrono::steady_clock::now();
    if (const auto fit = exact_fit(problem)) {
        add("exact", *fit, seconds_since(begin));
    }
}

/// Volume stiffness above this many shear moduli would make the cells lock: every cell on its own holds its volume, and
/// there are several cells per node.
inline constexpr double most_volume_stiffness = 6;

/// Gives a network with cells the values of `cauchy_split`, kept below that.
template <int Dim, CellType Cell>
void apply_cauchy_split(const Mesh<Dim, double, Cell>& mesh, const IsotropicSolid& solid,
                        SpringNetwork<Dim, double>& network) {
    auto split = cauchy_split(mesh, network.springs, solid, {.signed_volume = true});
    const double mu = solid.young / (2 * (1 + solid.poisson));
    split.volume_stiffness = split.volume_stiffness.cwiseMin(most_volume_stiffness * mu);
    apply(split, network);
}

/// What to run on a row.
struct Methods {
    bool acceleration = false;
    FitSettings fit{};
};

/// Scores the closed forms, and the fits that start from the first of them, on one network of a mesh.
///
/// `edge_forms` are the scores of closed forms on the edges alone; a network with more springs or with cells is
/// compared with those too. The fitted network is left in `network`.
template <int Dim, CellType Cell>
void run(Row& row, const Mesh<Dim, double, Cell>& mesh, const IsotropicSolid& solid,
         SpringNetwork<Dim, double>& network, const CaseSets<Dim>& sets, const Methods& methods,
         const Settings& settings, const std::vector<Score>& edge_forms = {}) {
    row.nodes = static_cast<long>(network.n_nodes());
    row.springs = static_cast<long>(network.n_springs());
    if (edge_forms.empty()) {
        bool is_first = true;
        for (const auto& [name, form] : closed_forms(mesh, network.springs, solid)) {
            auto closed = network;
            apply(form, closed);
            if (is_first) {
                network = closed;
                is_first = false;
            }
            row.scores.push_back({name, true, errors(closed, sets, settings), 0, form.caveat});
        }
    } else {
        row.scores = edge_forms;
        if (network.n_cells() == 0) {
            if constexpr (SimplexCell<Cell>) {
                apply(van_gelder(mesh, network.springs, solid), network);
            }
        }
    }
    if (network.n_cells() > 0) {
        if constexpr (SimplexCell<Cell> && Cell::dimension == Dim) {
            apply_cauchy_split(mesh, solid, network);
            row.scores.push_back({"cauchy_split", true, errors(network, sets, settings), 0, {}});
        }
    }
    if (methods.acceleration) {
        add_acceleration_scores(row, network, sets, settings);
    }
    row.scores.push_back(trajectory_score(network, sets.training.motions, sets, methods.fit, settings));
}

/// The closed forms among the scores of a row.
[[nodiscard]] inline std::vector<Score> closed_form_scores(const Row& row) {
    std::vector<Score> result;
    for (const Score& score : row.scores) {
        if (score.is_closed_form && score.method != "cauchy_split") {
            result.push_back(score);
        }
    }
    return result;
}

} // namespace study
