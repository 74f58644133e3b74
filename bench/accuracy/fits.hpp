// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "trial.hpp"

namespace study {

/// A network that an engine of trajectory matching found within a time.
struct TimedFit {
    double seconds = 0;
    double objective = 0;
    SpringNetwork<3, double> network;
};

/// Trajectory matching by Ipopt; nothing where it is not built in.
[[nodiscard]] std::optional<TimedFit> ipopt_fit(const SpringNetwork<3, double>& prior,
                                                const std::vector<Motion<3, double>>& training, int max_iterations,
                                                const FitSettings& fit, const Settings& settings);

/// Searches that look at values alone.
enum class Search { genetic, annealing };

/// The best that a search found within some seconds; nothing where it is not built in.
[[nodiscard]] std::optional<TimedFit> search_fit(Search search, const SpringNetwork<3, double>& prior,
                                                 const std::vector<Motion<3, double>>& training, double seconds,
                                                 const FitSettings& fit, const Settings& settings);

} // namespace study
