// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fit/trajectory/gauss_newton.hpp>

namespace springfit::search {

/// The result of a search, and its times. `fit.history` is the best J so far after each iteration; `fit.rejected`
/// counts points that could not be simulated or were unstable.
struct SearchReport {
    TrajectoryReport fit;
    std::vector<double> seconds; ///< since the start, of each entry of `fit.history`
};

} // namespace springfit::search
