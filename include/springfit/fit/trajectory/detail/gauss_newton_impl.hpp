// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <memory>
#include <utility>

#include <Eigen/Cholesky>

#include <springfit/core/stopwatch.hpp>
#include <springfit/fit/trajectory/detail/engine.hpp>
#include <springfit/fit/trajectory/gauss_newton.hpp>
#include <springfit/solve/conjugate_gradients.hpp>

namespace springfit {

namespace detail {

inline void check(const GaussNewtonOptions& options) {
    require(options.max_iterations >= 0, "max_iterations", "a number not below 0", options.max_iterations);
    require(options.tolerance > 0, "tolerance", "a positive value", options.tolerance);
    require(options.max_cg_iterations >= 1, "max_cg_iterations", "at least one", options.max_cg_iterations);
    require(options.cg_tolerance > 0 && options.cg_tolerance < 1, "cg_tolerance", "a value in (0, 1)",
            options.cg_tolerance);
    require(options.max_step > 0, "max_step", "a positive value", options.max_step);
    require(options.probes >= 1, "probes", "at least one", options.probes);
}

/// Minimises 1/2 s'(H + mu I)s + gradient's over the unknowns that are not active, by preconditioned conjugate
/// gradients.
template <class Product>
Values<double> reduced_newton_step(const Product& product, const Values<double>& diagonal, double mu,
                                   const Values<double>& gradient, const std::vector<bool>& active, double tolerance,
                                   int max_iterations) {
    const auto reduce = [&](Values<double>& v) {
        for (Index u = 0; u < v.size(); ++u) {
            if (active[static_cast<std::size_t>(u)]) {
                v(u) = 0;
            }
        }
    };
    Values<double> right = -gradient;
    reduce(right);
    Values<double> inverse = (diagonal.array() + mu).inverse();
    reduce(inverse);
    Values<double> step;
    (void)conjugate_gradients(
        [&](const Values<double>& p, Values<double>& q) {
            q = product(p) + mu * p;
            reduce(q);
        },
        [&](const Values<double>& r, Values<double>& z) { z = inverse.cwiseProduct(r); }, right, step, tolerance,
        max_iterations);
    return step;
}

/// Shortens a step to a root mean square of a third of `most`, then each entry to `most`: a few entries of which little
/// is known do not hold up the others.
inline void limit(Values<double>& step, double most) {
    const double mean = std::sqrt(step.squaredNorm() / static_cast<double>(step.size()));
    if (3 * mean > most) {
        step *= most / (3 * mean);
    }
    step = step.cwiseMax(-most).cwiseMin(most);
}

/// Tells when iterations gain too little for a search to go on: less than a part of what is left twice running, the
/// second no more than the first. Gains that grow are those of steps that damping still shortens.
class SmallGains {
public:
    explicit SmallGains(double part) : m_part(part) {}

    /// An iteration lowered the objective by `gain` from `value`.
    void add(double gain, double value) {
        const bool is_small = gain < m_part * value;
        m_enough = is_small && m_was_small && gain <= m_last;
        m_was_small = is_small;
        m_last = gain;
    }
    [[nodiscard]] bool enough() const { return m_enough; }

private:
    double m_part;
    double m_last = 0;
    bool m_was_small = false;
    bool m_enough = false;
};

/// The Gauss-Newton matrix H = J' W J + lambda I at a point, in full or by its products, and the unknowns that a step
/// leaves as they are.
template <int Dim>
class GaussNewtonMatrix {
public:
    GaussNewtonMatrix(const GaussNewtonOptions& options, double lambda) : m_options(options), m_lambda(lambda) {}

    /// Makes the matrix at `point`. A step leaves unknowns as they are that `active` marks, and those of which nothing
    /// is known.
    void make(TrajectoryPoint<Dim>& point, std::vector<bool> active) {
        m_active = std::move(active);
        if (m_options.form == GaussNewtonForm::dense ||
            (m_options.form == GaussNewtonForm::automatic && point.has_dense())) {
            m_dense = point.dense();
            m_diagonal = m_dense.diagonal();
        } else {
            m_dense.resize(0, 0);
            m_diagonal = point.curvature(m_options.probes).array() + m_lambda;
        }
        const double least = 1e-14 * m_diagonal.maxCoeff(); // nothing says anything of what is below
        for (Index u = 0; u < m_diagonal.size(); ++u) {
            const auto at = static_cast<std::size_t>(u);
            m_active[at] = m_active[at] || !(m_diagonal(u) > least);
        }
    }

    /// An estimate of H's diagonal in matrix-free form.
    [[nodiscard]] const Values<double>& diagonal() const { return m_diagonal; }

