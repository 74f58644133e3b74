// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace program {

/// From here on, until the next call, the first Ctrl-C asks the running stage to end with its best result so far; the
/// second ends the program.
void watch_for_interrupt();

/// True once Ctrl-C was pressed since then.
[[nodiscard]] bool interrupted();

} // namespace program
