// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/calibrate/candidates.hpp>
#include <springfit/calibrate/given.hpp>
#include <springfit/calibrate/score.hpp>
#include <springfit/cases/record_load_cases.hpp>

#include "study.hpp"

/// One trial: which load cases the study asks for, how it asks for fits, and rows of their errors. How loads are drawn,
/// scaled and recorded, and how networks are fitted and scored, is the library's.
namespace study {

using namespace springfit;

inline constexpr double small_strain = 1e-4; ///< geometry hardly changes

[[nodiscard]] inline std::string strain_text(double strain) {
    return strain <= small_strain ? "small strain" : text("strain ", strain);
}

/// The load cases of a body: so many to train on; held-out ones that depend on the study's seed alone.
[[nodiscard]] inline LoadCaseOptions load_cases(int training, const Settings& settings) {
    return {.training = training,
            .clamps = 3,
            .held_out_loads = 9,
            .held_out_kinds = 10,
            .held_out_clamp = 9,
            .seed = settings.seed,
            .held_out_seed = 1000 + settings.seed};
}

/// How the study asks for fits: all of them, or matching of motion alone. They start at the first network given.
[[nodiscard]] CalibrateOptions fit_options(bool acceleration, const Settings& settings);

// Defined in trial.cpp for both dimensions.

/// Equilibria of random load cases at one strain.
template <int Dim>
[[nodiscard]] RecordedCases<Dim, double> equilibria(const CaseRecorder<Dim, double>& reference,
                                                    const Specimen<Dim, double>& body, const LoadCaseOptions& cases,
                                                    double strain, const Settings& settings);

/// Networks that were given and those that were fitted, matching of motion last; unscored.
template <int Dim>
[[nodiscard]] std::vector<Candidate<Dim>> candidates_of(const std::vector<NamedNetwork<Dim>>& given,
                                                        const RecordedCases<Dim, double>& cases,
                                                        const CalibrateOptions& how);

/// Scores networks on the held-out cases.
template <int Dim>
void judge(std::vector<Candidate<Dim>>& candidates, const RecordedCases<Dim, double>& cases,
           const CalibrateOptions& how);

/// Errors of a scored network on the three held-out sets.
template <int Dim>
[[nodiscard]] Errors errors_of(const Candidate<Dim>& candidate, const RecordedCases<Dim, double>& cases);

/// Adds the scores of networks to a row, in their order.
template <int Dim>
void add_scores(Row& row, const std::vector<Candidate<Dim>>& scored, const RecordedCases<Dim, double>& cases);

/// Makes candidates, and adds the scores of those that the row does not have yet.
template <int Dim>
void add_scores(Row& row, const std::vector<NamedNetwork<Dim>>& given, const RecordedCases<Dim, double>& cases,
                const CalibrateOptions& how);

} // namespace study
