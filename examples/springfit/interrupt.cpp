// SPDX-License-Identifier: BSD-3-Clause
#include "interrupt.hpp"

#include <csignal>
#include <initializer_list>

namespace program {

namespace {

volatile std::sig_atomic_t pressed = 0;

void on_interrupt(int signal) {
    pressed = 1;
    std::signal(signal, SIG_DFL);
}

} // namespace

void watch_for_interrupt() {
    pressed = 0;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        if (std::signal(signal, on_interrupt) == SIG_IGN) {
            std::signal(signal, SIG_IGN); // as `nohup` and the shell's background jobs ask
        }
    }
}

void keep_on_writing() {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() {
    return pressed != 0;
}

} // namespace program
