// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>

#include <springfit/core/execution.hpp>
#include <springfit/core/progress.hpp>
#include <springfit/fit/acceleration/exact.hpp>

namespace springfit {

/// The candidates to make, and the one of them to return.
enum class Method {
    automatic,     ///< all; the one with the least held-out error
    closed_form,   ///< the given networks alone; the one with the least held-out error
    trajectory,    ///< matching of motion, whatever its error
    dominant_term, ///< acceleration fit by sweeps of the dominant-term approximation, whatever its error
    exact          ///< acceleration fit by the exact solver, whatever its error
};

/// True where motion is matched, to which equilibria add.
[[nodiscard]] constexpr bool matches_motion(Method method) {
    return method == Method::automatic || method == Method::trajectory;
}

/// The damping of the springs.
enum class DampingRule {
    proportional, ///< d = beta k, beta that of the reference
    ratio,        ///< d = 2 zeta sqrt(k (m_i + m_j)) (`mass_stiffness_damping`)
    fitted        ///< as the fit finds it
};

/// Held-out errors from which on a network is not good, not fair, and not even poor. Our definition: at 0.1 a motion is
/// hard to tell from the reference beside it, at 0.25 it is like it, at 0.6 it shares its direction.
struct VerdictLimits {
    double fair = 0.1;
    double poor = 0.25;
    double unusable = 0.6;
};

/// A solver of the acceleration fit to its global minimum: `exact`, or `ipopt::exact`.
using ExactSolver = std::function<AccelerationReport(const AccelerationProblem&, const ExactOptions&)>;

/// Options of `calibrate`: what it does and how long it may take. The defaults are those of the program.
struct CalibrateOptions {
    Method method = Method::automatic;
    DampingRule damping = DampingRule::proportional;
    double zeta = 0.05; ///< of DampingRule::ratio, >= 0
    /// Damping of the slowest motion, as a part of critical, in [0, 1), of DampingRule::proportional where cases do not
    /// know theirs; none: it is found with the fit.
    std::optional<double> damping_ratio{};
    ExactSolver exact_solver{}; ///< empty: `exact`
    bool one_pass = false; ///< Method::automatic makes a candidate of the dominant-term approximation's one pass, too

    /// Number of the given network that every fit starts from and takes as its prior; none: acceleration fits the
    /// first, matching of motion the nearest to the training cases.
    std::optional<std::size_t> start{};
    /// Fits learn from every training case. Else matching of motion learns from equilibria and acceleration fits from
    /// motions in time; each from the others where there are none of its own.
    bool learn_from_all = false;

    /// Weight of the prior in matching of motion: cases are many enough to say more than a closed form does.
    double prior_weight = 1e-5;
    int horizon = 12;                 ///< frames that a window of a motion in time predicts; 0: each motion to its end
    int steps_per_frame = 0;          ///< of the integrator, where motions in time are matched; 0: so many that its own
                                      ///< error stays small beside what a good fit leaves (`detail::steps_per_frame`)
    int matching_iterations = 40;     ///< of matching of motion at most, >= 0
    double matching_tolerance = 0.02; ///< matching ends when two iterations gain less than this part, > 0
    /// Of matching of motion at most, > 0, of wall clock: the result then depends on the machine. None: no limit.
    std::optional<double> matching_seconds{};

    int scored_training_cases = 8; ///< at most, evenly spread over its equilibria, or motions where there are none,
                                   ///< >= 0: what a fit has seen says little
    double near_equal = 1.2;       ///< of networks whose errors differ by less than this factor, the one with fewer
                                   ///< springs and cells is returned, >= 1
    VerdictLimits limits{};

    Execution execution{};
    /// Called with the name of each stage; returning false ends that stage with the best so far, and the next one
    /// begins unless it would be another fit.
    ProgressCallback progress{};
};

} // namespace springfit
