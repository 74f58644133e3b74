// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include <springfit/fit/acceleration/detail/indexed_heap.hpp>
#include <springfit/fit/acceleration/detail/node_estimate.hpp>
#include <springfit/fit/acceleration/dominant_term.hpp>

namespace springfit {

namespace detail {

/// Block descent on Phi with all that it keeps up to date: theta, node terms, their gradients, and the gradient.
template <class Problem>
class BlockDescent {
public:
    using Unknowns = typename Problem::Unknowns;

    BlockDescent(const Problem& problem, Unknowns theta)
        : m_problem(problem), m_objective(problem.objective), m_occurrences(m_objective.occurrences()),
          m_theta(std::move(theta)) {
        find_blocks();
        refresh();
    }

    [[nodiscard]] const Unknowns& theta() const { return m_theta; }

    /// Recomputes from theta what the visits carry along.
    void refresh() {
        m_gradient = m_objective.ridge().cwiseProduct(m_theta - m_objective.centre());
        m_term_gradient.resize(static_cast<std::size_t>(m_objective.n_columns()));
        m_dominance.assign(m_blocks.size(), 0.);
        for (Index i = 0; i < m_objective.n_terms(); ++i) {
            const NodeQuadratic::Term term = m_objective.term(i);
            double* gradient = m_term_gradient.data() + m_objective.first_column(i);
            m_dominance[block_of(i)] += m_objective.term_gradient(i, m_theta, gradient);
            for (std::size_t p = 0; p < term.columns.size(); ++p) {
                m_gradient(term.columns[p]) += gradient[p];
            }
        }
    }

    /// Visits every block once, the one with the largest terms first; returns by how much Phi fell, >= 0.
    double sweep() {
        m_heap.fill(m_dominance);
        double fall = 0;
        while (!m_heap.empty()) {
            fall += visit(m_blocks[static_cast<std::size_t>(m_heap.pop())]);
        }
        return fall;
    }

private:
    /// The unknowns at a node, shared by all nodes that have the same ones (as tied springs make it).
    struct Block {
        std::vector<int> columns;    ///< unknowns that may move
        DenseMatrix<double> hessian; ///< of Phi over them, scaled to a unit diagonal, with the proximity
        Unknowns root;               ///< the scale: sqrt of the diagonal
    };

    [[nodiscard]] std::size_t block_of(Index term) const {
        return static_cast<std::size_t>(m_block_of_term[static_cast<std::size_t>(term)]);
    }

    void find_blocks() {
        std::map<std::vector<int>, int> known;
        m_block_of_term.resize(static_cast<std::size_t>(m_objective.n_terms()));
        for (Index i = 0; i < m_objective.n_terms(); ++i) {
            std::vector<int> columns;
            for (int u : m_objective.term(i).columns) {
                if (!m_problem.held(u)) {
                    columns.push_back(u);
                }
            }
            const auto [place, is_new] = known.try_emplace(columns, static_cast<int>(m_blocks.size()));
            m_block_of_term[static_cast<std::size_t>(i)] = place->second;
            if (is_new) {
                m_blocks.push_back({columns, {}, {}});
            }
        }
        std::vector<int> position(static_cast<std::size_t>(m_objective.n_unknowns()), -1);
        for (Block& block : m_blocks) {
            assemble(block, position);
        }
    }

    /// Sums up the part of H over the unknowns of a block. `position` is -1 all over, before and after.
    void assemble(Block& block, std::vector<int>& position) const {
        const auto n = static_cast<Index>(block.columns.size());
        for (Index p = 0; p < n; ++p) {
            position[static_cast<std::size_t>(block.columns[static_cast<std::size_t>(p)])] = static_cast<int>(p);
        }
        block.hessian.setZero(n, n);
        for (Index p = 0; p < n; ++p) {
            block.hessian(p, p) = m_objective.ridge()(block.columns[static_cast<std::size_t>(p)]);
            for (const auto& [i, at] : m_occurrences.of(block.columns[static_cast<std::size_t>(p)])) {
                const NodeQuadratic::Term term = m_objective.term(i);
                for (Index q = at; q < term.size(); ++q) {
                    const int other = position[static_cast<std::size_t>(term.columns[static_cast<std::size_t>(q)])];
                    if (other >= 0) {
                        block.hessian(other, p) += term.hessian[term.column_begin(at) + q - at];
                    }
                }
            }
        }
        // Columns ascend in terms and blocks alike, so all of that lies in the lower triangle.
        block.root = block.hessian.diagonal().cwiseSqrt();
        for (Index q = 0; q < n; ++q) {
            for (Index p = q + 1; p < n; ++p) {
                block.hessian(p, q) /= block.root(p) * block.root(q);
                block.hessian(q, p) = block.hessian(p, q);
            }
            block.hessian(q, q) = 1 + proximity;
            position[static_cast<std::size_t>(block.columns[static_cast<std::size_t>(q)])] = -1;
        }
    }

