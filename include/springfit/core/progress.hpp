// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string_view>

namespace springfit {

/// How far a long stage has come.
struct Progress {
    std::string_view stage; ///< what is being done, e.g. "record reference"
    double fraction = 0;    ///< done so far, in [0, 1]
};

/// Called now and then during long work; return false to stop it with the best result so far.
/// An empty callback means: run on silently.
using ProgressCallback = std::function<bool(const Progress&)>;

/// Reports to `callback` where there is one; true means go on.
[[nodiscard]] inline bool go_on(const ProgressCallback& callback, std::string_view stage, double fraction) {
    return !callback || callback(Progress{stage, fraction});
}

} // namespace springfit
