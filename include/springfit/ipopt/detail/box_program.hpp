// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>

#include <springfit/core/progress.hpp>
#include <springfit/fit/problem.hpp>

namespace springfit::ipopt::detail {

/// The unknowns that may move, scaled: theta_u = scale_u x_u, such that the Hessian in x has a unit diagonal and the
/// largest gradient at theta = 0 is 1.
struct ScaledProblem {
    std::vector<int> moving;    ///< unknowns that are not held
    Values<double> scale;       ///< theta_u per unit of x
    double objective_unit = 1;  ///< Phi per unit of the scaled objective
    SparseMatrix<double> hessian; ///< lower triangle, unit diagonal
    Values<double> linear;      ///< gradient = H x - linear
    Values<double> lower, upper;

    explicit ScaledProblem(const FitProblem& problem) {
        const Index n = problem.n_unknowns();
        std::vector<int> number(static_cast<std::size_t>(n), -1);
        Values<double> at_held = problem.prior;
        for (Index u = 0; u < n; ++u) {
            at_held(u) = problem.lower(u);
            if (!problem.held(u)) {
                number[static_cast<std::size_t>(u)] = static_cast<int>(moving.size());
                moving.push_back(static_cast<int>(u));
                at_held(u) = 0;
            }
        }
        const Values<double> curvature = problem.objective.curvature()(moving);
        const Values<double> pull = -problem.objective.gradient(at_held)(moving);
        // A curvature of 0 has no slope either: such an unknown stays where it starts, whatever its scale.
        const Values<double> root = (curvature.array() > 0).select(curvature.array().sqrt(), 1.);
        const double largest = moving.empty() ? 0. : pull.cwiseQuotient(root).cwiseAbs().maxCoeff();
        const double size = largest > 0 ? largest : 1.;
        scale = size * root.cwiseInverse();
        objective_unit = size * size;
        linear = pull.cwiseQuotient(root) / size;
        lower = problem.lower(moving).cwiseQuotient(scale);
        upper = problem.upper(moving).cwiseQuotient(scale);

        std::vector<Eigen::Triplet<double>> entries;
        const SparseMatrix<double> full = problem.objective.hessian();
        for (int column = 0; column < full.outerSize(); ++column) {
            const int q = number[static_cast<std::size_t>(column)];
            for (SparseMatrix<double>::InnerIterator entry(full, column); q >= 0 && entry; ++entry) {
                const int p = number[static_cast<std::size_t>(entry.row())];
                if (p >= 0) {
                    entries.emplace_back(p, q, entry.value() / (root(p) * root(q)));
                }
            }
        }
        hessian.resize(static_cast<Index>(moving.size()), static_cast<Index>(moving.size()));
        hessian.setFromTriplets(entries.begin(), entries.end());
    }

    [[nodiscard]] Index size() const { return static_cast<Index>(moving.size()); }

    /// 1/2 x'Hx - linear'x.
    [[nodiscard]] double value(const Values<double>& x) const {
        const Values<double> product = hessian.selfadjointView<Eigen::Lower>() * x;
        return x.dot(0.5 * product - linear);
    }
    [[nodiscard]] Values<double> gradient(const Values<double>& x) const {
        return hessian.selfadjointView<Eigen::Lower>() * x - linear;
    }
};

/// The scaled problem as Ipopt sees it, and what became of it.
class BoxProgram : public Ipopt::TNLP {
public:
    BoxProgram(const ScaledProblem& problem, Values<double> start, const ProgressCallback& progress,
               int max_iterations)
        : x(std::move(start)), m_problem(problem), m_progress(progress), m_max_iterations(max_iterations) {
        m_best = x;
        m_best_value = problem.value(x);
    }

    Values<double> x;                 ///< the start; after the solve, Ipopt's last point
    Values<double> lower_multipliers; ///< of the scaled problem
    Values<double> upper_multipliers;
    std::vector<double> history;      ///< scaled objective per iteration
    int iterations = 0;
    std::exception_ptr exception;     ///< what the callback threw

    /// The point of lowest value that was looked at.
    [[nodiscard]] const Values<double>& best() const { return m_best; }

