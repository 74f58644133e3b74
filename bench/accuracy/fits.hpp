// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "trial.hpp"

namespace study {

/// Trajectory matching by Ipopt; nothing where it is not built in.
[[nodiscard]] std::optional<Candidate<3>> ipopt_fit(const TrajectoryProblem<3>& problem,
                                                    const SpringNetwork<3, double>& prior, int max_iterations);

/// Searches that look at values alone.
enum class Search { genetic, annealing };

/// The best that a search found within some seconds; nothing where it is not built in.
[[nodiscard]] std::optional<Candidate<3>> search_fit(Search search, const TrajectoryProblem<3>& problem,
                                                     const SpringNetwork<3, double>& prior, double seconds,
                                                     unsigned seed);

} // namespace study
