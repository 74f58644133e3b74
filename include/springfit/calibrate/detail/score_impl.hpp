// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numeric>

#include <springfit/calibrate/detail/candidates_impl.hpp>
#include <springfit/calibrate/score.hpp>

namespace springfit {

template <int Dim>
bool score(std::vector<Candidate<Dim>>& candidates, const RecordedCases<Dim, double>& cases,
           const CalibrateOptions& options) {
    require(options.scored_training_cases >= 1, "scored_training_cases", "at least one", options.scored_training_cases);
    const auto most = static_cast<std::size_t>(options.scored_training_cases);
    std::vector<std::size_t> sampled;
    for (std::size_t c = 0; c < cases.training.size(); c += (cases.training.size() + most - 1) / most) {
        sampled.push_back(c);
    }
    const auto sample = cases.training.subset(sampled);
    std::vector<std::size_t> all(cases.held_out.size());
    std::iota(all.begin(), all.end(), std::size_t(0));

    Stage stage(options.progress, "score on motion", 2 * candidates.size());
    std::size_t part = 0;
    const auto scores_of = [&](const SpringNetwork<Dim, double>& network, const CaseSet<Dim, double>& set,
                               const std::vector<std::size_t>& numbers) {
        auto found = motion_error(
            network, set.scenarios(), set.motions, stage.part(part++),
            {.max_iterations = detail::scoring_iterations, .stop_at_failure = true, .execution = options.execution});
        if (stage.stopped()) {
            found.error = std::numeric_limits<double>::infinity();
        }
        return CaseScores{found.error, numbers, std::move(found.case_errors), std::move(found.case_statuses)};
    };
    for (auto candidate = candidates.rbegin(); candidate != candidates.rend() && !stage.stopped(); ++candidate) {
        candidate->held_out = scores_of(candidate->network, cases.held_out, all);
    }
    for (auto candidate = candidates.rbegin(); candidate != candidates.rend() && !stage.stopped(); ++candidate) {
        if (std::isfinite(candidate->held_out.error)) {
            candidate->training = scores_of(candidate->network, sample, sampled);
        }
    }
    return !stage.stopped();
}

template <int Dim>
std::vector<PartError> held_out_parts(const Candidate<Dim>& candidate, const CaseSet<Dim, double>& held_out) {
    constexpr std::array names{"motions_in_time", "equilibria_of_trained_kinds", "equilibria_of_unseen_kinds"};
    std::array<double, names.size()> from_reference{};
    std::array<double, names.size()> of_reference{};
    for (std::size_t s = 0; s < candidate.held_out.cases.size(); ++s) {
        const std::size_t c = candidate.held_out.cases[s];
        const auto& motion = held_out.motions[c];
        const std::size_t part = !held_out.is_static(c) ? 0 : held_out.cases[c].role != CaseRole::unseen_kind ? 1 : 2;
        const FreeNodes free(motion.n_nodes(), motion.clamped);
        double size = 0;
        for (const auto& positions : motion.positions) {
            for (int i : free.nodes()) {
                size += (positions.col(i) - motion.rest_positions.col(i)).squaredNorm();
            }
        }
        from_reference[part] += candidate.held_out.errors[s] * candidate.held_out.errors[s] * size;
        of_reference[part] += size;
    }
    std::vector<PartError> parts;
    for (std::size_t p = 0; p < names.size(); ++p) {
        if (of_reference[p] > 0) {
            parts.push_back({names[p], std::sqrt(from_reference[p] / of_reference[p])});
        }
    }
    return parts;
}

} // namespace springfit
