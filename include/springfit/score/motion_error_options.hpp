// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/execution.hpp>

namespace springfit {

/// How a network is simulated to be compared with references.
template <std::floating_point Scalar>
struct MotionErrorOptions {
    Scalar step_fraction = Scalar(0.5); ///< explicit sub-step as a fraction of the stable step, in (0, 1)
    int max_iterations = 500;           ///< Newton iterations of a static case, >= 1
    /// A motion in time that would take more sub-steps times springs is stepped implicitly.
    double most_explicit_work = 4e9;
    int implicit_steps_per_frame = 4; ///< then, >= 1
    /// Try a case in one way alone, equilibria first, which are quick, and leave out those after one that fails: they
    /// count as 1, too, and are `interrupted`.
    bool stop_at_failure = false;
    Execution execution{}; ///< cases are independent of each other
};

} // namespace springfit
