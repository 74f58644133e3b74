// SPDX-License-Identifier: BSD-3-Clause
#include "terminal.hpp"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <utility>

#include <unistd.h>

#include "interrupt.hpp"

namespace program {

using Clock = std::chrono::steady_clock;

Stage::Stage(std::string name)
    : m_name(std::move(name)), m_start(Clock::now()), m_shown(m_start), m_terminal(isatty(STDERR_FILENO) == 1) {
    if (m_terminal) {
        show();
    }
}

Stage::~Stage() {
    if (m_terminal) {
        std::fprintf(stderr, "\r\033[K");
    }
    std::fprintf(stderr, "%-28s %7.1f s%s\n", m_name.c_str(), seconds(), interrupted() ? "  (interrupted)" : "");
}

double Stage::seconds() const {
    return std::chrono::duration<double>(Clock::now() - m_start).count();
}

springfit::ProgressCallback Stage::callback(std::size_t part, std::size_t parts) {
    m_done.resize(parts, 0);
    return [this, part](const springfit::Progress& progress) {
        const std::scoped_lock lock(m_mutex);
        m_done[part] = std::max(m_done[part], std::clamp(progress.fraction, 0.0, 1.0));
        const auto now = Clock::now();
        const double since = std::chrono::duration<double>(now - m_shown).count();
        if (since > (m_terminal ? 0.1 : 10.0)) {
            show();
            m_shown = now;
        }
        return !interrupted();
    };
}

void Stage::show() {
    const double done = m_done.empty() ? 0 : std::accumulate(m_done.begin(), m_done.end(), 0.0) / double(m_done.size());
    const double left = done > 0 ? seconds() * (1 - done) / done : 0;
    if (!m_terminal) {
        std::fprintf(stderr, "%-28s %3.0f %%, %.0f s left\n", m_name.c_str(), 100 * done, left);
        return;
    }
    constexpr int width = 30;
    const int full = static_cast<int>(done * width);
    std::string bar(static_cast<std::size_t>(full), '#');
    bar.resize(width, '.');
    std::fprintf(stderr, "\r\033[K%-28s [%s] %3.0f %%", m_name.c_str(), bar.c_str(), 100 * done);
    if (done > 0) {
        std::fprintf(stderr, "  %.0f s left", left);
    }
    std::fflush(stderr);
}

} // namespace program