    /// Minimises Phi over one block, from where it is; returns by how much it fell, summed without cancellation.
    double visit(const Block& block) {
        const auto n = static_cast<Index>(block.columns.size());
        if (n == 0) {
            return 0;
        }
        m_step.setZero(n);
        m_linear.resize(n);
        m_lower.resize(n);
        m_upper.resize(n);
        for (Index p = 0; p < n; ++p) {
            const int u = block.columns[static_cast<std::size_t>(p)];
            m_linear(p) = -m_gradient(u) / block.root(p);
            m_lower(p) = (m_problem.lower(u) - m_theta(u)) * block.root(p);
            m_upper(p) = (m_problem.upper(u) - m_theta(u)) * block.root(p);
        }
        m_solver.solve(block.hessian, m_linear, m_lower, m_upper, m_step);
        const double fall = m_step.dot(m_linear - 0.5 * block.hessian * m_step);
        if (!(fall > 0)) {
            return 0; // nothing but rounding
        }
        m_touched.clear();
        for (Index p = 0; p < n; ++p) {
            const int u = block.columns[static_cast<std::size_t>(p)];
            const double old = m_theta(u);
            if (m_step(p) <= m_lower(p)) {
                m_theta(u) = m_problem.lower(u);
            } else if (m_step(p) >= m_upper(p)) {
                m_theta(u) = m_problem.upper(u);
            } else {
                m_theta(u) = std::clamp(old + m_step(p) / block.root(p), m_problem.lower(u), m_problem.upper(u));
            }
            if (m_theta(u) != old) {
                move(u, m_theta(u) - old);
            }
        }
        for (int touched : m_touched) {
            m_heap.update(touched, m_dominance[static_cast<std::size_t>(touched)]);
        }
        return fall;
    }

    /// Carries a change of one unknown through the node terms that it occurs in.
    void move(int u, double change) {
        m_gradient(u) += m_objective.ridge()(u) * change;
        for (const auto& [i, at] : m_occurrences.of(u)) {
            const NodeQuadratic::Term term = m_objective.term(i);
            double* gradient = m_term_gradient.data() + m_objective.first_column(i);
            m_dominance[block_of(i)] += change * (gradient[at] + 0.5 * change * term.entry(at, at));
            m_touched.push_back(static_cast<int>(block_of(i)));
            for (Index p = 0; p < term.size(); ++p) {
                const double difference = term.entry(at, p) * change;
                gradient[p] += difference;
                m_gradient(term.columns[static_cast<std::size_t>(p)]) += difference;
            }
        }
    }

    const Problem& m_problem;
    const NodeQuadratic& m_objective;
    NodeQuadratic::Occurrences m_occurrences;
    std::vector<Block> m_blocks;
    std::vector<int> m_block_of_term;

    Unknowns m_theta, m_gradient;
    std::vector<double> m_term_gradient; ///< H_i theta_i - g_i of all terms, beside their columns
    std::vector<double> m_dominance;     ///< Phi_i, summed over the nodes of each block
    IndexedHeap m_heap;
    std::vector<int> m_touched;
    Unknowns m_step, m_linear, m_lower, m_upper;
    BoundedLeastSquares m_solver;
};

template <class Problem>
typename Problem::Unknowns sweep_start(const Problem& problem, const DominantTermOptions& options) {
    require(options.initial.size() == 0 || options.initial.size() == problem.n_unknowns(), "initial",
            text(problem.n_unknowns(), " values, one per unknown"), options.initial.size());
    require(options.initial.allFinite(), "initial", "finite values", "a value that is not finite");
    const typename Problem::Unknowns given =
        options.initial.size() > 0 ? options.initial.cwiseMax(problem.lower).cwiseMin(problem.upper).eval()
                                   : problem.prior;
    if (options.start == SweepStart::given) {
        return given;
    }
    const typename Problem::Unknowns estimate = one_pass_values(problem, options.execution);
    const bool keep_given =
        !estimate.allFinite() ||
        (options.start == SweepStart::better && problem.objective.value(given) < problem.objective.value(estimate));
    return keep_given ? given : estimate;
}

} // namespace detail

template <std::same_as<AccelerationProblem> Problem>
AccelerationReport dominant_term(const Problem& problem, const DominantTermOptions& options) {
    require(options.max_sweeps >= 0, "max_sweeps", "a number not below 0", options.max_sweeps);
    require(options.tolerance >= 0, "tolerance", "a value not below 0", options.tolerance);
    const Stopwatch watch;
    AccelerationReport report;
    report.theta = detail::sweep_start(problem, options);
    report.objective_start = problem.objective.value(report.theta);
    detail::BlockDescent descent(problem, report.theta);
    double value = report.objective_start;
    double residual = kkt_residual(problem, report.theta);
    report.status = std::isnan(residual) ? Status::diverged : Status::iteration_limit;
    double lowest = residual;
    int idle = 0;               // sweeps since the residual was lowest
    constexpr int patience = 5; // of them, while Phi stands still, before giving up
    const double rounding =
        std::numeric_limits<double>::epsilon() * problem.objective.value(Problem::Unknowns::Zero(problem.n_unknowns()));
    while (report.status != Status::diverged) {
        if (residual <= options.tolerance) {
            report.status = Status::converged;
            break;
        }
        if (report.iterations == options.max_sweeps) {
            break;
        }
        const double fall = descent.sweep();
        const double next = kkt_residual(problem, descent.theta());
        if (std::isnan(next)) {
            report.status = Status::diverged;
            break;
        }
        idle = next < lowest ? 0 : idle + 1;
        lowest = std::min(lowest, next);
        if (fall <= rounding && idle == patience) {
            report.status = Status::stalled;
            break;
        }
        descent.refresh();
        ++report.iterations;
        value = std::max(value - fall, 0.);
        residual = next;
        report.theta = descent.theta();
        report.history.push_back(value);
        if (!go_on(options.progress, "dominant term", static_cast<double>(report.iterations) / options.max_sweeps)) {
            report.status = Status::interrupted;
            break;
        }
    }
    complete(problem, report);
    report.seconds = watch.seconds();
    return report;
}

} // namespace springfit
