// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>

#include <boost/geometry/geometries/multi_polygon.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/geometry/io/wkt/read.hpp>

#include <springfit/cgal/detail/text_file.hpp>
#include <springfit/core/types.hpp>

namespace springfit::cgal::detail {

/// Points and segments as a file gives them, with a point in each hole (.poly) or the areas themselves (.wkt).
struct OutlineFile {
    using Point = boost::geometry::model::d2::point_xy<double>;
    using Polygon = boost::geometry::model::polygon<Point>;

    std::vector<std::array<double, 2>> points;
    std::vector<std::array<int, 2>> segments;
    std::vector<std::array<double, 2>> holes;
    std::vector<Polygon> areas;
};

/// The lines of a .poly file that hold something, one after another, as numbers.
class NumberLines {
public:
    explicit NumberLines(const std::filesystem::path& path) : m_name(path.string()), m_stream(path) {}

    /// The numbers of the next line that is neither empty nor a comment; at least `count` of them.
    [[nodiscard]] std::vector<double> next(std::size_t count, std::string_view what) {
        std::string line;
        while (std::getline(m_stream, line)) {
            ++m_line;
            std::istringstream words(line.substr(0, line.find('#')));
            std::vector<double> numbers;
            for (std::string word; words >> word;) {
                numbers.push_back(number(word));
            }
            if (!numbers.empty()) {
                if (numbers.size() < count) {
                    fail(text("expected ", what, ", ", count, " numbers, found ", numbers.size()));
                }
                return numbers;
            }
        }
        throw FileError(m_name, m_line, text("ends where ", what, " should be"));
    }

    /// A number that counts or names something.
    [[nodiscard]] int whole(double value, double low, double high, std::string_view what) const {
        if (!(value >= low && value <= high && value == std::floor(value))) {
            fail(text("expected ", what, " in [", low, ", ", high, "], found ", value));
        }
        return static_cast<int>(value);
    }

    [[noreturn]] void fail(std::string_view problem) const { throw FileError(m_name, m_line, problem); }

private:
    [[nodiscard]] double number(const std::string& word) const {
        std::istringstream stream(word);
        double value = 0;
        if (is_not_finite_word(word)) {
            fail("a coordinate is not finite: " + word);
        }
        if (!(stream >> value) || !stream.eof()) {
            fail("not a number: " + word);
        }
        return value;
    }

    std::string m_name;
    std::ifstream m_stream;
    long m_line = 0;
};

/// Reads Triangle's .poly format: vertices, segments, a point in each hole; numbered from 0 or 1.
inline OutlineFile read_poly(const std::filesystem::path& path) {
    constexpr double most = 1e9;
    NumberLines lines(path);
    OutlineFile outline;
    const auto header = lines.next(2, "the number of vertices and the dimension");
    const int n_points = lines.whole(header[0], 0, most, "the number of vertices");
    if (n_points == 0) {
        lines.fail("no vertices here (a separate .node file is not read)");
    }
    (void)lines.whole(header[1], 2, 2, "the dimension");
    int first = 0;
    for (int i = 0; i < n_points; ++i) {
        const auto vertex = lines.next(3, "a vertex");
        first = i == 0 ? lines.whole(vertex[0], 0, 1, "the first vertex' number") : first;
        (void)lines.whole(vertex[0], first + i, first + i, "the vertex' number");
        outline.points.push_back({vertex[1], vertex[2]});
    }
    const int n_segments = lines.whole(lines.next(1, "the number of segments")[0], 0, most, "the number of segments");
    for (int s = 0; s < n_segments; ++s) {
        const auto segment = lines.next(3, "a segment");
        const auto end = [&](double value) {
            return lines.whole(value, first, first + n_points - 1, "a vertex' number") - first;
        };
        outline.segments.push_back({end(segment[1]), end(segment[2])});
    }
    const int n_holes = lines.whole(lines.next(1, "the number of holes")[0], 0, most, "the number of holes");
    for (int h = 0; h < n_holes; ++h) {
        const auto hole = lines.next(3, "a point in a hole");
        outline.holes.push_back({hole[1], hole[2]});
    }
    return outline;
}

/// Reads well-known text: any number of POLYGON and MULTIPOLYGON, over any number of lines. (CGAL's own reader wants
/// each on one line and closes open rings without a word.)
inline OutlineFile read_wkt(const std::filesystem::path& path) {
    const std::string name = path.string();
    std::ifstream stream(path);
    std::vector<std::pair<std::string, long>> statements; // with the line where each begins
    int depth = 0;
    std::string line;
    for (long number = 1; std::getline(stream, line); ++number) {
        std::string word;
        for (const char c : line + ' ') {
            const bool ends_word = std::isspace(static_cast<unsigned char>(c)) != 0 || c == '(' || c == ')' || c == ',';
            if (!ends_word) {
                word += c;
                continue;
            }
            if (is_not_finite_word(word)) {
                throw FileError(name, number, "a coordinate is not finite: " + word);
            }
            const std::string keyword = lower_case(word);
            if (depth == 0 && (keyword == "polygon" || keyword == "multipolygon")) {
                statements.emplace_back("", number);
            } else if (depth == 0 && !word.empty() && (statements.empty() || keyword != "empty")) {
                throw FileError(name, number, "expected POLYGON or MULTIPOLYGON, found " + word);
            }
            if (!statements.empty()) {
                statements.back().first += word + c;
            }
            depth += (c == '(') - (c == ')');
            word.clear();
        }
    }
    OutlineFile outline;
    for (const auto& [statement, number] : statements) {
        boost::geometry::model::multi_polygon<OutlineFile::Polygon> areas;
        try {
            if (lower_case(statement.substr(0, 5)) == "multi") {
                boost::geometry::read_wkt(statement, areas);
            } else {
                areas.resize(1);
                boost::geometry::read_wkt(statement, areas[0]);
            }
        } catch (const boost::geometry::read_wkt_exception& error) {
            throw FileError(name, number, error.what());
        }
        for (auto& area : areas) {
            const auto add_ring = [&, at = number](const auto& ring, const std::string& which) {
                if (ring.empty()) {
                    return;
                }
                if (ring.front().x() != ring.back().x() || ring.front().y() != ring.back().y()) {
                    throw FileError(name, at,
                                    text(which, " is open: it starts at (", ring.front().x(), " ", ring.front().y(),
                                         ") and ends at (", ring.back().x(), " ", ring.back().y(), ")"));
                }
                for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
                    const int n = static_cast<int>(outline.points.size());
                    outline.points.push_back({ring[i].x(), ring[i].y()});
                    outline.segments.push_back({n, i + 2 < ring.size() ? n + 1 : n - static_cast<int>(i)});
                }
            };
            add_ring(area.outer(), "the outer ring");
            for (std::size_t r = 0; r < area.inners().size(); ++r) {
                add_ring(area.inners()[r], text("hole ", r + 1));
            }
            outline.areas.push_back(std::move(area));
        }
    }
    return outline;
}

} // namespace springfit::cgal::detail
