// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace springfit {

/// The subject of a warning. The names (`to_string`) are stable: programs may act on them.
enum class WarningCode {
    reference_ended_early,   ///< a motion of the reference ended before its last frame
    no_equilibrium,          ///< the reference found none under a load case
    clamps_left_out,         ///< clamps that hold the reference hold too few nodes of the network
    motion_not_matched,      ///< the recorded motions cannot be matched, as those with uneven frames
    softer_than_closed_form, ///< an acceleration fit lost stiffness
    not_excited,             ///< values that no motion excites kept their prior
    negative_set_to_zero,    ///< springs of a closed form
    unlike_reference,        ///< the network that is returned moves unlike the reference
    case_failed,             ///< the network that is returned cannot be simulated in a held-out case
    nothing_learnt,          ///< the fit does not move like what it was fitted to
    small_strain,            ///< the loads strain little, since the reference is linear
    resampled,               ///< a recorded motion had frames that are not evenly spaced
    noisy_recording,         ///< a recorded motion has noise, and was smoothed
    unobserved,              ///< a recorded motion does not have all nodes in all frames
    repeated_case,           ///< a recorded equilibrium was left out, since it repeats another
    other_unit,              ///< a recording is far longer or shorter than the body's own period
    incomplete_recording     ///< columns that a recording does not have were derived or taken as zero
};

[[nodiscard]] constexpr std::string_view to_string(WarningCode code) {
    switch (code) {
    case WarningCode::reference_ended_early: return "reference_ended_early";
    case WarningCode::no_equilibrium: return "no_equilibrium";
    case WarningCode::clamps_left_out: return "clamps_left_out";
    case WarningCode::motion_not_matched: return "motion_not_matched";
    case WarningCode::softer_than_closed_form: return "softer_than_closed_form";
    case WarningCode::not_excited: return "not_excited";
    case WarningCode::negative_set_to_zero: return "negative_set_to_zero";
    case WarningCode::unlike_reference: return "unlike_reference";
    case WarningCode::case_failed: return "case_failed";
    case WarningCode::nothing_learnt: return "nothing_learnt";
    case WarningCode::small_strain: return "small_strain";
    case WarningCode::resampled: return "resampled";
    case WarningCode::noisy_recording: return "noisy_recording";
    case WarningCode::unobserved: return "unobserved";
    case WarningCode::repeated_case: return "repeated_case";
    case WarningCode::other_unit: return "other_unit";
    case WarningCode::incomplete_recording: return "incomplete_recording";
    }
    return "unknown";
}

/// Something that a user should know of a result, for people and for programs.
struct Warning {
    WarningCode code;
    std::string about;                                  ///< the candidate, load case or file
    std::string message;                                ///< one sentence, the numbers in it
    std::string advice;                                 ///< what may help; empty where there is nothing to do
    std::vector<std::pair<std::string, double>> values; ///< the numbers by name
};

/// The warning as one line.
[[nodiscard]] inline std::string to_string(const Warning& warning) {
    return warning.advice.empty() ? warning.message : warning.message + "; " + warning.advice;
}

} // namespace springfit
