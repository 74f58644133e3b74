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
    poor,      ///< it does not: its held-out error is not below `CalibrateOptions::usable_error`
    unusable,  ///< it fails in some held-out case
    unfinished ///< the callback ended the work before all of it was judged
};

[[nodiscard]] constexpr std::string_view to_string(ChoiceRule rule) {
    return rule == ChoiceRule::asked_for ? "asked_for" : "least_held_out_error";
}

[[nodiscard]] constexpr std::string_view to_string(Verdict verdict) {
    switch (verdict) {
    case Verdict::good: return "good";
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

/// The scored candidate with the least held-out error, the first of equals; or that of the method that was named, which
/// comes last. Throws InvalidArgument where there is none.
template <int Dim>
[[nodiscard]] Choice choose(const std::vector<Candidate<Dim>>& candidates, const CalibrateOptions& options = {}) {
    require(!candidates.empty(), "candidates", "at least one", "none");
    if (options.method != Method::automatic && options.method != Method::closed_form) {
        return {candidates.size() - 1, ChoiceRule::asked_for};
    }
    std::size_t best = 0;
    for (std::size_t c = 0; c < candidates.size(); ++c) {
        if (candidates[c].held_out.error < candidates[best].held_out.error) {
            best = c;
        }
    }
    return {best, ChoiceRule::least_held_out_error};
}

[[nodiscard]] inline Verdict verdict_on(double held_out_error, const CalibrateOptions& options = {}) {
    return !(held_out_error < std::numeric_limits<double>::infinity()) ? Verdict::unusable
           : held_out_error < options.usable_error                     ? Verdict::good
                                                                       : Verdict::poor;
}

/// Warnings about scored candidates, for the user.
template <int Dim>
[[nodiscard]] std::vector<Warning> warnings_on(const std::vector<Candidate<Dim>>& candidates) {
    std::vector<Warning> warnings;
    for (const auto& candidate : candidates) {
        if (candidate.acceleration && candidate.relative_stiffness < 0.9) {
            warnings.push_back({.code = WarningCode::softer_than_closed_form,
                                .about = candidate.name,
                                .message = text(candidate.name, " came out softer than the closed form (",
                                                candidate.relative_stiffness,
                                                " of its stiffness): accelerations alone lose stiffness where springs "
                                                "cannot represent the material"),
                                .advice = {},
                                .values = {{"relative_stiffness", candidate.relative_stiffness}}});
        }
        if (candidate.acceleration && !candidate.acceleration->not_identified.empty()) {
            const std::size_t n = candidate.acceleration->not_identified.size();
            warnings.push_back(
                {.code = WarningCode::not_excited,
                 .about = candidate.name,
                 .message = text(candidate.name, ": ", n, " values that no motion excites kept their prior"),
                 .advice = {},
                 .values = {{"values", static_cast<double>(n)}}});
        }
        if (candidate.n_clamped > 0) {
            warnings.push_back({.code = WarningCode::negative_set_to_zero,
                                .about = candidate.name,
                                .message = text(candidate.name, ": ", candidate.n_clamped,
                                                " springs would be negative and were set to 0"),
                                .advice = {},
                                .values = {{"springs", static_cast<double>(candidate.n_clamped)}}});
        }
    }
    return warnings;
}

} // namespace springfit
