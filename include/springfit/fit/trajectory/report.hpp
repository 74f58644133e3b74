// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <springfit/core/status.hpp>
#include <springfit/core/types.hpp>

namespace springfit {

/// The result of an engine of trajectory matching.
struct TrajectoryReport {
    Status status = Status::failed; ///< `failed`: neither the prior nor a stiffer one could be simulated
    Values<double> theta;           ///< [n_unknowns], within the bounds; the best point that was simulated and stable
    double objective_start = 0;     ///< J at the prior; infinite where the prior could not be simulated
    double objective = 0;           ///< J at theta
    double misfit_start = 0;        ///< relative error of the training motions at the prior, likewise
    double misfit = 0;              ///< at theta
    std::vector<double> history;    ///< J after each iteration
    int iterations = 0;
    int evaluations = 0; ///< simulations of all cases
    int rejected = 0;    ///< trial points that were stepped back from: worse, singular, unstable
    double seconds = 0;
    double gradient_max = 0; ///< largest entry of the projected gradient at theta
    /// Gauss-Newton curvature of the data along each unknown, diag(J' W J) [n_unknowns].
    Values<double> curvature;
    /// curvature / (curvature + lambda), in [0, 1]: above 1/2 the data sets the value, below the prior.
    Values<double> data_share;

    /// Unknowns whose value the data sets.
    [[nodiscard]] Index n_set_by_data() const { return (data_share.array() > 0.5).count(); }
};

} // namespace springfit
