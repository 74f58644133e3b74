// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include <springfit/io/detail/coordinate.hpp>
#include <springfit/io/detail/read_text.hpp>
#include <springfit/io/outline_file.hpp>

namespace springfit::io {

namespace detail {

/// A whole number of a .poly file, on the line that has begun.
[[nodiscard]] inline long long poly_whole(TextScanner& scanner, long long low, long long high, std::string_view what) {
    scanner.require_on_line(what);
    const long long value = scanner.whole(what);
    if (!(value >= low && value <= high)) {
        scanner.refuse(text("expected ", what, " in [", low, ", ", high, "], found ", value));
    }
    return value;
}

/// The number that begins a part of a .poly file: each thing that it counts takes a line.
[[nodiscard]] inline long long poly_count(TextScanner& scanner, std::string_view what) {
    (void)scanner.peek();
    const long long n = poly_whole(scanner, 0, std::numeric_limits<int>::max(), text("the number of ", what));
    scanner.check_size(n, what);
    return n;
}

[[nodiscard]] inline std::array<double, 2> poly_point(TextScanner& scanner, std::string_view what) {
    std::array<double, 2> point{};
    for (double& x : point) {
        scanner.require_on_line(text("two coordinates of ", what));
        x = text_coordinate(scanner);
    }
    scanner.skip_words_of_line(); // attributes and a marker
    return point;
}

[[nodiscard]] inline OutlineFile read_poly(TextScanner& scanner) {
    OutlineFile outline;
    (void)scanner.peek();
    const long long n_points = poly_whole(scanner, 0, std::numeric_limits<int>::max(), "the number of vertices");
    (void)poly_whole(scanner, 2, 2, "the dimension");
    scanner.check_size(n_points, "vertices");
    if (n_points == 0) {
        scanner.refuse("no vertices here (a separate .node file is not read)");
    }
    scanner.skip_words_of_line();
    long long first = 0;
    for (long long i = 0; i < n_points; ++i) {
        (void)scanner.peek(); // on to the next line
        first = i == 0 ? poly_whole(scanner, 0, 1, "the first vertex' number") : first;
        if (i > 0) {
            (void)poly_whole(scanner, first + i, first + i, "the vertex' number");
        }
        outline.points.push_back(poly_point(scanner, "a vertex"));
    }
    const long long n_segments = poly_count(scanner, "segments");
    scanner.skip_words_of_line();
    for (long long s = 0; s < n_segments; ++s) {
        (void)scanner.peek();
        scanner.require_on_line("a segment");
        (void)scanner.whole("the number of a segment");
        std::array<int, 2> ends{};
        for (int& end : ends) {
            end = static_cast<int>(poly_whole(scanner, first, first + n_points - 1, "a vertex' number") - first);
        }
        outline.segments.push_back(ends);
        scanner.skip_words_of_line();
    }
    const long long n_holes = poly_count(scanner, "holes");
    scanner.skip_words_of_line();
    for (long long h = 0; h < n_holes; ++h) {
        (void)scanner.peek();
        scanner.require_on_line("a point in a hole");
        (void)scanner.whole("the number of a hole");
        outline.holes.push_back(poly_point(scanner, "a point in a hole"));
    }
    return outline;
}

/// Reads well-known text.
class WktReader {
public:
    explicit WktReader(TextScanner& scanner) : m_scanner(scanner) {}

    [[nodiscard]] OutlineFile read() {
        while (!m_scanner.peek().empty()) {
            const std::string word(m_scanner.word(""));
            const std::string keyword = lower_case(word);
            if (keyword != "polygon" && keyword != "multipolygon") {
                m_scanner.refuse(text("expected POLYGON or MULTIPOLYGON, found ", word.substr(0, 40)));
            }
            if (lower_case(m_scanner.peek()) == "empty") {
                (void)m_scanner.word("");
            } else if (keyword == "polygon") {
                read_area();
            } else {
                read_list([&] { read_area(); });
            }
        }
        return std::move(m_outline);
    }

private:
    /// What stands between brackets, with commas in between.
    template <class ReadOne>
    void read_list(const ReadOne& read_one) {
        take("(");
        read_one();
        while (m_scanner.peek() == ",") {
            take(",");
            read_one();
        }
        take(")");
    }

    void take(std::string_view mark) {
        const std::string_view found = m_scanner.peek();
        if (found != mark) {
            m_scanner.refuse(text("expected ", mark, ", found ",
                                  found.empty() ? "the end of the file" : text('"', found.substr(0, 40), '"')));
        }
        (void)m_scanner.word(mark);
    }

    void read_area() {
        OutlineFile::Area area;
        read_list([&] { area.push_back(read_ring(area.size())); });
        m_outline.areas.push_back(std::move(area));
    }

    [[nodiscard]] std::vector<int> read_ring(std::size_t number) {
        std::vector<std::array<double, 2>> points;
        read_list([&] {
            const double x = text_coordinate(m_scanner);
            points.push_back({x, text_coordinate(m_scanner)});
        });
        if (points.front() != points.back()) {
            m_scanner.refuse(text(number == 0 ? "the outer ring" : text("hole ", number), " is open: it starts at (",
                                  points.front()[0], ' ', points.front()[1], ") and ends at (", points.back()[0], ' ',
                                  points.back()[1], ')'));
        }
        points.pop_back();
        std::vector<int> ring;
        const int first = static_cast<int>(m_outline.points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const int n = first + static_cast<int>(i);
            ring.push_back(n);
            m_outline.points.push_back(points[i]);
            m_outline.segments.push_back({n, i + 1 < points.size() ? n + 1 : first});
        }
        return ring;
    }

    TextScanner& m_scanner;
    OutlineFile m_outline;
};

} // namespace detail

inline OutlineFile read_outline_file(const std::filesystem::path& path) {
    const std::string name = path.string();
    const std::string ending = detail::lower_extension(path);
    if (ending != ".poly" && ending != ".wkt") {
        throw FileError(name, "unknown kind of outline file '" + ending + "'; .poly and .wkt are read");
    }
    std::string content = detail::read_text(path);
    if (content.empty()) {
        throw FileError(name, "is empty");
    }
    OutlineFile outline;
    if (ending == ".poly") {
        detail::TextScanner scanner(name, std::move(content), {.comment = '#'});
        outline = detail::read_poly(scanner);
    } else {
        detail::TextScanner scanner(name, std::move(content), {.marks = "(),"});
        outline = detail::WktReader(scanner).read();
    }
    if (outline.segments.empty()) {
        throw FileError(name, "empty outline: no segments");
    }
    outline.file = name;
    return outline;
}

} // namespace springfit::io
