// SPDX-License-Identifier: BSD-3-Clause
#include "terminal.hpp"

#include <cstdio>

#include <unistd.h>

#include "interrupt.hpp"

namespace program {

Terminal::Terminal() : m_is_terminal(isatty(STDERR_FILENO) == 1) {}

Terminal::~Terminal() {
    end();
}

springfit::ProgressCallback Terminal::callback() {
    return [this](const springfit::Progress& progress) {
        if (progress.fraction >= 1) {
            end();
            return !interrupted();
        }
        if (progress.stage != m_stage) {
            end();
            begin(progress.stage);
        } else if (m_shown.seconds() > (m_is_terminal ? 0.1 : 10.0)) {
            show(progress.fraction);
            m_shown = {};
        }
        return !interrupted();
    };
}

void Terminal::begin(std::string_view stage) {
    if (interrupted()) {
        watch_for_interrupt(); // it ended the stage before; a further Ctrl-C ends this one
    }
    m_stage = stage;
    m_since = {};
    m_shown = {};
    if (m_is_terminal) {
        show(0);
    }
}

void Terminal::end() {
    if (m_stage.empty()) {
        return;
    }
    if (m_is_terminal) {
        std::fprintf(stderr, "\r\033[K");
    }
    std::fprintf(stderr, "%-28s %7.1f s%s\n", m_stage.c_str(), m_since.seconds(),
                 interrupted() ? "  (interrupted)" : "");
    m_stage.clear();
}

void Terminal::show(double fraction) const {
    const double left = fraction > 0 ? m_since.seconds() * (1 - fraction) / fraction : 0;
    if (!m_is_terminal) {
        std::fprintf(stderr, "%-28s %3.0f %%, %.0f s left\n", m_stage.c_str(), 100 * fraction, left);
        return;
    }
    constexpr int width = 30;
    const int full = static_cast<int>(fraction * width);
    std::string bar(static_cast<std::size_t>(full), '#');
    bar.resize(width, '.');
    std::fprintf(stderr, "\r\033[K%-28s [%s] %3.0f %%", m_stage.c_str(), bar.c_str(), 100 * fraction);
    if (fraction > 0) {
        std::fprintf(stderr, "  %.0f s left", left);
    }
    std::fflush(stderr);
}

} // namespace program