    /// Minimises 1/2 s'(H + mu I)s + gradient's, at the point that the matrix was made at. `go_on(part)` is asked
    /// before each product; from where it says false, the step is of no meaning.
    template <class GoOn>
    [[nodiscard]] Values<double> step(TrajectoryPoint<Dim>& point, const Values<double>& gradient, double mu,
                                      const GoOn& go_on) const {
        if (m_dense.size() == 0) {
            bool goes_on = true;
            int n_products = 0;
            const auto product = [&](const Values<double>& v) -> Values<double> {
                goes_on = goes_on && go_on(static_cast<double>(n_products++) / m_options.max_cg_iterations);
                return goes_on ? point.product(v) : Values<double>::Zero(v.size()); // which ends the iterations
            };
            return reduced_newton_step(product, m_diagonal, mu, gradient, m_active, m_options.cg_tolerance,
                                       m_options.max_cg_iterations);
        }
        DenseMatrix<double> matrix = m_dense;
        Values<double> step = -gradient;
        matrix.diagonal().array() += mu;
        for (Index u = 0; u < step.size(); ++u) {
            if (m_active[static_cast<std::size_t>(u)]) {
                matrix.row(u).setZero();
                matrix.col(u).setZero();
                matrix(u, u) = 1;
                step(u) = 0;
            }
        }
        Eigen::LDLT<Eigen::Ref<DenseMatrix<double>>>(matrix).solveInPlace(step); // of the type in other solvers
        return step;
    }

private:
    const GaussNewtonOptions& m_options;
    double m_lambda;
    DenseMatrix<double> m_dense; ///< empty in matrix-free form
    Values<double> m_diagonal;
    std::vector<bool> m_active;
};

} // namespace detail

template <int Dim>
TrajectoryReport gauss_newton(const TrajectoryProblem<Dim>& problem, const GaussNewtonOptions& options) {
    detail::check(options);
    const Stopwatch watch;
    const auto& lower = problem.parameters().lower();
    const auto& upper = problem.parameters().upper();
    const double lambda = problem.options().prior_weight;

    TrajectoryReport report;
    auto point = std::make_unique<TrajectoryPoint<Dim>>(problem);
    auto trial = std::make_unique<TrajectoryPoint<Dim>>(problem);
    Values<double> gradient = Values<double>::Zero(problem.n_unknowns());
    if (!detail::move_to_given(problem, options.start, *point, gradient, report) &&
        !detail::move_to_start(problem, lower, upper, point, trial, gradient, report)) {
        return report;
    }

    double mu = 0;
    detail::SmallGains small_gains(options.tolerance);
    detail::GaussNewtonMatrix<Dim> matrix(options, lambda);
    bool fresh = true; // the matrix at `point` is still to be made
    while (true) {
        if (fresh) {
            auto active = detail::at_active_bound(point->theta(), gradient, lower, upper);
            report.gradient_max = detail::largest_projected(gradient, active);
            matrix.make(*point, std::move(active));
            fresh = false;
        }
        const bool is_done = report.gradient_max <= 1e-14 || small_gains.enough();
        if (is_done || report.iterations >= options.max_iterations) {
            report.status = is_done ? Status::converged : Status::iteration_limit;
            break;
        }
        bool goes_on = true;
        const auto ask = [&](double part) {
            goes_on = goes_on && go_on(options.progress, "trajectory",
                                       (report.iterations + part) / std::max(1, options.max_iterations));
            return goes_on;
        };
        Values<double> step = ask(0) ? matrix.step(*point, gradient, mu, ask) : Values<double>();
        if (!goes_on) {
            report.status = Status::interrupted;
            break;
        }
        detail::limit(step, options.max_step);
        const Values<double> theta = (point->theta() + step).cwiseMax(lower).cwiseMin(upper);
        Values<double> trial_gradient;
        ++report.evaluations;
        const bool accepted = step.allFinite() && trial->move_to(theta, point.get()) &&
                              trial->value() < point->value() && trial->gradient(trial_gradient);
        const double stiffest = matrix.diagonal().maxCoeff();
        if (!accepted) {
            ++report.rejected;
            if (std::abs(gradient.dot(step)) < 1e-12 * point->value()) { // no more to gain than rounding
                report.status = Status::converged;
                break;
            }
            mu = std::max(8 * mu, 0.05 * stiffest / 8);
            if (!(mu <= 1e8 * stiffest) || step.cwiseAbs().maxCoeff() < 1e-10) {
                report.status = Status::stalled;
                break;
            }
            continue;
        }
        ++report.iterations;
        small_gains.add(point->value() - trial->value(), point->value());
        mu = mu < 1e-6 * stiffest ? 0. : mu / 5;
        point.swap(trial);
        gradient.swap(trial_gradient);
        report.history.push_back(point->value());
        fresh = true;
    }
    report.theta = point->theta();
    report.objective = point->value();
    report.misfit = point->misfit();
    detail::set_curvature((matrix.diagonal().array() - lambda).cwiseMax(0.), lambda, report);
    report.seconds = watch.seconds();
    return report;
}

} // namespace springfit
