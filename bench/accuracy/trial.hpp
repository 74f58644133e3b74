// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cases/load_cases.hpp>
#include <springfit/cases/strain.hpp>
#include <springfit/closed_form/all.hpp>
#include <springfit/core/stopwatch.hpp>
#include <springfit/fit/trajectory/gauss_newton.hpp>
#include <springfit/motion/record_static.hpp>

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

    void add(Scenario<Dim, double> scenario, Motion<Dim, double> motion) {
        scenarios.push_back(std::move(scenario));
        motions.push_back(std::move(motion));
    }
};

/// What is trained on and the three sets that judge.
template <int Dim>
struct CaseSets {
    Cases<Dim> training, loads, kinds, clamp;

    [[nodiscard]] int left_out() const { return training.left_out + loads.left_out + kinds.left_out + clamp.left_out; }
};

inline constexpr double small_strain = 1e-4; ///< geometry hardly changes

/// How many cases, and how large.
struct CaseSettings {
    int training = 120;
    int clamps = 3;
    int loads = 9;
    int kinds = 10;
    int clamp = 9;
    double strain = small_strain; ///< of the linear response, 95th percentile over the edges
};

[[nodiscard]] inline std::string strain_text(double strain) {
    return strain <= small_strain ? "small strain" : text("strain ", strain);
}

/// Scales scenarios to a strain and records their equilibria.
template <class Reference>
[[nodiscard]] Cases<Reference::dimension>
record_equilibria(const Reference& reference, const NodePairs& pairs,
                  std::vector<Scenario<Reference::dimension, double>> scenarios, double strain,
                  const Execution& execution) {
    constexpr int dim = Reference::dimension;
    const StaticRecordOptions<double> options{.execution = execution, .progress = until_interrupted()};
    (void)scale_to_strain<dim, double>(scenarios, pairs, make_static_solver(reference).rest_positions(), strain,
                                       [&](const auto& all) { return linear_responses(reference, all, options); });
    auto recordings = record_statics(reference, scenarios, options);
    stop_if_interrupted();
    Cases<dim> result;
    for (std::size_t c = 0; c < scenarios.size(); ++c) {
        if (recordings[c].status == Status::converged) {
            result.add(std::move(scenarios[c]), std::move(recordings[c].motion));
        } else {
            ++result.left_out;
        }
    }
    return result;
}

/// The four sets of a body. Held-out cases depend on the seed alone, not on how many are trained on.
template <class Reference>
[[nodiscard]] CaseSets<Reference::dimension> record_sets(const Reference& reference, const NodePairs& pairs,
                                                         const Specimen<Reference::dimension, double>& body,
                                                         const CaseSettings& cases, const Settings& settings) {
    const auto held_out = random_load_cases(body, {.training = cases.clamps,
                                                   .clamps = cases.clamps,
                                                   .held_out_loads = cases.loads,
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
        return record_equilibria(reference, pairs, scenarios, cases.strain, settings.execution);
    };
    return {record(scenarios_with(training, CaseRole::training)),
            record(scenarios_with(held_out, CaseRole::unseen_load)),
            record(scenarios_with(held_out, CaseRole::unseen_kind)),
            record(scenarios_with(held_out, CaseRole::unseen_clamp))};
}

struct FitSettings {
    double prior_weight = 1e-5;
    int max_iterations = 20;
    double tolerance = 2e-3;
    int horizon = 0;                  ///< frames that a window of a motion predicts; 0: all
    int window_stride = 0;            ///< frames from one window to the next; 0: the horizon
    int steps_per_frame = 1;          ///< of the integrator
    double damping_per_stiffness = 0; ///< s; above 0, damping follows stiffness
};

/// A network that matching of motion found, and how.
template <int Dim>
struct MotionFit {
    SpringNetwork<Dim, double> network;
    TrajectoryReport report;
    double seconds = 0; ///< with the set-up of the problem
};

// Defined in trial.cpp for both dimensions.

[[nodiscard]] TrajectoryOptions trajectory_options(const FitSettings& fit, const Settings& settings);

/// Matches the motion of a network, whose own values are the prior, to that of the training cases.
template <int Dim>
[[nodiscard]] MotionFit<Dim> match_motion(const SpringNetwork<Dim, double>& prior,
                                          const std::vector<Motion<Dim, double>>& training, const FitSettings& fit,
                                          const Settings& settings);

/// Error on a set of cases; NaN for none.
template <int Dim>
[[nodiscard]] double error(const SpringNetwork<Dim, double>& network, const Cases<Dim>& cases,
                           const Settings& settings);

/// Errors on the three held-out sets.
template <int Dim>
[[nodiscard]] Errors errors(const SpringNetwork<Dim, double>& network, const CaseSets<Dim>& sets,
                            const Settings& settings);

/// What came of matching motion, scored; `network` is the fitted one afterwards.
template <int Dim>
[[nodiscard]] Score trajectory_score(SpringNetwork<Dim, double>& network, const CaseSets<Dim>& sets,
                                     const FitSettings& fit, const Settings& settings);

/// A network whose springs an acceleration fit found.
template <int Dim>
struct AccelerationFit {
    std::string method;
    SpringNetwork<Dim, double> network;
    double objective = 0;
    double seconds = 0;
};

/// The three acceleration fits of the stiffness, `exact` only where it is built in.
template <int Dim>
[[nodiscard]] std::vector<AccelerationFit<Dim>> acceleration_fits(const SpringNetwork<Dim, double>& prior,
                                                                  const std::vector<Motion<Dim, double>>& training,
                                                                  const Settings& settings, int max_sweeps = 50);

/// What to run on a row.
struct Methods {
    bool acceleration = false;
    FitSettings fit{};
};

/// Adds the fits that start from the values of a network; it is the fitted one afterwards.
template <int Dim>
void add_fits(Row& row, SpringNetwork<Dim, double>& network, const CaseSets<Dim>& sets, const Methods& methods,
              const Settings& settings);

/// Scores every closed form of the springs of a network, which gets the values of the first of them, the prior of fits.
template <int Dim, CellType Cell>
[[nodiscard]] std::vector<Score> closed_form_scores(const Mesh<Dim, double, Cell>& mesh, const IsotropicSolid& solid,
                                                    SpringNetwork<Dim, double>& network, const CaseSets<Dim>& sets,
                                                    const Settings& settings) {
    std::vector<Score> scores;
    const auto forms = closed_forms(mesh, network.springs, solid);
    for (const auto& [name, form] : forms) {
        auto closed = network;
        apply(form, closed);
        scores.push_back({name, true, errors(closed, sets, settings), 0, form.caveat});
    }
    apply(forms.front().form, network);
    return scores;
}

/// Scores closed forms and fits of the springs of a network.
template <int Dim, CellType Cell>
void add_scores(Row& row, const Mesh<Dim, double, Cell>& mesh, const IsotropicSolid& solid,
                SpringNetwork<Dim, double> network, const CaseSets<Dim>& sets, const Methods& methods,
                const Settings& settings) {
    row.scores = closed_form_scores(mesh, solid, network, sets, settings);
    add_fits(row, network, sets, methods, settings);
}

} // namespace study
