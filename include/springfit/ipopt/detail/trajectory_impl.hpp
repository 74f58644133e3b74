// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/stopwatch.hpp>
#include <springfit/ipopt/detail/application.hpp>
#include <springfit/ipopt/detail/box_program.hpp>
#include <springfit/ipopt/trajectory.hpp>

namespace springfit::ipopt {

namespace detail {

/// J of a trajectory problem in scaled unknowns, with the best point that was looked at.
template <int Dim>
class ScaledTrajectory : public BoxScaling {
public:
    ScaledTrajectory(const TrajectoryProblem<Dim>& problem, double max_step, TrajectoryReport& report)
        : m_problem(problem), m_all_lower(problem.parameters().lower()), m_all_upper(problem.parameters().upper()),
          m_max_step(max_step), m_report(report), m_best(std::make_unique<TrajectoryPoint<Dim>>(problem)),
          m_trial(std::make_unique<TrajectoryPoint<Dim>>(problem)) {}

    /// Moves to the start and scales; false where there is none that can be simulated.
    [[nodiscard]] bool start(double lambda, int probes) {
        if (!springfit::detail::move_to_start(m_problem, m_all_lower, m_all_upper, m_best, m_trial, m_best_gradient,
                                              m_report)) {
            return false;
        }
        m_theta = m_best->theta();
        m_value = m_best->value();
        m_gradient = m_best_gradient;
        for (Index u = 0; u < m_theta.size(); ++u) {
            if (m_all_lower(u) < m_all_upper(u)) {
                moving.push_back(static_cast<int>(u));
            }
        }
        // What hardly moves anything is not scaled up further than this: its curvature is rounding.
        Values<double> curvature = m_best->curvature(probes).array() + lambda;
        curvature = curvature.cwiseMax(1e-12 * curvature.maxCoeff());
        set(curvature, m_gradient, m_all_lower, m_all_upper);
        return true;
    }

    [[nodiscard]] double value(const Values<double>& x) {
        evaluate(unscaled(x, m_all_lower, m_all_upper));
        return m_value / objective_unit;
    }

    [[nodiscard]] Values<double> gradient(const Values<double>& x) {
        evaluate(unscaled(x, m_all_lower, m_all_upper));
        return m_gradient(moving).cwiseProduct(scale) / objective_unit;
    }

    /// True where many trial points have brought nothing but rounding.
    [[nodiscard]] bool is_stuck() const { return m_idle > 100; }

    [[nodiscard]] TrajectoryPoint<Dim>& best() { return *m_best; }
    [[nodiscard]] const Values<double>& best_gradient() const { return m_best_gradient; }

private:
    void evaluate(const Values<double>& theta) {
        if (theta == m_theta) {
            return;
        }
        m_theta = theta;
        m_value = std::numeric_limits<double>::infinity();
        m_gradient = Values<double>::Constant(theta.size(), m_value);
        if (!((theta - m_best->theta()).cwiseAbs().maxCoeff() <= m_max_step)) {
            ++m_report.rejected;
            return;
        }
        ++m_report.evaluations;
        Values<double> gradient;
        if (!m_trial->move_to(theta, m_best.get()) || !m_trial->gradient(gradient)) {
            ++m_report.rejected;
            return;
        }
        m_value = m_trial->value();
        m_gradient = gradient;
        m_idle = m_value < m_best->value() * (1 - 1e-9) ? 0 : m_idle + 1;
        if (m_value < m_best->value()) {
            m_best.swap(m_trial);
            m_best_gradient.swap(gradient);
        } else {
            ++m_report.rejected;
        }
    }

    const TrajectoryProblem<Dim>& m_problem;
    const Values<double>& m_all_lower;
    const Values<double>& m_all_upper;
    double m_max_step;
    TrajectoryReport& m_report;
    std::unique_ptr<TrajectoryPoint<Dim>> m_best;
    std::unique_ptr<TrajectoryPoint<Dim>> m_trial;
    Values<double> m_best_gradient;
    Values<double> m_theta; ///< where value and gradient are known
    double m_value = 0;
    int m_idle = 0; ///< simulations since the best was bettered
    Values<double> m_gradient;
};

} // namespace detail

template <int Dim>
TrajectoryReport trajectory(const TrajectoryProblem<Dim>& problem, const TrajectoryFitOptions& options) {
    require(options.memory >= 1, "memory", "at least one", options.memory);
    require(options.max_step > 0, "max_step", "a positive value", options.max_step);
    require(options.probes >= 1, "probes", "at least one", options.probes);
    const Stopwatch watch;
    const auto application = detail::make_application(options, {{"hessian_approximation", "limited-memory"},
                                                                {"limited_memory_max_history", options.memory},
                                                                {"limited_memory_initialization", "scalar2"},
                                                                {"mu_strategy", "adaptive"}});
    const auto& lower = problem.parameters().lower();
    const auto& upper = problem.parameters().upper();
    const double lambda = problem.options().prior_weight;

    TrajectoryReport report;
    detail::ScaledTrajectory<Dim> scaled(problem, options.max_step, report);
    if (!scaled.start(lambda, options.probes)) {
        return report;
    }
    report.status = Status::converged;
    if (scaled.size() > 0) {
        using Program = detail::BoxProgram<detail::ScaledTrajectory<Dim>>;
        const Ipopt::SmartPtr<Program> program =
            new Program(scaled, scaled.best().theta()(scaled.moving).cwiseQuotient(scaled.scale), options.progress,
                        "trajectory", options.max_iterations);
        report.status = detail::status_of(application->OptimizeTNLP(Ipopt::GetRawPtr(program)));
        if (program->stuck) {
            report.status = Status::stalled;
        }
        if (program->exception) {
            std::rethrow_exception(program->exception);
        }
        report.iterations = program->iterations;
        for (std::size_t i = 1; i < program->history.size(); ++i) {
            report.history.push_back(scaled.objective_unit * program->history[i]);
        }
        if (report.status == Status::converged || report.status == Status::stalled) {
            Values<double> x = program->x;
            scaled.snap(program->lower_multipliers, program->upper_multipliers, x);
            (void)scaled.value(x);
        } else if (!usable(report.status)) { // Ipopt's last point is of no use, the best one still is
            report.status = Status::stalled;
        }
    }
    auto& best = scaled.best();
    report.theta = best.theta();
    report.objective = best.value();
    report.misfit = best.misfit();
    report.gradient_max = springfit::detail::largest_projected(
        scaled.best_gradient(), springfit::detail::at_active_bound(report.theta, scaled.best_gradient(), lower, upper));
    springfit::detail::set_curvature(best.curvature(options.probes), lambda, report);
    report.seconds = watch.seconds();
    return report;
}

} // namespace springfit::ipopt
