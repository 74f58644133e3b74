// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/status.hpp>
#include <springfit/solve/symmetric_solver.hpp>

namespace springfit {

/// A smooth function to minimise, with its derivatives; the energy may be infinite or NaN where x is not allowed.
///
/// Where the energy adds up much larger terms than itself, `energy_rounding()` tells how well it is known, in its unit.
template <class P>
concept SmoothProblem = requires(P problem, const Values<typename P::Scalar>& x, Values<typename P::Scalar>& gradient) {
    { problem.energy(x) } -> std::same_as<typename P::Scalar>;
    problem.gradient(x, gradient);
    { problem.hessian(x) } -> std::convertible_to<SymmetricMatrix<typename P::Scalar>>;
};

template <std::floating_point Scalar>
struct NewtonOptions {
    int max_iterations = 50;
    Scalar gradient_tolerance = 0;  ///< stop when the largest entry of the gradient is at most this, in its unit
    Scalar linear_tolerance = 1e-4; ///< relative residual of each linear solve, in (0, 1)
};

/// How a Newton minimisation ended.
template <std::floating_point Scalar>
struct NewtonReport {
    Status status = Status::failed;
    int iterations = 0;
    Scalar energy = 0;
    Scalar gradient_max = 0; ///< largest entry of the gradient, at the point returned
};

/// Minimises a smooth problem from `x` by Newton's method with a backtracking line search (Armijo; where the energy no
/// longer resolves the step, the gradient must fall instead).
///
/// `solver` keeps its symbolic analysis and factorisation between calls; `x` is the best point on return whatever the
/// status. Stalls, rather than fails, where rounding stops progress above the tolerance.
template <SmoothProblem P>
[[nodiscard]] NewtonReport<typename P::Scalar> minimise(P& problem, Values<typename P::Scalar>& x,
                                                        SymmetricSolver<typename P::Scalar>& solver,
                                                        const NewtonOptions<typename P::Scalar>& options) {
    using Scalar = typename P::Scalar;
    constexpr Scalar epsilon = std::numeric_limits<Scalar>::epsilon();

    NewtonReport<Scalar> report;
    Values<Scalar> gradient(x.size());
    Values<Scalar> step;
    Values<Scalar> trial;
    Values<Scalar> trial_gradient(x.size());
    Scalar noise = 0;
    if constexpr (requires { problem.energy_rounding(); }) {
        noise = problem.energy_rounding();
    }
    const auto largest = [](const Values<Scalar>& values) {
        return values.size() > 0 ? values.template lpNorm<Eigen::Infinity>() : Scalar(0);
    };

    report.energy = problem.energy(x);
    problem.gradient(x, gradient);
    report.gradient_max = largest(gradient);
    if (!std::isfinite(report.energy) || !gradient.allFinite()) {
        report.status = Status::diverged;
        return report;
    }
    for (; report.iterations < options.max_iterations; ++report.iterations) {
        if (report.gradient_max <= options.gradient_tolerance) {
            report.status = Status::converged;
            return report;
        }
        if (!solver.solve(problem.hessian(x), -gradient, step, options.linear_tolerance)) {
            report.status = Status::failed;
            return report;
        }
        const Scalar slope = gradient.dot(step);
        const Scalar rounding = std::max(noise, 16 * epsilon * std::max(std::abs(report.energy), std::abs(slope)));
        Scalar length = 1;
        bool accepted = false;
        for (int halving = 0; halving < 40 && slope < 0; ++halving, length /= 2) {
            trial = x + length * step;
            const Scalar energy = problem.energy(trial);
            if (!std::isfinite(energy)) {
                continue;
            }
            const bool falls = energy <= report.energy + Scalar(1e-4) * length * slope;
            const bool unresolved = std::abs(energy - report.energy) <= rounding;
            if (!falls && !unresolved) {
                continue;
            }
            problem.gradient(trial, trial_gradient);
            const Scalar trial_max = largest(trial_gradient);
            if (std::isfinite(trial_max) && (falls || trial_max < report.gradient_max)) {
                accepted = true;
                report.energy = energy;
                report.gradient_max = trial_max;
                x.swap(trial);
                gradient.swap(trial_gradient);
                break;
            }
        }
        if (!accepted) {
            report.status = Status::stalled;
            return report;
        }
    }
    report.status = report.gradient_max <= options.gradient_tolerance ? Status::converged : Status::iteration_limit;
    return report;
}

} // namespace springfit
