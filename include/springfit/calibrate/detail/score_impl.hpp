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

namespace detail {

/// Candidates that are tried again in every case, where they failed in one but may yet be the best.
inline constexpr std::size_t n_tried_again = 3;

/// Root mean square of the errors of the cases that a candidate came through; infinite where there are none.
inline double error_where_converged(const CaseScores& scores) {
    double sum = 0;
    double count = 0;
    for (std::size_t s = 0; s < scores.errors.size(); ++s) {
        if (scores.statuses[s] == Status::converged) {
            sum += scores.errors[s] * scores.errors[s];
            count += 1;
        }
    }
    return count > 0 ? std::sqrt(sum / count) : std::numeric_limits<double>::infinity();
}

/// Scores candidates, one part after another.
template <int Dim>
class Scorer {
public:
    Scorer(std::vector<Candidate<Dim>>& candidates, const RecordedCases<Dim, double>& cases,
           const CalibrateOptions& options)
        : m_cases(cases), m_options(options),
          m_stage(options.progress, "score on motion", 2 * candidates.size() + n_tried_again) {
        for (auto candidate = candidates.rbegin(); candidate != candidates.rend(); ++candidate) {
            m_order.push_back(&*candidate);
            m_best = std::min(m_best, candidate->held_out.error);
        }
        // Matched motion first, then the other fits: an early end leaves the best of them judged.
        std::stable_partition(m_order.begin(), m_order.end(),
                              [](const auto* candidate) { return candidate->trajectory.has_value(); });
    }

    /// On the held-out cases, until one fails: most that fail are not worth more.
    void score() {
        for (auto* candidate : m_order) {
            if (!candidate->held_out.is_scored() && !m_stage.stopped()) {
                candidate->held_out = scores_of(candidate->network, m_cases.held_out, every_held_out(), true);
                m_best = std::min(m_best, candidate->held_out.error);
            }
        }
    }

    /// In every case, with all that helps: those that failed, but went better than the best where they came through, or
    /// where none is good. A failure for want of effort does not cost a network its place.
    void try_again() {
        auto order = m_order;
        std::erase_if(order, [](const auto* candidate) {
            return candidate->held_out.n_tried() == candidate->held_out.cases.size() &&
                   candidate->held_out.n_failed() == 0;
        });
        std::stable_sort(order.begin(), order.end(), [](const auto* a, const auto* b) {
            return error_where_converged(a->held_out) < error_where_converged(b->held_out);
        });
        order.resize(std::min(order.size(), n_tried_again));
        for (auto* candidate : order) {
            const bool may_be_best =
                !(m_best < m_options.limits.fair) || error_where_converged(candidate->held_out) < m_best;
            if (may_be_best && !m_stage.stopped()) {
                const auto found = scores_of(candidate->network, m_cases.held_out, every_held_out(), false);
                candidate->held_out = m_stage.stopped() ? candidate->held_out : found;
                m_best = std::min(m_best, candidate->held_out.error);
            }
        }
    }

    /// On a sample of the training's equilibria, which matching learns from, or of its motions where there are none.
    void score_training() {
        const auto most = static_cast<std::size_t>(m_options.scored_training_cases);
        std::vector<std::size_t> numbers(m_cases.training.size());
        std::iota(numbers.begin(), numbers.end(), std::size_t(0));
        const auto is_static = [&](std::size_t c) { return m_cases.training.is_static(c); };
        if (std::any_of(numbers.begin(), numbers.end(), is_static)) {
            std::erase_if(numbers, [&](std::size_t c) { return !is_static(c); });
        }
        const std::size_t stride = most > 0 ? (numbers.size() + most - 1) / most : 0;
        std::size_t n = 0;
        for (std::size_t c = 0; stride > 0 && c < numbers.size(); c += stride) {
            numbers[n++] = numbers[c];
        }
        numbers.resize(n);
        const auto sample = m_cases.training.subset(numbers);
        for (auto* candidate : m_order) {
            if (!numbers.empty() && !candidate->training.is_scored() && !m_stage.stopped()) {
                const bool is_best = candidate->held_out.error <= m_best;
                candidate->training = scores_of(candidate->network, sample, numbers, !is_best);
            }
        }
    }

    [[nodiscard]] bool stopped() const { return m_stage.stopped(); }

private:
    [[nodiscard]] std::vector<std::size_t> every_held_out() const {
        std::vector<std::size_t> all(m_cases.held_out.size());
        std::iota(all.begin(), all.end(), std::size_t(0));
        return all;
    }

    [[nodiscard]] CaseScores scores_of(const SpringNetwork<Dim, double>& network, const CaseSet<Dim, double>& set,
                                       const std::vector<std::size_t>& numbers, bool stop_at_failure) {
        auto found = motion_error(network, set.scenarios(), set.motions, m_stage.part(m_part++),
                                  {.max_iterations = stop_at_failure ? quick_iterations : scoring_iterations,
                                   .stop_at_failure = stop_at_failure,
                                   .execution = m_options.execution});
        if (m_stage.stopped()) {
            found.error = std::numeric_limits<double>::infinity();
        }
        return CaseScores{found.error, error_of_noise(set), numbers, std::move(found.case_errors),
                          std::move(found.case_statuses)};
    }

    const RecordedCases<Dim, double>& m_cases;
    const CalibrateOptions& m_options;
    Stage m_stage;
    std::vector<Candidate<Dim>*> m_order;
    double m_best = std::numeric_limits<double>::infinity();
    std::size_t m_part = 0;
};

/// Scores candidates of a try on held-out cases, until one fails. Returns false where the callback ended it.
template <int Dim>
bool score_try(std::vector<Candidate<Dim>>& candidates, const RecordedCases<Dim, double>& cases,
               const CalibrateOptions& options) {
    Scorer<Dim> scorer(candidates, cases, options);
    scorer.score();
    return !scorer.stopped();
}

} // namespace detail

template <int Dim>
bool score(std::vector<Candidate<Dim>>& candidates, const RecordedCases<Dim, double>& cases,
           const CalibrateOptions& options) {
    require(options.scored_training_cases >= 0, "scored_training_cases", "a number not below 0",
            options.scored_training_cases);
    detail::Scorer<Dim> scorer(candidates, cases, options);
    scorer.score();
    scorer.try_again();
    scorer.score_training();
    return !scorer.stopped();
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