    bool get_nlp_info(Ipopt::Index& n, Ipopt::Index& m, Ipopt::Index& nnz_jac_g, Ipopt::Index& nnz_h_lag,
                      IndexStyleEnum& index_style) override {
        n = static_cast<Ipopt::Index>(m_problem.size());
        m = 0;
        nnz_jac_g = 0;
        nnz_h_lag = static_cast<Ipopt::Index>(m_problem.hessian.nonZeros());
        index_style = C_STYLE;
        return true;
    }

    bool get_bounds_info(Ipopt::Index n, Ipopt::Number* lower, Ipopt::Number* upper, Ipopt::Index, Ipopt::Number*,
                         Ipopt::Number*) override {
        map(lower, n) = m_problem.lower.cwiseMax(-infinite);
        map(upper, n) = m_problem.upper.cwiseMin(infinite);
        return true;
    }

    bool get_starting_point(Ipopt::Index n, bool, Ipopt::Number* start, bool, Ipopt::Number*, Ipopt::Number*,
                            Ipopt::Index, bool, Ipopt::Number*) override {
        map(start, n) = x;
        return true;
    }

    bool eval_f(Ipopt::Index n, const Ipopt::Number* at, bool, Ipopt::Number& value) override {
        const Values<double> point = map(at, n);
        value = m_problem.value(point);
        if (value < m_best_value) {
            m_best = point;
            m_best_value = value;
        }
        return true;
    }

    bool eval_grad_f(Ipopt::Index n, const Ipopt::Number* at, bool, Ipopt::Number* gradient) override {
        map(gradient, n) = m_problem.gradient(map(at, n));
        return true;
    }

    bool eval_g(Ipopt::Index, const Ipopt::Number*, bool, Ipopt::Index, Ipopt::Number*) override { return true; }
    bool eval_jac_g(Ipopt::Index, const Ipopt::Number*, bool, Ipopt::Index, Ipopt::Index, Ipopt::Index*, Ipopt::Index*,
                    Ipopt::Number*) override {
        return true;
    }

    bool eval_h(Ipopt::Index, const Ipopt::Number*, bool, Ipopt::Number factor, Ipopt::Index, const Ipopt::Number*,
                bool, Ipopt::Index, Ipopt::Index* rows, Ipopt::Index* columns, Ipopt::Number* values) override {
        Index at = 0;
        for (int column = 0; column < m_problem.hessian.outerSize(); ++column) {
            for (SparseMatrix<double>::InnerIterator entry(m_problem.hessian, column); entry; ++entry, ++at) {
                if (values == nullptr) {
                    rows[at] = entry.row();
                    columns[at] = column;
                } else {
                    values[at] = factor * entry.value();
                }
            }
        }
        return true;
    }

    bool intermediate_callback(Ipopt::AlgorithmMode, Ipopt::Index iteration, Ipopt::Number value, Ipopt::Number,
                               Ipopt::Number, Ipopt::Number, Ipopt::Number, Ipopt::Number, Ipopt::Number,
                               Ipopt::Number, Ipopt::Index, const Ipopt::IpoptData*,
                               Ipopt::IpoptCalculatedQuantities*) override {
        iterations = iteration;
        history.push_back(value);
        try {
            return go_on(m_progress, "exact fit", std::min(1., static_cast<double>(iteration) / m_max_iterations));
        } catch (...) {
            exception = std::current_exception();
            return false;
        }
    }

    void finalize_solution(Ipopt::SolverReturn, Ipopt::Index n, const Ipopt::Number* at, const Ipopt::Number* z_lower,
                           const Ipopt::Number* z_upper, Ipopt::Index, const Ipopt::Number*, const Ipopt::Number*,
                           Ipopt::Number, const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
        x = map(at, n);
        lower_multipliers = map(z_lower, n);
        upper_multipliers = map(z_upper, n);
    }

private:
    static constexpr double infinite = 2e19; ///< no bound, in Ipopt's terms

    static Eigen::Map<Values<double>> map(Ipopt::Number* values, Index n) { return {values, n}; }
    static Eigen::Map<const Values<double>> map(const Ipopt::Number* values, Index n) { return {values, n}; }

    const ScaledProblem& m_problem;
    const ProgressCallback& m_progress;
    int m_max_iterations;
    Values<double> m_best;
    double m_best_value;
};

} // namespace springfit::ipopt::detail
