// SPDX-License-Identifier: BSD-3-Clause
#include "candidates.hpp"

#include <algorithm>
#include <tuple>

#include <springfit/cases/load_kinds.hpp>
#include <springfit/fit/acceleration_objective.hpp>
#include <springfit/fit/dominant_term.hpp>
#include <springfit/fit/exact.hpp>
#include <springfit/network/damping.hpp>
#include <springfit/network/forces.hpp>
#include <springfit/score/motion_error.hpp>

#include "interrupt.hpp"
#include "terminal.hpp"

namespace program {

using namespace springfit;

namespace {

/// The damping rule that `--damping` names, for the stiffness that the network has.
template <int Dim>
void set_damping(SpringNetwork<Dim, double>& network, double beta, const FitOptions& options) {
    network.damping = options.damping == "ratio" ? mass_stiffness_damping(network, options.zeta.value_or(0.05))
                                                 : stiffness_proportional_damping(network, beta);
}

/// Elastic energy that motions put into the network, summed over all their frames, J; a preload at rest does not count.
template <int Dim>
double energy_in(const SpringNetwork<Dim, double>& network, const std::vector<Motion<Dim, double>>& motions) {
    const double at_rest = elastic_energy(network, network.rest_positions);
    double energy = 0;
    for (const auto& motion : motions) {
        for (const auto& positions : motion.positions) {
            energy += elastic_energy(network, positions) - at_rest;
        }
    }
    return energy;
}

/// How a network is scored: one that needs more iterations to come to rest, or fails a case, is of no use.
MotionErrorOptions<double> scoring(const Execution& execution) {
    return {.step = {}, .max_iterations = 60, .stop_at_failure = true, .execution = execution};
}

/// The closed form's network that is nearest to the half of the training equilibria that move least, where hardly any
/// buckles; the first where there are none.
template <int Dim>
SpringNetwork<Dim, double> best_closed_form(const std::vector<Candidate<Dim>>& candidates,
                                            const ReferenceCases<Dim>& cases, const Execution& execution) {
    std::vector<std::pair<double, std::size_t>> by_size;
    for (std::size_t c = 0; c < cases.training.motions.size(); ++c) {
        const auto& motion = cases.training.motions[c];
        if (motion.n_frames() == 1) {
            by_size.emplace_back((motion.positions.front() - motion.rest_positions).norm(), c);
        }
    }
    std::sort(by_size.begin(), by_size.end());
    by_size.resize((by_size.size() + 1) / 2);
    CaseSet<Dim> statics;
    for (const auto& [size, c] : by_size) {
        statics.scenarios.push_back(cases.training.scenarios[c]);
        statics.motions.push_back(cases.training.motions[c]);
    }
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < candidates.size() && !statics.motions.empty(); ++c) {
        const double error =
            motion_error(candidates[c].network, statics.scenarios, statics.motions, {}, scoring(execution)).error;
        if (error < least) {
            least = error;
            best = c;
        }
    }
    return candidates[best].network;
}

} // namespace

template <int Dim>
std::vector<Candidate<Dim>> make_candidates(const Discretisation<Dim>& body, const ReferenceCases<Dim>& cases,
                                            const FitOptions& options, const Execution& execution) {
    std::vector<Candidate<Dim>> candidates;
    for (const auto& closed : body.closed_forms) {
        Candidate<Dim> candidate;
        candidate.name = closed.name;
        candidate.network = body.network;
        apply(closed.form, candidate.network);
        candidate.n_clamped = closed.form.n_clamped;
        candidate.caveat = closed.form.caveat;
        set_damping<Dim>(candidate.network, cases.stiffness_damping, options);
        candidates.push_back(std::move(candidate));
    }
    if (body.cauchy_split) {
        Candidate<Dim> candidate;
        candidate.name = "cauchy_split";
        candidate.network = body.network;
        apply(*body.cauchy_split, candidate.network);
        candidate.caveat = body.cauchy_split->springs.caveat;
        set_damping<Dim>(candidate.network, cases.stiffness_damping, options);
        candidates.push_back(std::move(candidate));
    }
    if ((options.method == "auto" || options.method == "trajectory") && !interrupted()) {
        if (auto matched =
                match_motion<Dim>(best_closed_form<Dim>(candidates, cases, execution), cases, options, execution)) {
            candidates.push_back(std::move(*matched));
        }
    }
    if (options.method != "closed-form" && options.method != "trajectory" && !interrupted()) {
        // The closed form is the prior: what a spring gets that no motion excites.
        const SpringNetwork<Dim, double> prior = candidates.front().network;
        AccelerationOptions<double> how;
        how.parameters.damping.fit = options.damping == "fitted";
        if (options.damping == "proportional") {
            how.parameters.damping_per_stiffness = cases.stiffness_damping;
        }
        const FitProblem problem = [&] {
            Stage stage("assemble objective");
            AccelerationObjective<Dim, double> objective(prior, how, execution);
            for (const auto& motion : cases.training.motions) {
                if (motion.n_frames() > 1) {
                    objective.add(motion);
                }
            }
            return std::move(objective).problem();
        }();
        const auto add = [&](const std::string& name, const auto& solve) {
            Stage stage("fit " + name);
            Candidate<Dim> candidate;
            candidate.name = name;
            candidate.network = prior;
            candidate.fit = solve(stage.callback());
            if (!usable(candidate.fit->status)) {
                return;
            }
            apply(problem, *candidate.fit, candidate.network);
            if (options.damping == "ratio") {
                set_damping<Dim>(candidate.network, cases.stiffness_damping, options);
            }
            candidate.seconds = stage.seconds();
            candidates.push_back(std::move(candidate));
        };
        if (options.method == "auto" || options.method == "dominant-term") {
            add("dominant_term", [&](const ProgressCallback& progress) {
                DominantTermOptions sweeps;
                sweeps.execution = execution;
                sweeps.progress = progress;
                return dominant_term(problem, sweeps);
            });
        }
        if ((options.method == "auto" || options.method == "exact") && !interrupted()) {
            add("exact", [&](const ProgressCallback& progress) {
                ExactOptions exact;
                exact.execution = execution;
                exact.progress = progress;
                return springfit::exact(problem, exact);
            });
        }
    }
    const double energy = energy_in(candidates.front().network, cases.training.motions);
    for (auto& candidate : candidates) {
        candidate.relative_stiffness = energy_in(candidate.network, cases.training.motions) / energy;
    }
    return candidates;
}

