// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace springfit {

/// Seconds of wall clock since it was made.
class Stopwatch {
public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
    }

private:
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

} // namespace springfit
