// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fit/acceleration/detail/node_estimate.hpp>
#include <springfit/fit/acceleration/detail/reduced_solver.hpp>
#include <springfit/fit/acceleration/exact.hpp>

namespace springfit {

namespace detail {

/// Primal-dual active set on one fit problem; between its steps the point is within the bounds.
template <class Problem>
class ActiveSet {
public:
    using Unknowns = typename Problem::Unknowns;

    ActiveSet(const Problem& problem, const ExactOptions& options, Unknowns start)
        : m_problem(problem), m_options(options), m_curvature(problem.objective.curvature()),
          m_linear(problem.objective.linear()), m_theta(std::move(start)),
          m_solver(problem.objective, m_curvature, options.execution, [this] { return go_on(); }) {
        const Index n = problem.n_unknowns();
        m_side.assign(static_cast<std::size_t>(n), 0);
        m_weight = Unknowns::Zero(n);
        for (Index u = 0; u < n; ++u) {
            if (moves(u)) {
                m_scale = maximum(m_scale, std::abs(m_linear(u)) / std::sqrt(m_curvature(u)));
            }
        }
        m_scale = m_scale == 0 ? 1 : m_scale;
        refresh();
    }

    /// The best point so far, and Phi and number of steps into `report`.
    Unknowns run(AccelerationReport& report) {
        const double offset = report.objective_start - value();
        m_best = m_start_value = value();
        m_best_theta = m_theta;
        m_best_residual = m_first_residual = m_residual = residual();
        report.status = std::isnan(m_residual)              ? Status::diverged
                        : m_residual <= m_options.tolerance ? Status::converged
                                                            : Status::iteration_limit;
        if (report.status == Status::iteration_limit) {
            choose_sides();
        }
        while (report.status == Status::iteration_limit && report.iterations < m_options.max_iterations) {
            if (!go_on()) {
                report.status = Status::interrupted;
                break;
            }
            if (!solve_and_choose()) {
                report.status = Status::interrupted;
                break;
            }
            ++report.iterations;
            report.status = judge();
            report.history.push_back(std::max(offset + m_best, 0.));
        }
        report.products = m_solver.n_products();
        report.factorisations = m_solver.n_factorisations();
        return m_best_theta;
    }

private:
    static constexpr int patience = 6; ///< sets without a lower residual before the ridge begins or grows
    static constexpr int max_idle = 3; ///< solves on the same set without progress before giving up
    static constexpr double first_ridge = 1e-2;
    static constexpr double least_ridge = 1e-12;
    static constexpr double least_shrink = 0.1;

    [[nodiscard]] bool moves(Index u) const { return !m_problem.held(u) && m_curvature(u) > 0; }

    [[nodiscard]] bool go_on() {
        const double span = std::log(std::max(m_first_residual / m_options.tolerance, 2.));
        const double done = std::log(std::max(m_first_residual / std::max(m_best_residual, 1e-300), 1.)) / span;
        m_stopped = m_stopped || !springfit::go_on(m_options.progress, "exact fit", std::min(done, 1.));
        return !m_stopped;
    }

    /// The gradient of Phi itself.
    [[nodiscard]] Unknowns own_gradient() const {
        return m_ridge > 0 ? m_gradient - m_ridge * m_curvature.cwiseProduct(m_theta - m_centre) : m_gradient;
    }

    /// Phi less its constant.
    [[nodiscard]] double value() const { return 0.5 * m_theta.dot(own_gradient() - m_linear); }

    /// As `kkt_residual`.
    [[nodiscard]] double residual() const { return residual(own_gradient()); }
    /// The same of what is being minimised.
    [[nodiscard]] double working_residual() const { return residual(m_gradient); }

    [[nodiscard]] double residual(const Unknowns& gradient) const {
        double largest = 0;
        for (Index u = 0; u < m_theta.size(); ++u) {
            if (moves(u)) {
                const double moved =
                    std::clamp(m_theta(u) - gradient(u) / m_curvature(u), m_problem.lower(u), m_problem.upper(u));
                largest = maximum(largest, std::sqrt(m_curvature(u)) * std::abs(m_theta(u) - moved));
            }
        }
        return largest / m_scale;
    }

    /// The gradient anew, without what rounding has summed up.
    void refresh() {
        m_solver.multiply(m_theta, m_gradient);
        m_gradient -= m_linear;
        if (m_ridge > 0) {
            m_gradient -= m_ridge * m_curvature.cwiseProduct(m_centre);
        }
    }

    /// Moves unknowns to the bound that theta less the scaled gradient would take them beyond; the gradient follows.
    void choose_sides() {
        m_changes = 0;
        bool any = false;
        m_step.resize(m_theta.size());
        for (Index u = 0; u < m_theta.size(); ++u) {
            const double lower = m_problem.lower(u);
            const double upper = m_problem.upper(u);
            signed char side = -2;
            double to = m_theta(u);
            if (moves(u)) {
                const double moved = m_theta(u) - m_gradient(u) / m_curvature(u);
                side = static_cast<signed char>(moved <= lower ? -1 : moved >= upper ? 1 : 0);
                to = side < 0 ? lower : side > 0 ? upper : std::clamp(m_theta(u), lower, upper);
            }
            m_step(u) = to - m_theta(u);
            any = any || m_step(u) != 0;
            m_theta(u) = to;
            set_side(u, side);
        }
        if (m_changes == 0) {
            refresh();
        } else if (any) {
            m_solver.multiply(m_step, m_image);
            m_gradient += m_image;
        }
    }

