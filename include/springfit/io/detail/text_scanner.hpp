// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include <springfit/core/error.hpp>

namespace springfit::io::detail {

/// Walks through a text file word by word, or through the bytes between its words; errors name file and line.
class TextScanner {
public:
    /// A word that starts with `comment` ends its line; '\0' for formats without comments.
    TextScanner(std::string file, std::string content, char comment = '\0')
        : m_file(std::move(file)), m_content(std::move(content)), m_comment(comment) {}

    [[nodiscard]] const std::string& file() const noexcept { return m_file; }

    /// The next word without taking it; empty at the end of the file.
    [[nodiscard]] std::string_view peek() {
        skip_space();
        std::size_t end = m_at;
        while (end < m_content.size() && !is_space(m_content[end])) {
            ++end;
        }
        return std::string_view(m_content).substr(m_at, end - m_at);
    }

    [[nodiscard]] std::string_view word(std::string_view expected) {
        const std::string_view found = peek();
        if (found.empty()) {
            refuse(text("expected ", expected, ", found the end of the file"));
        }
        m_at += found.size();
        return found;
    }

    /// A whole number not below 0.
    [[nodiscard]] long long count(std::string_view expected) {
        const long long value = parse<long long>(expected);
        if (value < 0) {
            refuse(text("expected ", expected, ", found ", value));
        }
        return value;
    }

    [[nodiscard]] long long whole(std::string_view expected) { return parse<long long>(expected); }

    /// A finite number.
    [[nodiscard]] double number(std::string_view expected) {
        const auto value = parse<double>(expected);
        if (!std::isfinite(value)) {
            refuse(text("expected ", expected, ", found ", value));
        }
        return value;
    }

    [[nodiscard]] bool next_is_number() {
        const std::string_view found = peek();
        return !found.empty() &&
               (found[0] == '-' || found[0] == '+' || found[0] == '.' || (found[0] >= '0' && found[0] <= '9'));
    }

    void skip_line() {
        while (m_at < m_content.size() && m_content[m_at] != '\n') {
            ++m_at;
        }
        m_at = std::min(m_at + 1, m_content.size());
    }

    /// The rest of this line.
    [[nodiscard]] std::string_view line() {
        const std::size_t begin = m_at;
        skip_line();
        return std::string_view(m_content).substr(begin, m_at - begin);
    }

    /// Goes on behind the next `mark`.
    void skip_past(std::string_view mark) {
        const auto found = m_content.find(mark, m_at);
        if (found == std::string::npos) {
            refuse(text("expected ", mark, ", found the end of the file"));
        }
        m_at = found + mark.size();
    }

    /// A value in the binary part of a file, as this machine stores it.
    template <class T>
    [[nodiscard]] T bytes() {
        if (m_content.size() - m_at < sizeof(T)) {
            refuse("the file ends within its binary part");
        }
        T value;
        std::memcpy(&value, m_content.data() + m_at, sizeof(T));
        m_at += sizeof(T);
        return value;
    }

    /// Refuses a number of things that cannot be: each takes at least one byte of what is left of the file.
    void check_size(long long n, std::string_view what) {
        if (n < 0 || static_cast<unsigned long long>(n) > m_content.size() - m_at) {
            refuse(text(n, " ", what, " announced, more than the file can hold"));
        }
    }

    [[noreturn]] void refuse(std::string_view problem) const {
        const auto end = m_content.begin() + static_cast<std::ptrdiff_t>(m_at);
        throw FileError(m_file, static_cast<long>(1 + std::count(m_content.begin(), end, '\n')), problem);
    }

private:
    static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

    void skip_space() {
        for (;;) {
            while (m_at < m_content.size() && is_space(m_content[m_at])) {
                ++m_at;
            }
            if (m_comment == '\0' || m_at >= m_content.size() || m_content[m_at] != m_comment) {
                return;
            }
            skip_line();
        }
    }

    template <class T>
    [[nodiscard]] T parse(std::string_view expected) {
        const std::string_view found = peek();
        if (found.empty()) {
            refuse(text("expected ", expected, ", found the end of the file"));
        }
        const char* begin = found.data() + (found[0] == '+' ? 1 : 0);
        T value{};
        const auto [end, error] = std::from_chars(begin, found.data() + found.size(), value);
        if (error != std::errc{} || end != found.data() + found.size()) {
            refuse(text("expected ", expected, ", found \"", found.substr(0, 40), '"'));
        }
        m_at += found.size();
        return value;
    }

    std::string m_file;
    std::string m_content;
    char m_comment;
    std::size_t m_at = 0;
};

} // namespace springfit::io::detail
