// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace program {

/// From here on, until the next call, the first Ctrl-C (or SIGTERM, or the end of the terminal, SIGHUP) asks the
/// running stage to end with its best result so far; the second ends the program.
void watch_for_interrupt();

/// From here on a reader of the output that is gone, or a limit on the size of files, is an error of that one write: it
/// does not end the program with results that are not written yet.
void keep_on_writing();

/// True once Ctrl-C was pressed since then.
[[nodiscard]] bool interrupted();

} // namespace program