    void set_side(Index u, signed char side) {
        signed char& now = m_side[static_cast<std::size_t>(u)];
        m_changes += now != side ? 1 : 0;
        now = side;
        m_weight(u) = side == 0 ? 1 / m_curvature(u) : 0.;
    }

    /// Solves for the free unknowns, loosely while the set still changes and to the end once it stays, and chooses the
    /// next set. False where the caller stops it.
    bool solve_and_choose() {
        const double final = 0.3 * m_options.tolerance * m_scale;
        const double now = m_solver.largest(m_weight, m_gradient);
        const double share = m_changes == 0 ? 0 : m_solver.direct() ? std::min(m_accuracy, 1e-4) : m_accuracy;
        if (!m_solver.solve(m_weight, std::max(final, share * now), final, m_theta, m_gradient)) {
            return false;
        }
        choose_sides();
        return true;
    }

    /// Keeps the point where it is the best so far, and says whether to go on.
    Status judge() {
        double now = residual();
        if (now <= m_options.tolerance) {
            refresh();
            now = residual();
        }
        if (std::isnan(now)) {
            return Status::diverged;
        }
        keep_better(now);
        const bool settled = m_changes == 0 && now > 0.5 * m_residual;
        m_residual = now;
        if (now <= m_options.tolerance) {
            m_best_theta = m_theta;
            return Status::converged;
        }
        m_idle = settled && m_ridge <= least_ridge ? m_idle + 1 : 0;
        if (m_idle == max_idle) {
            return Status::stalled;
        }
        const double working = working_residual();
        if (m_ridge > 0 && working <= 0.1 * now) {
            m_shrink = std::max(least_shrink, std::pow(m_shrink, 1.5));
            begin_stage(std::max(m_shrink * m_ridge, least_ridge));
            return Status::iteration_limit;
        }
        m_accuracy = working > 0.5 * m_lowest ? std::max(0.1 * m_accuracy, 1e-8) : m_accuracy;
        m_fruitless = working < m_lowest ? 0 : m_fruitless + 1;
        m_lowest = std::min(m_lowest, working);
        if (m_fruitless == patience) {
            m_theta = m_best_theta;
            m_shrink = m_ridge > 0 ? std::sqrt(m_shrink) : m_shrink;
            begin_stage(m_ridge > 0 ? m_ridge / (m_shrink * m_shrink) : first_ridge);
        }
        return Status::iteration_limit;
    }

    /// From here on Phi + ridge / 2 |theta - theta now|^2, measured by diag(H), is minimised.
    void begin_stage(double ridge) {
        m_ridge = ridge;
        m_centre = m_theta;
        m_solver.set_ridge(ridge);
        m_accuracy = 0.1;
        m_fruitless = 0;
        m_lowest = std::numeric_limits<double>::infinity();
        refresh();
        choose_sides();
    }

    void keep_better(double now) {
        const double at = value();
        const double rounding = 1e-12 * std::abs(m_best);
        const bool lower = at < m_best - rounding;
        const bool sharper = at < m_best + rounding && now < m_best_residual;
        if (at <= m_start_value && (lower || sharper)) {
            m_best = std::min(at, m_best);
            m_best_theta = m_theta;
            m_best_residual = now;
        }
    }

    const Problem& m_problem;
    const ExactOptions& m_options;
    Unknowns m_curvature, m_linear, m_theta, m_gradient, m_weight, m_step, m_image;
    std::vector<signed char> m_side; ///< -1 on the lower bound, 1 on the upper, 0 free, -2 does not move
    Index m_changes = 0;             ///< of sides, by the last choice
    double m_scale = 0;
    double m_accuracy = 0.1; ///< part of the gradient that a solve may leave
    double m_ridge = 0;
    double m_shrink = least_shrink; ///< of the ridge from stage to stage
    Unknowns m_centre;
    bool m_stopped = false;
    int m_idle = 0;
    int m_fruitless = 0;
    double m_lowest = std::numeric_limits<double>::infinity();
    double m_residual = 0, m_first_residual = 1;
    Unknowns m_best_theta;
    double m_best = 0, m_best_residual = 1, m_start_value = 0;
    ReducedSolver<decltype(Problem::objective)> m_solver;
};

} // namespace detail

template <std::same_as<AccelerationProblem> Problem>
AccelerationReport exact(const Problem& problem, const ExactOptions& options) {
    require(options.tolerance > 0 && options.tolerance < 1, "tolerance", "a value in (0, 1)", options.tolerance);
    require(options.max_iterations >= 0, "max_iterations", "a number not below 0", options.max_iterations);
    require(options.initial.size() == 0 || options.initial.size() == problem.n_unknowns(), "initial",
            text(problem.n_unknowns(), " values, one per unknown"), options.initial.size());
    require(options.initial.allFinite(), "initial", "finite values", "a value that is not finite");
    const Stopwatch watch;
    AccelerationReport report;
    const typename Problem::Unknowns start =
        options.initial.size() > 0 ? options.initial.cwiseMax(problem.lower).cwiseMin(problem.upper).eval()
                                   : problem.prior;
    report.objective_start = problem.objective.value(start);
    report.theta = detail::ActiveSet(problem, options, start).run(report);
    complete(problem, report);
    if (report.objective > report.objective_start) { // by rounding alone
        report.theta = start;
        complete(problem, report);
    }
    if (report.status == Status::converged && !(report.kkt_residual <= options.tolerance)) {
        report.status = std::isnan(report.kkt_residual) ? Status::diverged : Status::stalled;
    }
    report.seconds = watch.seconds();
    return report;
}

} // namespace springfit
