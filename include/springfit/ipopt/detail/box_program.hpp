// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <string>

#include <IpTNLP.hpp>

#include <springfit/core/progress.hpp>
#include <springfit/ipopt/detail/box_scaling.hpp>

namespace springfit::ipopt::detail {

/// A smooth function of scaled unknowns in a box. A value or gradient that is not finite says that x cannot be computed
/// and must be stepped back from. With a member `hessian`, the constant lower triangle, it is quadratic; without, Ipopt
/// approximates its Hessian from gradients, in limited memory. A member `is_stuck` may end the solve.
template <class T>
concept BoxObjective =
    std::derived_from<std::remove_const_t<T>, BoxScaling> && requires(T& objective, const Values<double>& x) {
        { objective.value(x) } -> std::same_as<double>;
        { objective.gradient(x) } -> std::convertible_to<Values<double>>;
    };

/// The objective as Ipopt sees it, and what became of it.
template <BoxObjective Objective>
class BoxProgram : public Ipopt::TNLP {
public:
    static constexpr bool has_hessian = requires(const Objective& objective) { objective.hessian; };

    BoxProgram(Objective& problem, Values<double> start, const ProgressCallback& progress, std::string stage,
               int max_iterations)
        : x(std::move(start)), m_problem(problem), m_progress(progress), m_stage(std::move(stage)),
          m_max_iterations(std::max(max_iterations, 1)) {
        m_best = x;
        m_best_value = problem.value(x);
    }

    Values<double> x;                 ///< the start; after the solve, Ipopt's last point
    Values<double> lower_multipliers; ///< of the scaled problem
    Values<double> upper_multipliers;
    std::vector<double> history; ///< scaled objective per iteration
    int iterations = 0;
    bool stuck = false;           ///< ended because `is_stuck` of the objective said so
    std::exception_ptr exception; ///< what the callback threw

    /// The point of lowest value that was looked at.
    [[nodiscard]] const Values<double>& best() const { return m_best; }

    bool get_nlp_info(Ipopt::Index& n, Ipopt::Index& m, Ipopt::Index& nnz_jac_g, Ipopt::Index& nnz_h_lag,
                      IndexStyleEnum& index_style) override {
        n = static_cast<Ipopt::Index>(m_problem.size());
        m = 0;
        nnz_jac_g = 0;
        nnz_h_lag = 0;
        if constexpr (has_hessian) {
            nnz_h_lag = static_cast<Ipopt::Index>(m_problem.hessian.nonZeros());
        }
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
        return std::isfinite(value);
    }

    bool eval_grad_f(Ipopt::Index n, const Ipopt::Number* at, bool, Ipopt::Number* gradient) override {
        const Values<double> point = map(at, n);
        map(gradient, n) = m_problem.gradient(point);
        return map(gradient, n).allFinite();
    }

    bool eval_g(Ipopt::Index, const Ipopt::Number*, bool, Ipopt::Index, Ipopt::Number*) override { return true; }
    bool eval_jac_g(Ipopt::Index, const Ipopt::Number*, bool, Ipopt::Index, Ipopt::Index, Ipopt::Index*, Ipopt::Index*,
                    Ipopt::Number*) override {
        return true;
    }

    bool eval_h(Ipopt::Index, const Ipopt::Number*, bool, Ipopt::Number factor, Ipopt::Index, const Ipopt::Number*,
                bool, Ipopt::Index, Ipopt::Index* rows, Ipopt::Index* columns, Ipopt::Number* values) override {
        if constexpr (has_hessian) {
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
        }
        return has_hessian;
    }

    bool intermediate_callback(Ipopt::AlgorithmMode, Ipopt::Index iteration, Ipopt::Number value, Ipopt::Number,
                               Ipopt::Number, Ipopt::Number, Ipopt::Number, Ipopt::Number, Ipopt::Number, Ipopt::Number,
                               Ipopt::Index, const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
        iterations = iteration;
        history.push_back(value);
        if constexpr (requires { m_problem.is_stuck(); }) {
            stuck = m_problem.is_stuck();
        }
        try {
            return !stuck &&
                   go_on(m_progress, m_stage, std::min(1., static_cast<double>(iteration) / m_max_iterations));
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

    Objective& m_problem;
    const ProgressCallback& m_progress;
    std::string m_stage;
    int m_max_iterations;
    Values<double> m_best;
    double m_best_value;
};

} // namespace springfit::ipopt::detail
