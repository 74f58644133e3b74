// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/calibrate/candidate.hpp>
#include <springfit/calibrate/options.hpp>
#include <springfit/core/warning.hpp>

namespace springfit {

/// The rule that the returned network was chosen by.
enum class ChoiceRule {
    least_held_out_error, ///< of all candidates
    asked_for             ///< the method that was named, whatever its error
};

/// The worth of the returned network, by its error on cases that no fit has seen.
enum class Verdict {
    good,      ///< it moves like the reference
    fair,      ///< it moves like the reference with an error that can be seen, or fails in a held-out case
    poor,      ///< it does not move like the reference
    unusable,  ///< it has nothing of the reference's motion, or what it was fitted to taught it nothing
    unfinished ///< the callback ended the work before all of it was judged
};

/// True where the network is of use: good or fair.
[[nodiscard]] constexpr bool is_usable(Verdict verdict) {
    return verdict == Verdict::good || verdict == Verdict::fair;
}

[[nodiscard]] constexpr std::string_view to_string(ChoiceRule rule) {
    return rule == ChoiceRule::asked_for ? "asked_for" : "least_held_out_error";
}

[[nodiscard]] constexpr std::string_view to_string(Verdict verdict) {
    switch (verdict) {
    case Verdict::good: return "good";
    case Verdict::fair: return "fair";
    case Verdict::poor: return "poor";
    case Verdict::unusable: return "unusable";
    case Verdict::unfinished: return "unfinished";
    }
    return "unknown";
}

struct Choice {
    std::size_t candidate = 0;
    ChoiceRule rule = ChoiceRule::least_held_out_error;
};

/// The scored candidate with the least held-out error, or among those near to it (`CalibrateOptions::near_equal`) the
/// one with the fewest springs and cells; only fits where a method was named. Throws InvalidArgument where there is
/// none.
template <int Dim>
[[nodiscard]] Choice choose(const std::vector<Candidate<Dim>>& candidates, const CalibrateOptions& options = {}) {
    require(!candidates.empty(), "candidates", "at least one", "none");
    require(options.near_equal >= 1, "near_equal", "a factor not below 1", options.near_equal);
    const bool is_asked_for = options.method != Method::automatic && options.method != Method::closed_form;
    const auto is_fit = [&](std::size_t c) { return candidates[c].acceleration || candidates[c].trajectory; };
    std::size_t best = candidates.size() - 1;
    const auto error = [&](std::size_t c) { return candidates[c].held_out.error; };
    const auto may_be = [&](std::size_t c) { return !is_asked_for || is_fit(c) || !is_fit(best); };
    for (std::size_t c = candidates.size(); c-- > 0;) {
        if (may_be(c) && (error(c) <= error(best) || (is_asked_for && is_fit(c) && !is_fit(best)))) {
            best = c;
        }
    }
    std::size_t simplest = best;
    for (std::size_t c = 0; c < candidates.size(); ++c) {
        const bool is_simpler = candidates[c].n_parts() < candidates[simplest].n_parts();
        const bool is_as_simple = candidates[c].n_parts() == candidates[simplest].n_parts();
        if (may_be(c) && error(c) <= options.near_equal * error(best) &&
            (is_simpler || (is_as_simple && error(c) < error(simplest)))) {
            simplest = c;
        }
    }
    return {simplest, is_asked_for ? ChoiceRule::asked_for : ChoiceRule::least_held_out_error};
}

/// The verdict on a network by its errors, beside the recording's noise, on cases that no fit has seen.
[[nodiscard]] inline Verdict verdict_on(const CaseScores& held_out, const VerdictLimits& limits = {}) {
    const double error = held_out.beside_noise();
    return !(error < limits.unusable)                          ? Verdict::unusable
           : !(error < limits.poor)                            ? Verdict::poor
           : !(error < limits.fair) || held_out.n_failed() > 0 ? Verdict::fair
                                                               : Verdict::good;
}

/// Warnings about a candidate, for the user of its network.
template <int Dim>
[[nodiscard]] std::vector<Warning> warnings_on(const Candidate<Dim>& candidate) {
    std::vector<Warning> warnings;
    if (candidate.acceleration && candidate.relative_stiffness < 0.9) {
        warnings.push_back(
            {.code = WarningCode::softer_than_closed_form,
             .about = candidate.name,
             .message = text(candidate.name, " came out softer than the closed form (", candidate.relative_stiffness,
                             " of its stiffness): accelerations alone lose stiffness where springs "
                             "cannot represent the material"),
             .advice = {},
             .values = {{"relative_stiffness", candidate.relative_stiffness}}});
    }
    if (candidate.acceleration && !candidate.acceleration->not_identified.empty()) {
        const std::size_t n = candidate.acceleration->not_identified.size();
        warnings.push_back({.code = WarningCode::not_excited,
                            .about = candidate.name,
                            .message = text(candidate.name, ": ", n, " values that no motion excites kept their prior"),
                            .advice = {},
                            .values = {{"values", static_cast<double>(n)}}});
    }
    if (candidate.n_clamped > 0) {
        warnings.push_back(
            {.code = WarningCode::negative_set_to_zero,
             .about = candidate.name,
             .message = text(candidate.name, ": ", candidate.n_clamped, " springs would be negative and were set to 0"),
             .advice = {},
             .values = {{"springs", static_cast<double>(candidate.n_clamped)}}});
    }
    return warnings;
}

} // namespace springfit
