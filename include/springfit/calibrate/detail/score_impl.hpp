// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>
#include <numeric>

#include <springfit/calibrate/detail/candidates_impl.hpp>
#include <springfit/calibrate/score.hpp>

namespace springfit {

namespace detail {

/// The error that the noise of recorded motions makes by itself: sqrt(sum sigma^2 / sum |x - x_rest|^2), over the
/// coordinates that errors count.
template <int Dim>
double error_of_noise(const CaseSet<Dim, double>& set) {
    double noise = 0;
    double size = 0;
    for (const auto& motion : set.motions) {
        const FreeNodes free(motion.n_nodes(), motion.clamped);
        for (std::size_t t = 0; t < motion.positions.size(); ++t) {
            for_observed(motion, t, free.nodes(), [&](int i) {
                noise += Dim * motion.noise * motion.noise;
                size += (motion.positions[t].col(i) - motion.rest_positions.col(i)).squaredNorm();
            });
        }
    }
    return size > 0 ? std::sqrt(noise / size) : 0.;
}

} // namespace detail

template <int Dim>
bool score(std::vector<Candidate<Dim>>& candidates, const RecordedCases<Dim, double>& cases,
           const CalibrateOptions& options) {
    require(options.scored_training_cases >= 0, "scored_training_cases", "a number not below 0",
            options.scored_training_cases);
    const auto most = static_cast<std::size_t>(options.scored_training_cases);
    std::vector<std::size_t> sampled;
    for (std::size_t c = 0; most > 0 && c < cases.training.size(); c += (cases.training.size() + most - 1) / most) {
        sampled.push_back(c);
    }
    const auto sample = cases.training.subset(sampled);
    std::vector<std::size_t> all(cases.held_out.size());
    std::iota(all.begin(), all.end(), std::size_t(0));

    Stage stage(options.progress, "score on motion", 2 * candidates.size());
    std::size_t part = 0;
    const auto scores_of = [&](const SpringNetwork<Dim, double>& network, const CaseSet<Dim, double>& set,
                               const std::vector<std::size_t>& numbers, bool stop_at_failure) {
        auto found = motion_error(network, set.scenarios(), set.motions, stage.part(part++),
                                  {.max_iterations = detail::scoring_iterations,
                                   .stop_at_failure = stop_at_failure,
                                   .execution = options.execution});
        if (stage.stopped()) {
            found.error = std::numeric_limits<double>::infinity();
        }
        return CaseScores{found.error, detail::error_of_noise(set), numbers, std::move(found.case_errors),
                          std::move(found.case_statuses)};
    };
    // Matched motion first, then the other fits: an early end leaves the best of them judged.
    std::vector<Candidate<Dim>*> order;
    for (auto candidate = candidates.rbegin(); candidate != candidates.rend(); ++candidate) {
        order.push_back(&*candidate);
    }
    std::stable_partition(order.begin(), order.end(), [](const auto* candidate) { return candidate->trajectory; });
    double best = std::numeric_limits<double>::infinity();
    for (auto* candidate : order) {
        if (!stage.stopped()) { // beside a good network nobody waits for one that fails to be tried again and again
            candidate->held_out = scores_of(candidate->network, cases.held_out, all, best < options.limits.fair);
            best = std::min(best, candidate->held_out.error);
        }
    }
    for (auto* candidate : order) {
        if (!sampled.empty() && !stage.stopped()) {
            const bool is_good = candidate->held_out.error < options.limits.fair;
            candidate->training =
                scores_of(candidate->network, sample, sampled, !is_good && best < options.limits.fair);
        }
    }
    return !stage.stopped();
}

namespace detail {

/// The error of `motion_error` over the scored cases that `takes`, from those of each case; NaN where there are none.
template <int Dim, class Takes>
double error_over(const CaseScores& scores, const CaseSet<Dim, double>& set, const Takes& takes) {
    double from_reference = 0;
    double of_reference = 0;
    for (std::size_t s = 0; s < scores.cases.size(); ++s) {
        const std::size_t c = scores.cases[s];
        if (!takes(c)) {
            continue;
        }
        const auto& motion = set.motions[c];
        const FreeNodes free(motion.n_nodes(), motion.clamped);
        double size = 0;
        for (std::size_t t = 0; t < motion.positions.size(); ++t) {
            for_observed(motion, t, free.nodes(), [&](int i) {
                size += (motion.positions[t].col(i) - motion.rest_positions.col(i)).squaredNorm();
            });
        }
        from_reference += scores.errors[s] * scores.errors[s] * size;
        of_reference += size;
    }
    return of_reference > 0 ? std::sqrt(from_reference / of_reference) : std::numeric_limits<double>::quiet_NaN();
}

} // namespace detail

template <int Dim>
double error_with(CaseRole role, const CaseScores& scores, const CaseSet<Dim, double>& set) {
    return detail::error_over(scores, set, [&](std::size_t c) { return set.cases[c].role == role; });
}

template <int Dim>
std::vector<PartError> held_out_parts(const Candidate<Dim>& candidate, const CaseSet<Dim, double>& held_out) {
    std::vector<PartError> parts;
    const auto add = [&](std::string_view name, const auto& takes) {
        if (const double error = detail::error_over(candidate.held_out, held_out, takes); !std::isnan(error)) {
            parts.push_back({name, error});
        }
    };
    const auto is_trained = [&](std::size_t c) { return held_out.cases[c].role != CaseRole::unseen_kind; };
    add("motions_in_time", [&](std::size_t c) { return !held_out.is_static(c); });
    add("equilibria_of_trained_kinds", [&](std::size_t c) { return held_out.is_static(c) && is_trained(c); });
    add("equilibria_of_unseen_kinds", [&](std::size_t c) { return held_out.is_static(c) && !is_trained(c); });
    return parts;
}

} // namespace springfit
