// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include <springfit/core/error.hpp>

namespace springfit::io::detail {

/// What a format has beside words between blanks.
struct TextSyntax {
    char comment = '\0';      ///< a word that starts with it ends its line
    char continuation = '\0'; ///< a line that ends in it goes on in the next one
    std::string_view marks{}; ///< characters that are words of their own
};

/// Walks through a text file word by word, or through the bytes between its words; errors name file and line.
class TextScanner {
public:
    TextScanner(std::string file, std::string content, const TextSyntax& syntax = {})
        : m_file(std::move(file)), m_content(std::move(content)), m_syntax(syntax) {
        constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
        m_at = m_content.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
    }

    [[nodiscard]] const std::string& file() const noexcept { return m_file; }
    /// Bytes of the file that come before what is next.
    [[nodiscard]] std::size_t position() const noexcept { return m_at; }

    /// The next word without taking it; empty at the end of the file.
    [[nodiscard]] std::string_view peek() {
        while (at_line_end() && m_at < m_content.size()) {
            ++m_at;
        }
        std::size_t end = m_at;
        while (end < m_content.size() && !is_space(m_content[end]) && continuation(end) == 0 &&
               !(end > m_at && (is_mark(m_content[end]) || is_mark(m_content[m_at])))) {
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

    /// True where nothing but blanks and a comment is left of the line, which are skipped.
    [[nodiscard]] bool at_line_end() {
        for (; m_at < m_content.size(); ++m_at) {
            if (const std::size_t length = continuation(m_at); length > 0) {
                m_at += length - 1;
            } else if (m_content[m_at] == '\n') {
                return true;
            } else if (m_syntax.comment != '\0' && m_content[m_at] == m_syntax.comment) {
                m_at = std::min(m_content.find('\n', m_at), m_content.size());
                return true;
            } else if (!is_space(m_content[m_at])) {
                return false;
            }
        }
        return true;
    }

    /// Refuses a line that ends here.
    void require_on_line(std::string_view expected) {
        if (at_line_end()) {
            refuse(text("expected ", expected, ", found the end of the ", m_at < m_content.size() ? "line" : "file"));
        }
    }

    /// Takes words up to the end of the line.
    void skip_words_of_line() {
        while (!at_line_end()) {
            (void)word("");
        }
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

    /// A number, or one of the words that stand for those that are not finite.
    [[nodiscard]] double any_number(std::string_view expected) { return parse<double>(expected); }

    /// A finite number.
    [[nodiscard]] double number(std::string_view expected) {
        const auto value = any_number(expected);
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

    /// All that is left of the file.
    [[nodiscard]] std::string_view rest() const { return std::string_view(m_content).substr(m_at); }

    /// Goes on behind the next `mark`.
    void skip_past(std::string_view mark) {
        const auto found = m_content.find(mark, m_at);
        if (found == std::string::npos) {
            refuse(text("expected ", mark, ", found the end of the file"));
        }
        m_at = found + mark.size();
    }

    /// A value in the binary part of a file.
    template <class T>
    [[nodiscard]] T bytes(std::endian order = std::endian::native) {
        if (m_content.size() - m_at < sizeof(T)) {
            refuse("the file ends within its binary part");
        }
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), m_content.data() + m_at, sizeof(T));
        if (order != std::endian::native) {
            std::reverse(raw.begin(), raw.end());
        }
        m_at += sizeof(T);
        return std::bit_cast<T>(raw);
    }

    void skip_bytes(std::size_t n) { m_at = std::min(m_at + n, m_content.size()); }

    /// From here on errors name the byte in place of the line.
    void begin_binary() { m_is_binary = true; }

    /// Refuses a number of things that cannot be: each takes at least one byte of what is left of the file.
    void check_size(long long n, std::string_view what) {
        if (n < 0 || static_cast<unsigned long long>(n) > m_content.size() - m_at) {
            refuse(text(n, " ", what, " announced, more than the file can hold"));
        }
    }

    [[noreturn]] void refuse(std::string_view problem) const { refuse_at(m_at, problem); }

    [[noreturn]] void refuse_at(std::size_t position, std::string_view problem) const {
        if (m_is_binary) {
            throw FileError(m_file, text("at byte ", position, ": ", problem));
        }
        const auto end = m_content.begin() + static_cast<std::ptrdiff_t>(position);
        throw FileError(m_file, static_cast<long>(1 + std::count(m_content.begin(), end, '\n')), problem);
    }

private:
    static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

    [[nodiscard]] bool is_mark(char c) const { return m_syntax.marks.find(c) != std::string_view::npos; }

    /// Length of what is here and joins this line to the next; 0 where nothing does.
    [[nodiscard]] std::size_t continuation(std::size_t at) const {
        if (m_syntax.continuation == '\0' || m_content[at] != m_syntax.continuation) {
            return 0;
        }
        const std::string_view behind = std::string_view(m_content).substr(at + 1, 2);
        return behind.starts_with('\n') ? 2 : behind == "\r\n" ? 3 : 0;
    }

    template <class T>
    [[nodiscard]] T parse(std::string_view expected) {
        const std::string_view found = peek();
        if (found.empty()) {
            refuse(text("expected ", expected, ", found the end of the file"));
        }
        const char* begin = found.data() + (found[0] == '+' && !found.substr(1).starts_with('-') ? 1 : 0);
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
    TextSyntax m_syntax;
    std::size_t m_at = 0;
    bool m_is_binary = false;
};

} // namespace springfit::io::detail
