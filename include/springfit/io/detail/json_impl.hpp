// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include <springfit/io/detail/read_text.hpp>
#include <springfit/io/json.hpp>

namespace springfit::io {

namespace detail {

[[nodiscard]] inline bool goes_on_one_line(const Json& value) {
    if (value.is_array()) {
        return std::all_of(value.begin(), value.end(), goes_on_one_line);
    }
    return !value.is_object() && !value.is_string();
}

inline void append_json(std::string& result, const Json& value, int depth, std::string_view first_key = {}) {
    const auto members = value.is_object() || (value.is_array() && !goes_on_one_line(value));
    if (!members || value.empty()) {
        result += value.dump();
        return;
    }
    const std::string indent(static_cast<std::size_t>(depth + 1) * 2, ' ');
    result += value.is_object() ? "{" : "[";
    bool is_first = true;
    const auto append_member = [&](const std::string& key, const Json& member) {
        result += is_first ? "\n" : ",\n";
        is_first = false;
        result += indent;
        if (value.is_object()) {
            result += Json(key).dump() + ": ";
        }
        append_json(result, member, depth + 1);
    };
    if (!first_key.empty()) {
        append_member(std::string(first_key), value.at(std::string(first_key)));
    }
    for (const auto& [key, member] : value.items()) {
        if (first_key.empty() || key != first_key) {
            append_member(key, member);
        }
    }
    result += "\n" + indent.substr(2) + (value.is_object() ? "}" : "]");
}

} // namespace detail

namespace detail {

/// Refuses arrays and objects that are nested deeper than any use of them: code that walks through them recurses.
inline void check_depth(const std::filesystem::path& path, std::string_view content) {
    constexpr int deepest = 100;
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < content.size(); ++i) {
        const char c = content[i];
        if (in_string) {
            i += c == '\\' ? 1 : 0;
            in_string = c != '"';
        } else if (c == '"') {
            in_string = true;
        } else if (c == ']' || c == '}') {
            --depth;
        } else if ((c == '[' || c == '{') && ++depth > deepest) {
            const auto line = 1 + std::count(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(i), '\n');
            throw FileError(path.string(), static_cast<long>(line),
                            text("arrays and objects are nested more than ", deepest, " deep"));
        }
    }
}

} // namespace detail

inline Json read_json(const std::filesystem::path& path) {
    const std::string content = detail::read_text(path);
    detail::check_depth(path, content);
    try {
        return Json::parse(content);
    } catch (const Json::parse_error& error) {
        const auto end = content.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, content.size()));
        const auto line = 1 + std::count(content.begin(), end, '\n');
        const std::string what = error.what();
        const auto cause = what.rfind("syntax error");
        throw FileError(path.string(), static_cast<long>(line),
                        text("not JSON: ", cause == std::string::npos ? what : what.substr(cause)));
    } catch (const Json::out_of_range& error) { // a number beyond the range of double
        throw FileError(path.string(), text("not usable: ", error.what()));
    }
}

inline std::string json_text(const Json& value, std::string_view first) {
    std::string result;
    detail::append_json(result, value, 0, first);
    result += '\n';
    return result;
}

inline JsonPlace JsonPlace::member(std::string_view key) const {
    if (!m_value->is_object()) {
        refuse("an object", found());
    }
    const auto member = m_value->find(std::string(key));
    const auto pointer = text(m_pointer, '/', key);
    if (member == m_value->end()) {
        throw FileError(m_file, text(pointer, ": is missing"));
    }
    return {*member, m_file, pointer};
}

inline JsonPlace JsonPlace::element(std::size_t index) const {
    return {(*m_value)[index], m_file, text(m_pointer, '/', index)};
}

inline std::size_t JsonPlace::array_size(std::string_view expected, std::ptrdiff_t expected_size) const {
    if (!m_value->is_array() || (expected_size >= 0 && m_value->size() != static_cast<std::size_t>(expected_size))) {
        refuse(expected, found());
    }
    return m_value->size();
}

inline std::string JsonPlace::string() const {
    if (!m_value->is_string()) {
        refuse("a text", found());
    }
    return m_value->get<std::string>();
}

inline double JsonPlace::number() const {
    if (!m_value->is_number()) {
        refuse("a number", found());
    }
    return m_value->get<double>();
}

inline int JsonPlace::index_below(std::ptrdiff_t limit) const {
    const bool accepted = m_value->is_number_integer() && *m_value >= 0 && *m_value < limit;
    if (!accepted) {
        refuse(text("a whole number in [0, ", limit, ")"), found());
    }
    return m_value->get<int>();
}

inline void JsonPlace::refuse(std::string_view expected, std::string_view found) const {
    throw FileError(m_file, text(m_pointer.empty() ? "/" : m_pointer, ": expected ", expected, ", found ", found));
}

inline std::string JsonPlace::found() const {
    if (m_value->is_array()) {
        return text("an array of ", m_value->size());
    }
    if (m_value->is_object()) {
        return "an object";
    }
    constexpr std::size_t longest = 60;
    std::string value = m_value->dump(-1, ' ', true); // ASCII: cut anywhere
    return value.size() <= longest ? value : value.substr(0, longest) + "...";
}

} // namespace springfit::io