template <int Dim>
void score(std::vector<Candidate<Dim>>& candidates, const ReferenceCases<Dim>& cases, const Execution& execution) {
    constexpr std::size_t most = 12; // training cases: what a fit has seen says little, and takes as long
    CaseSet<Dim> sample;
    const std::size_t stride = (cases.training.motions.size() + most - 1) / most;
    for (std::size_t c = 0; c < cases.training.motions.size(); c += stride) {
        sample.scenarios.push_back(cases.training.scenarios[c]);
        sample.motions.push_back(cases.training.motions[c]);
    }
    Stage stage("score on motion");
    const std::size_t parts = 2 * candidates.size();
    std::size_t part = 0;
    const auto error_of = [&](const SpringNetwork<Dim, double>& network, const CaseSet<Dim>& set) {
        auto found =
            motion_error(network, set.scenarios, set.motions, stage.callback(part++, parts), scoring(execution));
        if (interrupted()) {
            found.error = std::numeric_limits<double>::infinity();
        }
        return found;
    };
    for (auto candidate = candidates.rbegin(); candidate != candidates.rend() && !interrupted(); ++candidate) {
        auto held_out = error_of(candidate->network, cases.held_out);
        candidate->held_out = held_out.error;
        candidate->held_out_cases = std::move(held_out.case_errors);
    }
    for (auto candidate = candidates.rbegin(); candidate != candidates.rend() && !interrupted(); ++candidate) {
        if (std::isfinite(candidate->held_out)) {
            candidate->training = error_of(candidate->network, sample).error;
        }
    }
}

template <int Dim>
io::NamedNumbers held_out_parts(const Candidate<Dim>& candidate, const CaseSet<Dim>& held_out) {
    io::NamedNumbers parts;
    for (const auto& [part, in_time, trained] :
         {std::tuple{"motions_in_time", true, true}, std::tuple{"equilibria_of_trained_kinds", false, true},
          std::tuple{"equilibria_of_unseen_kinds", false, false}}) {
        double from_reference = 0;
        double of_reference = 0;
        for (std::size_t c = 0; c < candidate.held_out_cases.size(); ++c) {
            const auto& motion = held_out.motions[c];
            const bool is_in_time = motion.n_frames() > 1;
            const bool is_trained = std::any_of(training_kinds.begin(), training_kinds.end(), [&](LoadKind kind) {
                return motion.name.find(to_string(kind)) != std::string::npos;
            });
            if (is_in_time != in_time || (!in_time && is_trained != trained)) {
                continue;
            }
            const FreeNodes free(motion.n_nodes(), motion.clamped);
            double size = 0;
            for (const auto& positions : motion.positions) {
                for (int i : free.nodes()) {
                    size += (positions.col(i) - motion.rest_positions.col(i)).squaredNorm();
                }
            }
            from_reference += candidate.held_out_cases[c] * candidate.held_out_cases[c] * size;
            of_reference += size;
        }
        if (of_reference > 0) {
            parts.emplace_back(part, std::sqrt(from_reference / of_reference));
        }
    }
    return parts;
}

io::Json describe(const FitReport& fit) {
    return {{"status", to_string(fit.status)},
            {"objective_start", fit.objective_start},
            {"objective", fit.objective},
            {"iterations", fit.iterations},
            {"kkt_residual", fit.kkt_residual},
            {"at_lower_bound", fit.at_lower.size()},
            {"at_upper_bound", fit.at_upper.size()},
            {"not_identified", fit.not_identified.size()},
            {"without_unknown", fit.without_unknown.size()}};
}

template std::vector<Candidate<2>> make_candidates<2>(const Discretisation<2>&, const ReferenceCases<2>&,
                                                      const FitOptions&, const Execution&);
template std::vector<Candidate<3>> make_candidates<3>(const Discretisation<3>&, const ReferenceCases<3>&,
                                                      const FitOptions&, const Execution&);
template io::NamedNumbers held_out_parts<2>(const Candidate<2>&, const CaseSet<2>&);
template io::NamedNumbers held_out_parts<3>(const Candidate<3>&, const CaseSet<3>&);
template void score<2>(std::vector<Candidate<2>>&, const ReferenceCases<2>&, const Execution&);
template void score<3>(std::vector<Candidate<3>>&, const ReferenceCases<3>&, const Execution&);

} // namespace program
