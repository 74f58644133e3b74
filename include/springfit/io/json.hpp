// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include <springfit/io/atomic_file.hpp>
#include <springfit/io/json_value.hpp>

namespace springfit::io {

/// The whole of a file as JSON. Throws FileError with the line where it is none or is nested more than 100 deep, and
/// for a file that cannot be read. O(size).
[[nodiscard]] Json read_json(const std::filesystem::path& path);

/// Text with one line per member of an object, and arrays of numbers, however long, on one line. Numbers are the
/// shortest that read back as the same double. Members are in the order of their keys, but for `first`.
[[nodiscard]] std::string json_text(const Json& value, std::string_view first = {});

/// A place inside a JSON file: every question that it cannot answer is a FileError that names file and JSON pointer,
/// `model.json: /springs/stiffness/3: expected a number, found null`.
class JsonPlace {
public:
    JsonPlace(const Json& value, std::string file, std::string pointer = {})
        : m_value(&value), m_file(std::move(file)), m_pointer(std::move(pointer)) {}

    [[nodiscard]] const Json& value() const noexcept { return *m_value; }
    [[nodiscard]] JsonPlace member(std::string_view key) const;
    [[nodiscard]] JsonPlace element(std::size_t index) const;

    /// The length of the array that must be here; `expected_size` of 0 or more asks for that length.
    [[nodiscard]] std::size_t array_size(std::string_view expected, std::ptrdiff_t expected_size = -1) const;
    [[nodiscard]] std::string string() const;
    [[nodiscard]] double number() const;
    /// A whole number in [0, limit).
    [[nodiscard]] int index_below(std::ptrdiff_t limit) const;

    [[noreturn]] void refuse(std::string_view expected, std::string_view found) const;
    /// The value in few words: `null`, `"text"`, `an array of 3`.
    [[nodiscard]] std::string found() const;

private:
    const Json* m_value;
    std::string m_file;
    std::string m_pointer;
};

} // namespace springfit::io

#include <springfit/io/detail/json_impl.hpp>
