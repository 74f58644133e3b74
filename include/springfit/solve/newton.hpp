// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <springfit/core/maximum.hpp>
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
    Scalar loose_tolerance = 0;     ///< the same far from the minimum, where the gradient falls slowly; 0: no looser
};

/// The outcome of a Newton minimisation.
template <std::floating_point Scalar>
struct NewtonReport {
    Status status = Status::failed;
    int iterations = 0;
    Scalar energy = 0;
    Scalar gradient_max = 0; ///< largest entry of the gradient, at the point returned
};

namespace detail {

/// The rounding error of a problem's energy at the coordinates last used; 0 where it does not say.
template <SmoothProblem P>
[[nodiscard]] typename P::Scalar energy_rounding(P& problem) {
    if constexpr (requires { problem.energy_rounding(); }) {
        return problem.energy_rounding();
    } else {
        return typename P::Scalar(0);
    }
}

/// Newton's step from x, by one linear solve, or by a second one with a semidefinite Hessian where the first meets
/// negative curvature. False where the solver fails.
template <SmoothProblem P, class Solver>
[[nodiscard]] bool newton_step(P& problem, const Values<typename P::Scalar>& x,
                               const Values<typename P::Scalar>& gradient, Solver& solver, typename P::Scalar tolerance,
                               Values<typename P::Scalar>& step) {
    if constexpr (requires { solver.turn(problem.positions(x)); }) {
        solver.turn(problem.positions(x));
    }
    const auto solve = [&] { return solver.solve(problem.hessian(x), -gradient, step, tolerance); };
    bool solved = solve();
    if constexpr (requires { problem.use_semidefinite() && solver.met_negative_curvature(); }) {
        if (solved && solver.met_negative_curvature() && problem.use_semidefinite()) {
            solved = solve();
        }
    }
    return solved;
}

/// The end of a line search.
template <std::floating_point Scalar>
struct LineSearchPoint {
    Values<Scalar> x;
    Values<Scalar> gradient;
    Scalar energy = 0;
    Scalar gradient_max = 0;
    bool falls = false; ///< the energy falls to it, by more than its rounding
};

/// Halves a step from x until the energy falls (Armijo) or, where the energy no longer resolves it, the gradient does.
/// `start` has the energy and the gradient's largest entry at x. False where no such point was found.
template <SmoothProblem P>
[[nodiscard]] bool line_search(P& problem, const Values<typename P::Scalar>& x,
                               const Values<typename P::Scalar>& gradient, const Values<typename P::Scalar>& step,
                               const NewtonReport<typename P::Scalar>& start,
                               LineSearchPoint<typename P::Scalar>& found) {
    using Scalar = typename P::Scalar;
    constexpr Scalar epsilon = std::numeric_limits<Scalar>::epsilon();
    const Scalar slope = gradient.dot(step);
    const Scalar rounding =
        std::max(energy_rounding(problem), 16 * epsilon * std::max(std::abs(start.energy), std::abs(slope)));
    Scalar length = 1;
    for (int halving = 0; halving < 40 && slope < 0; ++halving, length /= 2) {
        found.x = x + length * step;
        found.energy = problem.energy(found.x);
        if (!std::isfinite(found.energy)) {
            continue;
        }
        const bool unresolved = std::abs(found.energy - start.energy) <= rounding;
        found.falls = !unresolved && found.energy <= start.energy + Scalar(1e-4) * length * slope;
        if (!found.falls && !unresolved) {
            continue;
        }
        problem.gradient(found.x, found.gradient);
        found.gradient_max = max_norm(found.gradient);
        if (std::isfinite(found.gradient_max) && (found.falls || found.gradient_max < start.gradient_max)) {
            return true;
        }
    }
    return false;
}

} // namespace detail

/// Minimises a smooth problem from `x` by Newton's method with a backtracking line search (Armijo; where the energy no
/// longer resolves the step, the gradient must fall instead).
///
/// `solver` is a `SymmetricSolver` or a `CorotatedSolver` and keeps what it has learnt between calls. A problem with a
/// semidefinite approximation of its Hessian (`use_semidefinite()`, false where it will not) changes to it where the
/// solver meets negative curvature, one that knows where it is beyond hope (`is_lost(x)`) ends there, `diverged`. `x`
/// is the best point on return whatever the status. Stalls, rather than fails or goes on for ever, where rounding stops
/// progress above the tolerance.
template <SmoothProblem P, class Solver>
[[nodiscard]] NewtonReport<typename P::Scalar> minimise(P& problem, Values<typename P::Scalar>& x, Solver& solver,
                                                        const NewtonOptions<typename P::Scalar>& options) {
    using Scalar = typename P::Scalar;

    NewtonReport<Scalar> report;
    Values<Scalar> gradient(x.size());
    Values<Scalar> step;
    detail::LineSearchPoint<Scalar> trial;
    trial.gradient.resize(x.size());

    report.energy = problem.energy(x);
    problem.gradient(x, gradient);
    report.gradient_max = max_norm(gradient);
    if (!std::isfinite(report.energy) || !gradient.allFinite()) {
        report.status = Status::diverged;
        return report;
    }
    const Scalar loosest = std::max(options.loose_tolerance, options.linear_tolerance);
    Scalar linear_tolerance = loosest;
    int n_creeping = 0; // steps in a row within the energy's rounding that hardly lowered the gradient
    for (; report.iterations < options.max_iterations; ++report.iterations) {
        if (report.gradient_max <= options.gradient_tolerance) {
            report.status = Status::converged;
            return report;
        }
        if (!detail::newton_step(problem, x, gradient, solver, linear_tolerance, step)) {
            report.status = Status::failed;
            return report;
        }
        const bool accepted = detail::line_search(problem, x, gradient, step, report, trial);
        if (accepted) {
            n_creeping = !trial.falls && trial.gradient_max > report.gradient_max / 2 ? n_creeping + 1 : 0;
            const Scalar ratio = trial.gradient_max / report.gradient_max;
            linear_tolerance = std::clamp(ratio * ratio, options.linear_tolerance, loosest);
            report.energy = trial.energy;
            report.gradient_max = trial.gradient_max;
            x.swap(trial.x);
            gradient.swap(trial.gradient);
        }
        if constexpr (requires { problem.is_lost(x); }) {
            if (accepted && problem.is_lost(x)) {
                ++report.iterations;
                report.status = Status::diverged;
                return report;
            }
        }
        if (!accepted && linear_tolerance > options.linear_tolerance) {
            linear_tolerance = options.linear_tolerance;
            continue;
        }
        if (!accepted || n_creeping == 3) {
            report.status = report.gradient_max <= options.gradient_tolerance ? Status::converged : Status::stalled;
            report.iterations += accepted ? 1 : 0;
            return report;
        }
    }
    report.status = report.gradient_max <= options.gradient_tolerance ? Status::converged : Status::iteration_limit;
    return report;
}

} // namespace springfit
