// SPDX-License-Identifier: BSD-3-Clause
#include "trial.hpp"

#include <springfit/cases/load_cases.hpp>

namespace study {

namespace {

/// The study writes names of fits in words; those of closed forms are names of functions.
template <int Dim>
Score score_of(const Candidate<Dim>& candidate, const RecordedCases<Dim, double>& cases) {
    Score score{candidate.name, !candidate.acceleration && !candidate.trajectory, errors_of(candidate, cases),
                candidate.seconds, candidate.caveat};
    if (!score.is_closed_form) {
        std::replace(score.method.begin(), score.method.end(), '_', ' ');
    }
    if (candidate.acceleration) {
        score.note = text("Phi ", candidate.acceleration->objective);
    }
    if (candidate.trajectory) {
        const TrajectoryReport& report = *candidate.trajectory;
        score.note = text(to_string(report.status), ", misfit ", report.misfit_start, " to ", report.misfit, ", ",
                          report.iterations, " iterations, ", report.n_set_by_data(), " of ", report.theta.size(),
                          " values set by data");
    }
    return score;
}

} // namespace

CalibrateOptions fit_options(bool acceleration, const Settings& settings) {
    CalibrateOptions how;
    how.method = acceleration ? Method::automatic : Method::trajectory;
    how.one_pass = true;
    how.exact_solver = exact_solver();
    how.start = 0;
    how.horizon = 0;
    how.steps_per_frame = 1;
    how.matching_iterations = 20;
    how.matching_tolerance = 2e-3;
    how.matching_seconds = std::numeric_limits<double>::infinity();
    how.scored_training_cases = 0;
    how.execution = settings.execution;
    how.progress = until_interrupted();
    return how;
}

template <int Dim>
RecordedCases<Dim, double> equilibria(const CaseRecorder<Dim, double>& reference, const Specimen<Dim, double>& body,
                                      const LoadCaseOptions& cases, double strain, const Settings& settings) {
    auto recorded =
        record_equilibria(reference, body, random_load_cases(body, cases),
                          {.strain = strain, .execution = settings.execution, .progress = until_interrupted()});
    stop_if_interrupted();
    return recorded;
}

template <int Dim>
std::vector<Candidate<Dim>> candidates_of(const std::vector<NamedNetwork<Dim>>& given,
                                          const RecordedCases<Dim, double>& cases, const CalibrateOptions& how) {
    auto made = make_candidates(given, cases, how);
    stop_if_interrupted();
    std::stable_partition(made.all.begin(), made.all.end(),
                          [](const auto& candidate) { return !candidate.trajectory; });
    return std::move(made.all);
}

template <int Dim>
void judge(std::vector<Candidate<Dim>>& candidates, const RecordedCases<Dim, double>& cases,
           const CalibrateOptions& how) {
    (void)score(candidates, cases, how);
    stop_if_interrupted();
}

template <int Dim>
Errors errors_of(const Candidate<Dim>& candidate, const RecordedCases<Dim, double>& cases) {
    const auto error = [&](CaseRole role) { return error_with(role, candidate.held_out, cases.held_out); };
    return {error(CaseRole::unseen_load), error(CaseRole::unseen_kind), error(CaseRole::unseen_clamp)};
}

template <int Dim>
void add_scores(Row& row, const std::vector<Candidate<Dim>>& scored, const RecordedCases<Dim, double>& cases) {
    for (const auto& candidate : scored) {
        row.scores.push_back(score_of(candidate, cases));
    }
}

template <int Dim>
void add_scores(Row& row, const std::vector<NamedNetwork<Dim>>& given, const RecordedCases<Dim, double>& cases,
                const CalibrateOptions& how) {
    row.nodes = static_cast<long>(given.front().network.n_nodes());
    row.springs = static_cast<long>(given.front().network.n_springs());
    auto candidates = candidates_of(given, cases, how);
    std::erase_if(candidates, [&](const auto& candidate) { return row.find(candidate.name) != nullptr; });
    judge(candidates, cases, how);
    add_scores(row, candidates, cases);
    if (matches_motion(how.method) && row.find("trajectory") == nullptr) {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        row.scores.push_back({"trajectory", false, {infinity, infinity, infinity}, 0, "failed"});
    }
}

// Compiled here once for all parts.
#define STUDY_TRIAL(Dim)                                                                                               \
    template RecordedCases<Dim, double> equilibria(const CaseRecorder<Dim, double>&, const Specimen<Dim, double>&,     \
                                                   const LoadCaseOptions&, double, const Settings&);                   \
    template std::vector<Candidate<Dim>> candidates_of(const std::vector<NamedNetwork<Dim>>&,                          \
                                                       const RecordedCases<Dim, double>&, const CalibrateOptions&);    \
    template void judge(std::vector<Candidate<Dim>>&, const RecordedCases<Dim, double>&, const CalibrateOptions&);     \
    template Errors errors_of(const Candidate<Dim>&, const RecordedCases<Dim, double>&);                               \
    template void add_scores(Row&, const std::vector<Candidate<Dim>>&, const RecordedCases<Dim, double>&);             \
    template void add_scores(Row&, const std::vector<NamedNetwork<Dim>>&, const RecordedCases<Dim, double>&,           \
                             const CalibrateOptions&);
STUDY_TRIAL(2)
STUDY_TRIAL(3)
#undef STUDY_TRIAL

} // namespace study
