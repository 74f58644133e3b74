// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace springfit {

/// How an iterative computation ended. A numerical outcome is a status in a report, never an exception.
enum class Status {
    converged,       ///< the tolerance was reached
    iteration_limit, ///< stopped at the iteration or sweep budget with the best point so far
    stalled,         ///< no further progress was possible in this precision
    interrupted,     ///< the caller's progress callback asked to stop; the best point so far is returned
    diverged,        ///< non-finite values; what is returned is the last finite point
    failed           ///< the method could not produce a point
};

[[nodiscard]] constexpr std::string_view to_string(Status status) {
    switch (status) {
    case Status::converged: return "converged";
    case Status::iteration_limit: return "iteration_limit";
    case Status::stalled: return "stalled";
    case Status::interrupted: return "interrupted";
    case Status::diverged: return "diverged";
    case Status::failed: return "failed";
    }
    return "unknown";
}

/// True where the result may be used: everything but `diverged` and `failed`.
[[nodiscard]] constexpr bool usable(Status status) {
    return status != Status::diverged && status != Status::failed;
}

} // namespace springfit
