// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include <springfit/calibrate/calibrate.hpp>
#include <springfit/calibrate/detail/units.hpp>

namespace springfit {

namespace detail {

/// Error on the training cases above which a fit has learnt nothing; 1 is that of not moving.
inline constexpr double nothing_learnt = 0.9;

/// Iterations of matching where several variants are tried: most of what there is to gain comes in the first.
inline constexpr int iterations_of_a_try = 8;

/// Iterations with all cases that the best of several variants goes on with: it has learnt the most of it.
inline constexpr int iterations_to_finish = 4;

/// The cases that a try learns from: a third of the equilibria, of every clamp set, where there are many.
template <int Dim>
RecordedCases<Dim, double> cases_of_a_try(const RecordedCases<Dim, double>& cases) {
    constexpr std::size_t many = 18;
    std::vector<std::size_t> kept;
    std::size_t n_equilibria = 0;
    for (std::size_t c = 0; c < cases.training.size(); ++c) {
        const std::size_t turn = cases.training.is_static(c) ? n_equilibria++ % 9 : 0; // clamp sets take turns of 3
        if (turn % 4 == 0) {
            kept.push_back(c);
        }
    }
    if (n_equilibria < many) {
        return cases;
    }
    RecordedCases<Dim, double> fewer = cases;
    fewer.training = cases.training.subset(kept);
    return fewer;
}

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

/// True where the best network moves no better than rest in what was to learn from, nor like the reference elsewhere.
template <int Dim>
bool has_learnt_nothing(const Candidate<Dim>& best, const VerdictLimits& limits) {
    return best.training.is_scored() && best.training.error > nothing_learnt &&
           !is_usable(verdict_on(best.held_out, limits));
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

/// What a candidate was made from: a variant, and where it is no fit, the number among those given.
struct Origin {
    std::size_t variant = 0;
    std::optional<std::size_t> given{};
};

/// Makes the candidates of a variant from the cases in `learnt`, and scores matched motion; all of them where there is
/// none. (What else there is waits until the best is known.) Returns false where the callback ended it.
template <int Dim>
bool add_candidates(const NetworkVariant<Dim>& variant, std::size_t number, const RecordedCases<Dim, double>& learnt,
                    const RecordedCases<Dim, double>& cases, const CalibrateOptions& options, Calibration<Dim>& result,
                    std::vector<Origin>& origins) {
    const Stopwatch fitting;
    auto made = make_candidates(variant.given, learnt, options);
    result.warnings.insert(result.warnings.end(), made.warnings.begin(), made.warnings.end());
    result.seconds[0].second += fitting.seconds();
    std::vector<Candidate<Dim>> kept, matched;
    std::vector<std::size_t> places; // of those matched
    for (std::size_t c = 0; c < made.all.size(); ++c) {
        auto& candidate = made.all[c];
        const bool is_given = c < variant.given.size();
        const auto& network = candidate.network;
        const bool is_again = number > 0 && is_given && network.n_cells() > 0 && // as without the cells
                              !(network.volume_stiffness.array() > 0).any();
        if (is_again) {
            continue;
        }
        origins.push_back({number, is_given ? std::optional(c) : std::nullopt});
        if (candidate.trajectory) {
            places.push_back(kept.size());
            matched.push_back(candidate);
        }
        kept.push_back(std::move(candidate));
    }
    const Stopwatch scoring;
    const bool all_scored = score_try(matched.empty() ? kept : matched, cases, options);
    result.seconds[1].second += scoring.seconds();
    for (std::size_t m = 0; m < places.size(); ++m) {
        kept[places[m]] = std::move(matched[m]);
    }
    for (auto& candidate : kept) {
        if (!variant.parts.empty()) {
            candidate.name += " (" + variant.parts + ")";
        }
        result.candidates.push_back(std::move(candidate));
    }
    return all_scored && !made.interrupted;
}

/// Goes on with the matching of the chosen candidate, which a try ended early. Returns false where the callback ended
/// it.
template <int Dim>
bool finish_try(const NetworkVariant<Dim>& variant, const RecordedCases<Dim, double>& cases,
                const CalibrateOptions& options, Calibration<Dim>& result) {
    auto& best = result.candidates[result.choice.candidate];
    const Stopwatch fitting;
    auto how = options;
    how.matching_iterations = std::min(how.matching_iterations, iterations_to_finish);
    auto made = CandidateMaker<Dim>(variant.given, cases, how).go_on(best);
    made.all.erase(made.all.begin(), made.all.end() - 1);
    result.seconds[0].second += fitting.seconds();
    auto& found = made.all.front();
    if (!found.trajectory) {
        return !made.interrupted;
    }
    const Stopwatch scoring;
    const bool all_scored = score_try(made.all, cases, options);
    result.seconds[1].second += scoring.seconds();
    if (found.held_out.error <= best.held_out.error) {
        found.name = best.name;
        found.seconds += best.seconds;
        best = std::move(found);
    }
    return all_scored && !made.interrupted;
}

/// Tries the variants, finishes the best and judges all. Fills in `result`, in the units of its arguments.
template <int Dim>
void try_variants(const std::vector<NetworkVariant<Dim>>& variants, const RecordedCases<Dim, double>& cases,
                  const CalibrateOptions& options, Calibration<Dim>& result, std::vector<Origin>& origins) {
    bool unfinished = cases.interrupted;
    const bool is_trying = variants.size() > 1;
    const auto fewer = is_trying ? cases_of_a_try(cases) : RecordedCases<Dim, double>{};
    auto how = options;
    if (is_trying) {
        how.matching_iterations = std::min(how.matching_iterations, iterations_of_a_try);
    }
    for (std::size_t v = 0; v < variants.size(); ++v) {
        unfinished =
            !add_candidates(variants[v], v, is_trying ? fewer : cases, cases, how, result, origins) || unfinished;
        result.choice = choose(result.candidates, options);
        if (unfinished || verdict_on(result.best().held_out, options.limits) == Verdict::good) {
            break;
        }
    }
    if (!unfinished && is_trying && result.best().trajectory) {
        const auto& chosen = variants[origins[result.choice.candidate].variant];
        unfinished = !finish_try(chosen, cases, options, result);
    }
    const Stopwatch scoring;
    unfinished = !score(result.candidates, cases, options) || unfinished;
    result.seconds[1].second += scoring.seconds();
    result.choice = choose(result.candidates, options);
    const Candidate<Dim>& best = result.best();
    const auto remarks = warnings_on(best);
    result.warnings.insert(result.warnings.end(), remarks.begin(), remarks.end());
    result.parts = held_out_parts(best, cases.held_out);
    result.verdict = unfinished                                 ? Verdict::unfinished
                     : has_learnt_nothing(best, options.limits) ? Verdict::unusable
                                                                : verdict_on(best.held_out, options.limits);
    result.status = unfinished ? Status::interrupted : best.status();
    if (!unfinished) {
        warn_of_failures(best, cases, result.warnings);
        warn_of_error(result, cases, options);
    }
}

/// Gives a candidate of a network's own units back in those of what it was made from.
template <int Dim>
void restore(Candidate<Dim>& candidate, const Origin& origin, const std::vector<NetworkVariant<Dim>>& variants,
             const NetworkUnits<Dim>& units) {
    const auto& given = variants[origin.variant].given;
    const auto& like = given[origin.given.value_or(0)].network;
    candidate.network = units.from_own(candidate.network, like);
    if (origin.given) {
        candidate.network.stiffness = like.stiffness;
        candidate.network.volume_stiffness = like.volume_stiffness;
    }
    candidate.stiffness_damping *= units.time();
}

} // namespace detail

template <int Dim>
Calibration<Dim> calibrate(const std::vector<NetworkVariant<Dim>>& variants, RecordedCases<Dim, double> cases,
                           const CalibrateOptions& options) {
    require(!variants.empty(), "variants", "a network to start from", "none");
    for (const auto& variant : variants) {
        detail::check_given(variant.given, cases, options);
    }
    Calibration<Dim> result;
    result.warnings = cases.warnings;
    result.seconds = {{"fit", 0.}, {"score", 0.}};
    const auto& first = variants.front().given.front().network;
    result.period = slowest_period(first, cases);
    check_frame_gaps(result.period, cases);
    const auto of_units = warnings_of_units(result.period, cases);
    result.warnings.insert(result.warnings.end(), of_units.begin(), of_units.end());

    const detail::NetworkUnits<Dim> units(first);
    auto own = variants;
    for (auto& variant : own) {
        for (auto& named : variant.given) {
            named.network = units.to_own(std::move(named.network));
        }
    }
    std::vector<detail::Origin> origins; // of the candidates
    detail::try_variants(own, units.to_own(cases), options, result, origins);
    for (std::size_t c = 0; c < result.candidates.size(); ++c) {
        detail::restore(result.candidates[c], origins[c], variants, units);
    }

    const Candidate<Dim>& best = result.best();
    result.stable_step = stable_step(best.network, cases.held_out.motions.front().clamped);
    cases.stiffness_damping = best.stiffness_damping;
    if (best.stiffness_damping > 0) {
        const double omega = lowest_frequency(best.network, cases.held_out.motions.front().clamped).omega;
        result.damping_ratio = best.stiffness_damping * omega / 2;
    }
    result.cases = std::move(cases);
    return result;
}

} // namespace springfit
