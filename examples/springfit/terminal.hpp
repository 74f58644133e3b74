// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>

#include <springfit/core/progress.hpp>
#include <springfit/core/stopwatch.hpp>

namespace program {

/// Shows one stage after another on the terminal: a bar with the time left, or plain lines where the output is not a
/// terminal. Its callback also carries the user's Ctrl-C to the library: it ends the running stage, and the next one
/// goes on with what is there.
class Terminal {
public:
    Terminal();
    ~Terminal();
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    /// For what the library computes, one stage at a time.
    [[nodiscard]] springfit::ProgressCallback callback();

private:
    void begin(std::string_view stage);
    void end();
    void show(double fraction) const;

    std::string m_stage; ///< empty: none runs
    springfit::Stopwatch m_since;
    springfit::Stopwatch m_shown;
    bool m_is_terminal;
};

} // namespace program
