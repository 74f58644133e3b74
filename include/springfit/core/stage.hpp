// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <mutex>
#include <numeric>
#include <string>
#include <vector>

#include <springfit/core/progress.hpp>
#include <springfit/core/stopwatch.hpp>

namespace springfit {

/// One stage of a long computation under a name of its own: gathers the progress of its parts, which may run at the
/// same time, reports their mean to the caller, and remembers that the caller asked to stop.
class Stage {
public:
    Stage(ProgressCallback progress, std::string name, std::size_t parts = 1)
        : m_progress(std::move(progress)), m_name(std::move(name)), m_done(std::max<std::size_t>(parts, 1), 0) {
        m_stopped = !go_on(m_progress, m_name, 0);
    }
    /// Reports the end, 1; parts alone do not.
    ~Stage() {
        try {
            (void)go_on(m_progress, m_name, 1);
        } catch (...) { // a callback that throws has thrown before
        }
    }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    /// The progress of one part, for what computes it. Returns false from when the caller asked to stop; the stage must
    /// outlive it.
    [[nodiscard]] ProgressCallback part(std::size_t number = 0) {
        return [this, number](const Progress& progress) {
            const std::scoped_lock lock(m_mutex);
            m_done.at(number) = std::max(m_done[number], std::clamp(progress.fraction, 0.0, 1.0));
            const double mean = std::accumulate(m_done.begin(), m_done.end(), 0.0) / static_cast<double>(m_done.size());
            if (!go_on(m_progress, m_name, std::min(mean, 0.999))) {
                m_stopped = true;
            }
            return !m_stopped;
        };
    }

    [[nodiscard]] const std::string& name() const { return m_name; }
    /// True once the caller asked to stop.
    [[nodiscard]] bool stopped() const { return m_stopped; }
    /// Since the stage began.
    [[nodiscard]] double seconds() const { return m_stopwatch.seconds(); }

private:
    ProgressCallback m_progress;
    std::string m_name;
    std::mutex m_mutex;
    std::vector<double> m_done; ///< of each part, in [0, 1]
    std::atomic<bool> m_stopped = false;
    Stopwatch m_stopwatch;
};

} // namespace springfit
