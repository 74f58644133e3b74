// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace springfit {

/// The caller's input cannot be used. The message names the thing, what was expected and what was found:
/// `poisson: expected a value in (-1, 0.5), found 0.5`.
class InvalidArgument : public std::invalid_argument {
public:
    InvalidArgument(std::string_view argument, std::string_view expected, std::string_view found)
        : std::invalid_argument(std::string(argument) + ": expected " + std::string(expected) + ", found " +
                                std::string(found)),
          m_argument(argument) {}

    /// Name of the argument, option or file that was refused.
    [[nodiscard]] const std::string& argument() const noexcept { return m_argument; }

private:
    std::string m_argument;
};

/// A file cannot be read or written. The message names the file, with the line where there is one.
class FileError : public std::runtime_error {
public:
    FileError(std::string_view file, std::string_view problem)
        : std::runtime_error(std::string(file) + ": " + std::string(problem)), m_file(file) {}

    FileError(std::string_view file, long line, std::string_view problem)
        : FileError(std::string(file) + ":" + std::to_string(line), problem) {}

    /// The file as the caller named it, with `:line` appended where the line is known.
    [[nodiscard]] const std::string& file() const noexcept { return m_file; }

private:
    std::string m_file;
};

/// Text of any printable values, joined, for the `found` part of a message: `text("node ", 3)`.
template <class... Parts>
[[nodiscard]] std::string text(const Parts&... parts) {
    std::ostringstream stream;
    (stream << ... << parts);
    return stream.str();
}

/// Throws InvalidArgument unless `accepted`. Write the condition in accept form, `x > 0`, so that NaN is refused.
template <class Found>
void require(bool accepted, std::string_view argument, std::string_view expected, const Found& found) {
    if (!accepted) {
        throw InvalidArgument(argument, expected, text(found));
    }
}

} // namespace springfit
