// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/calibrate/calibrate.hpp>

namespace springfit {

template <int Dim>
Calibration<Dim> calibrate(const std::vector<NamedNetwork<Dim>>& given, RecordedCases<Dim, double> cases,
                           const CalibrateOptions& options) {
    Calibration<Dim> result;
    result.warnings = cases.warnings;
    const Stopwatch fitting;
    auto made = make_candidates(given, cases, options);
    result.candidates = std::move(made.all);
    result.warnings.insert(result.warnings.end(), made.warnings.begin(), made.warnings.end());
    result.seconds.emplace_back("fit", fitting.seconds());

    const Stopwatch scoring;
    const bool all_scored = score(result.candidates, cases, options);
    result.seconds.emplace_back("score", scoring.seconds());
    result.choice = choose(result.candidates, options);

    const Candidate<Dim>& best = result.best();
    const auto remarks = warnings_on(result.candidates);
    result.warnings.insert(result.warnings.end(), remarks.begin(), remarks.end());
    const bool unfinished = cases.interrupted || made.interrupted || !all_scored;
    result.verdict = unfinished ? Verdict::unfinished : verdict_on(best.held_out.error, options);
    result.status = unfinished ? Status::interrupted : best.status();
    if (result.verdict == Verdict::poor || result.verdict == Verdict::unusable) {
        result.warnings.push_back(
            {.code = WarningCode::unlike_reference,
             .about = best.name,
             .message =
                 text("the returned network moves unlike the reference (held-out error ", best.held_out.error, ")"),
             .advice = "cells that hold their volume, smaller strain or deformation, or more nodes may help",
             .values = {{"held_out_error", best.held_out.error}}});
    }
    result.parts = held_out_parts(best, cases.held_out);
    result.stable_step = stable_step(best.network, cases.held_out.motions.front().clamped);
    result.cases = std::move(cases);
    return result;
}

} // namespace springfit
