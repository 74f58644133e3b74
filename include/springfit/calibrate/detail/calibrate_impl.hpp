// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <numbers>
#include <string>
#include <string_view>

#include <springfit/calibrate/calibrate.hpp>

namespace springfit {

namespace detail {

/// Error on the training cases above which a fit has learnt nothing; 1 is that of not moving.
inline constexpr double nothing_learnt = 0.9;

/// Iterations of matching for a variant that is not the last: most of what there is to gain comes in the first.
inline constexpr int iterations_of_a_try = 12;

/// Names the held-out cases that the returned network fails in.
template <int Dim>
void warn_of_failures(const Candidate<Dim>& best, const RecordedCases<Dim, double>& cases,
                      std::vector<Warning>& warnings) {
    const auto& scores = best.held_out;
    for (std::size_t s = 0; s < scores.cases.size(); ++s) {
        if (scores.statuses[s] == Status::converged || scores.statuses[s] == Status::interrupted) {
            continue;
        }
        const auto& motion = cases.held_out.motions[scores.cases[s]];
        warnings.push_back(
            {.code = WarningCode::case_failed,
             .about = motion.name,
             .message = text("the returned network ",
                             motion.n_frames() == 1 ? "finds no equilibrium" : "cannot be stepped", " under ",
                             motion.name, " (", to_string(scores.statuses[s]), "): that case counts as an error of 1"),
             .advice = {},
             .values = {}});
    }
}

/// True for a fit that moves no better than rest where it was fitted, nor like the reference elsewhere.
template <int Dim>
bool has_learnt_nothing(const Candidate<Dim>& candidate, const VerdictLimits& limits) {
    const bool is_fitted = candidate.acceleration.has_value() || candidate.trajectory.has_value();
    return is_fitted && candidate.training.is_scored() && candidate.training.error > nothing_learnt &&
           !is_usable(verdict_on(candidate.held_out, limits));
}

/// Says what is bad where the verdict is, and what this input leaves to try.
template <int Dim>
void warn_of_error(Calibration<Dim>& result, const RecordedCases<Dim, double>& cases, const CalibrateOptions& options) {
    const Candidate<Dim>& best = result.best();
    if (has_learnt_nothing(best, options.limits)) {
        result.warnings.push_back({.code = WarningCode::nothing_learnt,
                                   .about = best.name,
                                   .message = text("nothing was learnt: the error on the training cases is ",
                                                   best.training.error, ", as of a network that does not move"),
                                   .advice = "the forces that moved the body must be in the recording or be declared "
                                             "(gravity is one), and its unit of time be the second",
                                   .values = {{"training_error", best.training.error}}});
    }
    if (is_usable(result.verdict)) {
        return;
    }
    const auto worst = std::max_element(result.parts.begin(), result.parts.end(),
                                        [](const auto& a, const auto& b) { return a.error < b.error; });
    std::string advice;
    const auto add = [&](std::string_view one) { advice += (advice.empty() ? "" : ", ") + std::string(one); };
    if (best.network.n_cells() == 0) {
        add("cells that hold their volume");
    }
    if (cases.period > 0) { // the loads were made here
        add("a smaller strain");
        add("more nodes");
    } else {
        add("more recorded cases of other kinds");
    }
    result.warnings.push_back(
        {.code = WarningCode::unlike_reference,
         .about = best.name,
         .message = text(
             "the returned network moves unlike the reference (held-out error ", best.held_out.error,
             worst == result.parts.end() ? std::string() : text("; worst in ", worst->part, ": ", worst->error), ")"),
         .advice = advice + " may help",
         .values = {{"held_out_error", best.held_out.error}, {"limit", options.limits.poor}}});
}

/// The slowest period of the body as a closed form has it, s. Recorded motions that are far longer or shorter are
/// remarked on.
template <int Dim>
double period_of(const SpringNetwork<Dim, double>& network, const RecordedCases<Dim, double>& cases,
                 std::vector<Warning>& warnings) {
    const auto& first = cases.held_out.motions.front();
    const double omega = lowest_frequency(network, first.clamped).omega;
    if (!(omega > 0)) {
        return 0;
    }
    const double period = 2 * std::numbers::pi / omega;
    const double recorded = first.n_frames() > 1 ? first.times.back() - first.times.front() : period;
    constexpr double far = 100; // our definition: units are off by 1000
    if (cases.period == 0 && (recorded > far * period || recorded < period / far)) {
        warnings.push_back(
            {.code = WarningCode::other_unit,
             .about = first.name,
             .message = text("the recording lasts ", recorded, " s, the body's slowest period is about ", period, " s"),
             .advice = "lengths must be in m and times in s",
             .values = {{"recorded", recorded}, {"period", period}}});
    }
    return period;
}

/// Makes and scores the candidates of a variant. Returns false where the callback ended it.
template <int Dim>
bool add_candidates(const NetworkVariant<Dim>& variant, const RecordedCases<Dim, double>& cases,
                    const CalibrateOptions& options, Calibration<Dim>& result) {
    const Stopwatch fitting;
    auto made = make_candidates(variant.given, cases, options);
    result.warnings.insert(result.warnings.end(), made.warnings.begin(), made.warnings.end());
    result.seconds[0].second += fitting.seconds();
    const Stopwatch scoring;
    const bool all_scored = score(made.all, cases, options);
    result.seconds[1].second += scoring.seconds();
    for (auto& candidate : made.all) {
        if (!variant.parts.empty()) {
            candidate.name += " (" + variant.parts + ")";
        }
        result.candidates.push_back(std::move(candidate));
    }
    return all_scored && !made.interrupted;
}

/// Matches motion to the end for the chosen candidate, which a try ended early. Returns false where the callback ended
/// it.
template <int Dim>
bool finish_try(const NetworkVariant<Dim>& variant, const RecordedCases<Dim, double>& cases, CalibrateOptions options,
                Calibration<Dim>& result) {
    options.method = Method::trajectory;
    Calibration<Dim> finished;
    finished.seconds = {{"fit", 0.}, {"score", 0.}};
    const bool all_done = add_candidates(variant, cases, options, finished);
    result.seconds[0].second += finished.seconds[0].second;
    result.seconds[1].second += finished.seconds[1].second;
    auto& best = result.candidates[result.choice.candidate];
    auto& found = finished.candidates.back();
    if (found.trajectory && found.held_out.error <= best.held_out.error) {
        best = std::move(found);
    }
    return all_done;
}

} // namespace detail

template <int Dim>
Calibration<Dim> calibrate(const std::vector<NetworkVariant<Dim>>& variants, RecordedCases<Dim, double> cases,
                           const CalibrateOptions& options) {
    require(!variants.empty(), "variants", "a network to start from", "none");
    Calibration<Dim> result;
    result.warnings = cases.warnings;
    result.seconds = {{"fit", 0.}, {"score", 0.}};
    bool unfinished = cases.interrupted;
    std::vector<std::size_t> variant_of; // the candidates
    for (std::size_t v = 0; v < variants.size(); ++v) {
        auto how = options;
        if (v + 1 < variants.size()) {
            how.matching_iterations = std::min(how.matching_iterations, detail::iterations_of_a_try);
        }
        unfinished = !detail::add_candidates(variants[v], cases, how, result) || unfinished;
        variant_of.resize(result.candidates.size(), v);
        result.choice = choose(result.candidates, options);
        if (unfinished || verdict_on(result.best().held_out, options.limits) == Verdict::good) {
            break;
        }
    }
    const std::size_t chosen = variant_of[result.choice.candidate];
    if (!unfinished && chosen + 1 < variants.size() && result.best().trajectory &&
        result.best().status() == Status::iteration_limit) {
        unfinished = !detail::finish_try(variants[chosen], cases, options, result);
    }
    const Candidate<Dim>& best = result.best();
    const auto remarks = warnings_on(best);
    result.warnings.insert(result.warnings.end(), remarks.begin(), remarks.end());
    result.parts = held_out_parts(best, cases.held_out);
    result.verdict = unfinished                                         ? Verdict::unfinished
                     : detail::has_learnt_nothing(best, options.limits) ? Verdict::unusable
                                                                        : verdict_on(best.held_out, options.limits);
    result.status = unfinished ? Status::interrupted : best.status();
    if (!unfinished) {
        detail::warn_of_failures(best, cases, result.warnings);
        detail::warn_of_error(result, cases, options);
    }
    result.stable_step = stable_step(best.network, cases.held_out.motions.front().clamped);
    cases.stiffness_damping = best.stiffness_damping;
    result.period = detail::period_of(variants.front().given.front().network, cases, result.warnings);
    result.cases = std::move(cases);
    return result;
}

} // namespace springfit
