// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <vector>

#include <springfit/core/progress.hpp>

namespace program {

/// Seconds since it was made.
class Timer {
public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
    }

private:
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

/// Shows one long stage on the terminal: a bar with the time left, or plain lines where the output is not a terminal.
/// Its callback also carries the user's Ctrl-C to the library.
class Stage {
public:
    explicit Stage(std::string name);
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    /// Progress of part `part` of `parts` equal parts of this stage; the parts may run at the same time.
    [[nodiscard]] springfit::ProgressCallback callback(std::size_t part = 0, std::size_t parts = 1);

    /// Seconds since the stage began.
    [[nodiscard]] double seconds() const;

private:
    void show();

    std::string m_name;
    std::chrono::steady_clock::time_point m_start;
    std::chrono::steady_clock::time_point m_shown;
    std::mutex m_mutex;
    std::vector<double> m_done; ///< of each part
    bool m_terminal;
};

} // namespace program
