// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/stopwatch.hpp>
#include <springfit/search/problem.hpp>
#include <springfit/search/report.hpp>

namespace springfit::search::detail {

/// The budget of a search and how its history is cut.
struct SearchLimits {
    double evaluations = 0;  ///< about as many as there will be, for the progress
    Index per_iteration = 1; ///< evaluations in one entry of the history
    double seconds = 0;
};

/// Thrown through pagmo to end its algorithm early.
struct SearchEnd {};

/// The record of a search: evaluates, keeps the best stable point, ends the search where budget or callback say so.
template <int Dim>
class SearchRecord {
public:
    SearchRecord(TrajectoryMatch<Dim> match, const SearchLimits& limits, const ProgressCallback& progress,
                 std::string_view stage)
        : m_match(std::move(match)), m_limits(limits), m_progress(progress), m_stage(stage),
          m_best(std::make_unique<TrajectoryPoint<Dim>>(m_match.problem())),
          m_trial(std::make_unique<TrajectoryPoint<Dim>>(m_match.problem())) {
        if (springfit::detail::move_to_start(m_match.problem(), m_match.lower(), m_match.upper(), m_best, m_trial,
                                             m_gradient, m_report.fit)) {
            m_report.fit.status = Status::iteration_limit;
            m_start = m_best->theta();
            m_start_value = m_best->value();
        }
        m_before = m_report.fit.evaluations;
    }

    [[nodiscard]] const TrajectoryMatch<Dim>& match() const { return m_match; }
    [[nodiscard]] bool has_start() const { return m_start.size() > 0; }
    /// The start of `gauss_newton`, in the box, and J there.
    [[nodiscard]] const Values<double>& start() const { return m_start; }
    [[nodiscard]] double start_value() const { return m_start_value; }

    /// J or the penalty. Throws SearchEnd where the search is over.
    double fitness(const pagmo::vector_double& x) {
        const double fraction =
            std::max(static_cast<double>(m_report.fit.evaluations - m_before) / m_limits.evaluations,
                     m_watch.seconds() / m_limits.seconds);
        if (m_watch.seconds() >= m_limits.seconds) {
            throw SearchEnd();
        }
        if (!go_on(m_progress, m_stage, std::min(fraction, 1.))) {
            m_report.fit.status = Status::interrupted;
            throw SearchEnd();
        }
        const double value = evaluate(Eigen::Map<const Values<double>>(x.data(), static_cast<Index>(x.size())));
        if (++m_in_iteration == m_limits.per_iteration) {
            end_iteration();
        }
        return value;
    }

    /// The report of the best point; call once, when the search is over.
    [[nodiscard]] SearchReport finish() {
        auto& fit = m_report.fit;
        if (m_in_iteration > 0) {
            end_iteration();
        }
        const auto& parameters = m_match.problem().parameters();
        if (has_start()) {
            fit.theta = m_best->theta();
            fit.objective = m_best->value();
            fit.misfit = m_best->misfit();
            fit.gradient_max = springfit::detail::largest_projected(
                m_gradient,
                springfit::detail::at_active_bound(fit.theta, m_gradient, parameters.lower(), parameters.upper()));
            springfit::detail::set_curvature(m_best->curvature(16), m_match.problem().options().prior_weight, fit);
        }
        fit.seconds = m_watch.seconds();
        return std::move(m_report);
    }

private:
    void end_iteration() {
        m_in_iteration = 0;
        ++m_report.fit.iterations;
        m_report.fit.history.push_back(m_best->value());
        m_report.seconds.push_back(m_watch.seconds());
    }

    /// A point that would be the best must have a gradient: an equilibrium without one is unstable.
    double evaluate(const Values<double>& theta) {
        ++m_report.fit.evaluations;
        Values<double> gradient;
        if (!m_match.move(*m_trial, theta) || (m_trial->value() < m_best->value() && !m_trial->gradient(gradient))) {
            ++m_report.fit.rejected;
            return TrajectoryMatch<Dim>::penalty;
        }
        const double value = m_trial->value();
        if (value < m_best->value()) {
            m_best.swap(m_trial);
            m_gradient.swap(gradient);
        }
        return value;
    }

    TrajectoryMatch<Dim> m_match;
    SearchLimits m_limits;
    const ProgressCallback& m_progress;
    std::string_view m_stage;
    Stopwatch m_watch;
    std::unique_ptr<TrajectoryPoint<Dim>> m_best; ///< of infinite value until one could be simulated
    std::unique_ptr<TrajectoryPoint<Dim>> m_trial;
    Values<double> m_gradient; ///< at the best
    Values<double> m_start;    ///< empty where there is none
    double m_start_value = 0;
    int m_before = 0; ///< evaluations that the start took
    Index m_in_iteration = 0;
    SearchReport m_report;
};

/// The problem of a search as pagmo's user-defined problem: all copies write into one record, on one thread.
template <int Dim>
class RecordedMatch {
public:
    RecordedMatch() = default;
    explicit RecordedMatch(SearchRecord<Dim>& record) : m_record(&record) {}

    [[nodiscard]] pagmo::vector_double fitness(const pagmo::vector_double& x) const { return {m_record->fitness(x)}; }
    [[nodiscard]] std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
        return m_record->match().get_bounds();
    }
    [[nodiscard]] pagmo::thread_safety get_thread_safety() const { return pagmo::thread_safety::none; }

private:
    SearchRecord<Dim>* m_record = nullptr;
};

/// A pointer to what the caller keeps alive.
template <class T>
std::shared_ptr<const T> borrowed(const T& object) {
    return {std::shared_ptr<const T>(), &object};
}

} // namespace springfit::search::detail
