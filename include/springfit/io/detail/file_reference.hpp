// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <filesystem>

namespace springfit::io::detail {

/// True for the name that a file gives another one if that lies in the same folder or below: relative, without `..`.
/// Files are read from where the user keeps them alone, whatever they name.
[[nodiscard]] inline bool stays_below(const std::filesystem::path& name) {
    return name.has_filename() && name.is_relative() && std::find(name.begin(), name.end(), "..") == name.end();
}

} // namespace springfit::io::detail
