// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <springfit/core/error.hpp>

namespace springfit::cgal::detail {

inline std::string lower_case(std::string word) {
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
    return word;
}

inline std::string lower_extension(const std::filesystem::path& path) {
    return lower_case(path.extension().string());
}

/// Throws FileError unless the path names a file that can be opened and holds something.
inline void require_readable(const std::filesystem::path& path) {
    const std::string name = path.string();
    if (!std::filesystem::exists(path)) {
        throw FileError(name, "no such file");
    }
    if (std::filesystem::is_directory(path)) {
        throw FileError(name, "is a folder, not a file");
    }
    std::ifstream stream(path, std::ios::binary);
    if (!stream) {
        throw FileError(name, "cannot be opened for reading");
    }
    if (stream.peek() == std::ifstream::traits_type::eof()) {
        throw FileError(name, "is empty");
    }
}

/// True for `nan`, `-inf`, `Infinity`, `nan(...)` and the like, which number readers stop at without a word.
inline bool is_not_finite_word(const std::string& word) {
    const std::string bare = lower_case(word.substr(word.find_first_not_of("+-") == 1 ? 1 : 0));
    return bare == "nan" || bare == "inf" || bare == "infinity" || bare.rfind("nan(", 0) == 0 ||
           bare.find(".#in") != std::string::npos || bare.find(".#qn") != std::string::npos;
}

} // namespace springfit::cgal::detail
