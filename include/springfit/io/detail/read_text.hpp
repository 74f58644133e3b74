// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <springfit/io/atomic_file.hpp>

namespace springfit::io::detail {

/// The whole of a file, or of a pipe. Throws FileError where it is missing, a folder, a device, or cannot be read.
[[nodiscard]] inline std::string read_text(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) {
        throw FileError(path.empty() ? "\"\"" : path.string(), "no such file");
    }
    if (std::filesystem::is_directory(path, error)) {
        throw FileError(path.string(), "is a folder, not a file");
    }
    if (std::filesystem::is_character_file(path, error) || std::filesystem::is_block_file(path, error)) {
        throw FileError(path.string(), "is a device, not a file");
    }
    std::ifstream stream(path, std::ios::binary);
    std::string content{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (!stream) {
        throw FileError(path.string(), text("cannot be read: ", reason(errno)));
    }
    return content;
}

} // namespace springfit::io::detail
