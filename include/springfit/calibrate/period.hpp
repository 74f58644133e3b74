// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

#include <springfit/cases/case_set.hpp>
#include <springfit/score/frequency.hpp>

namespace springfit {

/// The period of the slowest motion of a network, held as the first held-out case is, s; 0 where it has none.
template <int Dim>
[[nodiscard]] double slowest_period(const SpringNetwork<Dim, double>& network,
                                    const RecordedCases<Dim, double>& cases) {
    require(!cases.held_out.empty(), "held_out", "at least one case", "none");
    const double omega = lowest_frequency(network, cases.held_out.motions.front().clamped).omega;
    return omega > 0 ? 2 * std::numbers::pi / omega : 0.;
}

/// Time from the first frame to the last of the longest recorded motion, s; 0 where all are equilibria.
template <int Dim>
[[nodiscard]] double recorded_time(const RecordedCases<Dim, double>& cases) {
    double longest = 0;
    for (const auto* set : {&cases.training, &cases.held_out}) {
        for (const auto& motion : set->motions) {
            longest = std::max(longest, motion.times.back() - motion.times.front());
        }
    }
    return longest;
}

/// The warning that a recording is more than 100 times longer or shorter than the body's slowest period, as one in
/// other units is [our definition]; none else.
template <int Dim>
[[nodiscard]] std::vector<Warning> warnings_of_units(double period, const RecordedCases<Dim, double>& cases) {
    constexpr double far = 100;
    const double recorded = recorded_time(cases);
    if (cases.period > 0 || !(period > 0 && recorded > 0) || (recorded < far * period && recorded > period / far)) {
        return {};
    }
    return {{.code = WarningCode::other_unit,
             .about = cases.held_out.motions.front().name,
             .message = text("the recording lasts ", recorded, " s, the body's slowest period is about ", period, " s"),
             .advice = "lengths must be in m and times in s (--unit mm, --time-unit ms)",
             .values = {{"recorded", recorded}, {"period", period}}}};
}

/// Throws InvalidArgument for a recording whose frames are more than two of the body's slowest periods apart: they do
/// not show how it moves.
template <int Dim>
void check_frame_gaps(double period, const RecordedCases<Dim, double>& cases) {
    for (const auto* set : {&cases.training, &cases.held_out}) {
        for (const auto& motion : set->motions) {
            if (motion.n_frames() > 1 && cases.period == 0 && period > 0) {
                const double gap =
                    (motion.times.back() - motion.times.front()) / static_cast<double>(motion.n_frames() - 1);
                require(
                    gap <= 2 * period, text("motion '", motion.name, "'"),
                    text("frames at most two of the body's slowest periods, about ", period,
                         " s each, apart, lengths in m and times in s (--unit mm, --time-unit ms); of a body that is "
                         "loaded slowly, frames at rest in a file each"),
                    text("frames ", gap, " s apart"));
            }
        }
    }
}

} // namespace springfit
