// SPDX-License-Identifier: BSD-3-Clause
#include "terminal.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <unistd.h>

#include "interrupt.hpp"

namespace program {

using Clock = std::chrono::steady_clock;

Stage::Stage(std::string name)
    : m_name(std::move(name)), m_start(Clock::now()), m_shown(m_start), m_terminal(isatty(STDERR_FILENO) == 1) {
    if (m_terminal) {
        show(0);
    }
}

Stage::~Stage() {
    if (m_terminal) {
        std::fprintf(stderr, "\r\033[K");
    }
    std::fprintf(stderr, "%-28s %7.1f s%s\n", m_name.c_str(), seconds(), interrupted() ? "  (interrupted)" : "");
}

double Stage::seconds() const { return std::chrono::duration<double>(Clock::now() - m_start).count(); }

springfit::ProgressCallback Stage::callback(int part, int parts) {
    return [this, part, parts](const springfit::Progress& progress) {
        const double fraction = (part + std::clamp(progress.fraction, 0.0, 1.0)) / parts;
        const auto now = Clock::now();
        const double since = std::chrono::duration<double>(now - m_shown).count();
        if (since > (m_terminal ? 0.1 : 10.0)) {
            show(fraction);
            m_shown = now;
        }
        return !interrupted();
    };
}

void Stage::show(double fraction) {
    m_fraction = std::max(m_fraction, fraction);
    const double left = m_fraction > 0 ? seconds() * (1 - m_fraction) / m_fraction : 0;
    if (!m_terminal) {
        std::fprintf(stderr, "%-28s %3.0f %%, %.0f s left\n", m_name.c_str(), 100 * m_fraction, left);
        return;
    }
    constexpr int width = 30;
    const int full = static_cast<int>(m_fraction * width);
    std::string bar(static_cast<std::size_t>(full), '#');
    bar.resize(width, '.');
    std::fprintf(stderr, "\r\033[K%-28s [%s] %3.0f %%", m_name.c_str(), bar.c_str(), 100 * m_fraction);
    if (m_fraction > 0) {
        std::fprintf(stderr, "  %.0f s left", left);
    }
    std::fflush(stderr);
}

} // namespace program
