// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/execution.hpp>
#include <springfit/core/stopwatch.hpp>
#include <springfit/fit/acceleration/problem.hpp>
#include <springfit/solve/bounded_least_squares.hpp>

namespace springfit {

namespace detail {

/// Part of the curvature that is added to a block, pulling to where it is: keeps singular blocks solvable. What the
/// data determines hardly feels it, and a second solve from the first result removes what it felt.
inline constexpr double proximity = 1e-11;

/// One node term on its own.
template <class Problem>
class NodeEstimate {
public:
    using Unknowns = typename Problem::Unknowns;

    /// Writes for each unknown of the term its estimate and the weight of that.
    void solve(const Problem& problem, const NodeQuadratic::Occurrences& occurrences, Index i, double* estimate,
               double* weight) {
        const NodeQuadratic::Term term = problem.objective.term(i);
        const Index n = term.size();
        m_root.resize(n);
        m_linear.resize(n);
        m_lower.resize(n);
        m_upper.resize(n);
        m_x.resize(n);
        m_hessian.resize(n, n);
        // Scaled to a unit diagonal: x = sqrt(H_uu) theta_u. An unknown without curvature here keeps its prior.
        for (Index p = 0; p < n; ++p) {
            const int u = term.columns[static_cast<std::size_t>(p)];
            const double share = problem.objective.ridge()(u) / static_cast<double>(occurrences.of(u).size());
            const double curvature = term.entry(p, p) + share;
            const bool moves = curvature > 0 && !problem.held(u);
            m_root(p) = curvature > 0 ? std::sqrt(curvature) : 1.;
            m_x(p) = m_root(p) * problem.prior(u);
            m_lower(p) = moves ? m_root(p) * problem.lower(u) : m_x(p);
            m_upper(p) = moves ? m_root(p) * problem.upper(u) : m_x(p);
            m_linear(p) = (term.linear[p] + share * problem.objective.centre()(u)) / m_root(p);
            m_hessian(p, p) = 1 + proximity;
            for (Index q = 0; q < p; ++q) {
                m_hessian(p, q) = term.entry(p, q) / (m_root(p) * m_root(q));
                m_hessian(q, p) = m_hessian(p, q);
            }
        }
        for (int round = 0; round < 2; ++round) {
            m_target = m_linear + proximity * m_x;
            m_solver.solve(m_hessian, m_target, m_lower, m_upper, m_x);
        }
        set_weights(n, weight);
        for (Index p = 0; p < n; ++p) {
            const int u = term.columns[static_cast<std::size_t>(p)];
            estimate[p] = std::clamp(m_x(p) / m_root(p), problem.lower(u), problem.upper(u));
            weight[p] *= m_root(p) * m_root(p);
        }
    }

private:
    /// 1 / [H^-1]_pp over the unknowns that move; 0 for the others.
    void set_weights(Index n, double* weight) {
        m_moving.clear();
        for (Index p = 0; p < n; ++p) {
            weight[p] = 0;
            if (m_lower(p) < m_upper(p)) {
                m_moving.push_back(p);
            }
        }
        if (m_moving.empty()) {
            return;
        }
        const auto size = static_cast<Index>(m_moving.size());
        m_block.resize(size, size);
        for (Index q = 0; q < size; ++q) {
            for (Index p = 0; p < size; ++p) {
                m_block(p, q) = m_hessian(m_moving[static_cast<std::size_t>(p)], m_moving[static_cast<std::size_t>(q)]);
            }
        }
        const Eigen::LLT<Eigen::Ref<DenseMatrix<double>>> factor(m_block);
        if (factor.info() != Eigen::Success) {
            return;
        }
        m_inverse.setIdentity(m_block.rows(), m_block.cols());
        factor.matrixL().solveInPlace(m_inverse); // H^-1 = L^-T L^-1: its diagonal is the squared columns of L^-1
        for (std::size_t f = 0; f < m_moving.size(); ++f) {
            weight[m_moving[f]] = 1 / m_inverse.col(static_cast<Index>(f)).squaredNorm();
        }
    }

    Unknowns m_root, m_linear, m_target, m_lower, m_upper, m_x;
    DenseMatrix<double> m_hessian, m_block, m_inverse;
    std::vector<Index> m_moving;
    BoundedLeastSquares m_solver;
};

template <class Problem>
typename Problem::Unknowns one_pass_values(const Problem& problem, const Execution& execution) {
    const auto& objective = problem.objective;
    const auto occurrences = objective.occurrences();
    std::vector<double> estimates(static_cast<std::size_t>(objective.n_columns()));
    std::vector<double> weights(estimates.size());
    execution.for_chunks(objective.n_terms(), 64, [&](Index, Index begin, Index end) {
        NodeEstimate<Problem> node;
        for (Index i = begin; i < end; ++i) {
            const Index first = objective.first_column(i);
            node.solve(problem, occurrences, i, estimates.data() + first, weights.data() + first);
        }
    });
    typename Problem::Unknowns theta = problem.prior;
    for (Index u = 0; u < theta.size(); ++u) {
        double sum = 0;
        double total = 0;
        for (const auto& [term, position] : occurrences.of(u)) {
            const auto at = static_cast<std::size_t>(objective.first_column(term) + position);
            sum += weights[at] * estimates[at];
            total += weights[at];
        }
        if (total > 0 && !problem.held(u)) {
            theta(u) = std::clamp(sum / total, problem.lower(u), problem.upper(u));
        }
    }
    return theta;
}

} // namespace detail

} // namespace springfit
