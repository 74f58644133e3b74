// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/calibrate/candidate.hpp>
#include <springfit/calibrate/options.hpp>
#include <springfit/cases/case_set.hpp>

namespace springfit {

/// Fills in the errors of every candidate that has none yet on the held-out cases, and then on a sample of the
/// training's: matched motion first, other fits, then the given networks.
///
/// A case that a candidate fails in counts as 1, and those after it are not tried: they count as 1, too. Of those that
/// failed, up to three are tried again in every case, with all that helps (`motion_error`): those that went better than
/// the best where they came through, or best where no candidate is good. Returns false where the callback ended it;
/// what was not reached stays infinite.
template <int Dim>
[[nodiscard]] bool score(std::vector<Candidate<Dim>>& candidates, const RecordedCases<Dim, double>& cases,
                         const CalibrateOptions& options = {});

/// The error of `motion_error` over those of the scored cases that have a role; NaN where there are none. `set` is
/// what they were scored on.
template <int Dim>
[[nodiscard]] double error_with(CaseRole role, const CaseScores& scores, const CaseSet<Dim, double>& set);

/// The error of a network on a part of the held-out cases.
struct PartError {
    std::string_view part; ///< "motions_in_time", "equilibria_of_trained_kinds" or "equilibria_of_unseen_kinds"
    double error = 0;
};

/// Errors of a scored candidate on motions in time, on equilibria under loads of the kinds that training has, and on
/// those under kinds that it never shows; those parts that there are. Each is the error of `motion_error` over its
/// cases.
template <int Dim>
[[nodiscard]] std::vector<PartError> held_out_parts(const Candidate<Dim>& candidate,
                                                    const CaseSet<Dim, double>& held_out);

} // namespace springfit

#include <springfit/calibrate/detail/score_impl.hpp>
