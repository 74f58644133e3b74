// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>

#include <springfit/core/error.hpp>

namespace springfit::io::detail {

[[nodiscard]] inline std::string lower_case(std::string_view word) {
    std::string result(word);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return result;
}

/// The ending of a file's name, in lower case, with its dot.
[[nodiscard]] inline std::string lower_extension(const std::filesystem::path& path) {
    return lower_case(path.extension().string());
}

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
        throw FileError(path.string(), text("cannot be read: ", std::generic_category().message(errno)));
    }
    return content;
}

} // namespace springfit::io::detail
