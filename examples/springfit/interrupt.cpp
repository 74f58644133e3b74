// SPDX-License-Identifier: BSD-3-Clause
#include "interrupt.hpp"

#include <csignal>

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
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
}

bool interrupted() {
    return pressed != 0;
}

} // namespace program
