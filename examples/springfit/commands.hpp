// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

#include "options.hpp"

namespace program {

/// Ctrl-C came before there was anything worth writing.
class Interrupted : public std::runtime_error {
public:
    Interrupted() : std::runtime_error("interrupted") {}
};

constexpr int exit_fault = 1; ///< of the program's own
constexpr int exit_refused = 2;
constexpr int exit_poor = 3;
constexpr int exit_interrupted = 130;

/// Each returns the exit code: 0; `exit_poor` where the result is written but its verdict is poor or unusable;
/// `exit_interrupted` where Ctrl-C ended it early with the best result so far written. Throws InvalidArgument or
/// FileError for input that cannot be used; then nothing has been written.
[[nodiscard]] int run_fit(FitOptions options);
[[nodiscard]] int run_simulate(const SimulateOptions& options);

} // namespace program
