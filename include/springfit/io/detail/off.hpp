// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cctype>
#include <cstdint>

#include <springfit/io/detail/surface_collector.hpp>

namespace springfit::io::detail {

/// What the first word of an OFF file says that each vertex has beside its position: STCNOFF has all.
struct OffHeader {
    bool texture = false;   ///< ST: two numbers
    bool colour = false;    ///< C: three or four
    bool normal = false;    ///< N: three
    bool dimension = false; ///< n: a word with the dimension comes first
    bool binary = false;
};

/// Takes the word, which the number of vertices may follow without a blank.
[[nodiscard]] inline OffHeader read_off_header(TextScanner& scanner) {
    OffHeader header;
    std::string_view word = scanner.peek();
    const std::string_view whole = word;
    const auto take = [&](std::string_view part) {
        const bool is_there = word.starts_with(part);
        word.remove_prefix(is_there ? part.size() : 0);
        return is_there;
    };
    header.texture = take("ST");
    header.colour = take("C");
    header.normal = take("N");
    const bool four = take("4");
    header.dimension = take("n");
    if (!take("OFF") || !(word.empty() || std::isdigit(static_cast<unsigned char>(word[0])) != 0)) {
        scanner.refuse(text("expected OFF (or COFF, NOFF, ...), found \"", whole.substr(0, 40), '"'));
    }
    if (four) {
        scanner.refuse("expected points in space, found 4OFF, whose points have four coordinates");
    }
    scanner.skip_bytes(whole.size() - word.size());
    if (!scanner.at_line_end() && scanner.peek() == "BINARY") {
        header.binary = true;
        scanner.skip_line();
    }
    return header;
}

inline void read_binary_off(TextScanner& scanner, SurfaceCollector& collector, const OffHeader& header) {
    constexpr auto order = std::endian::big;
    scanner.begin_binary();
    const auto count = [&](std::string_view what) {
        const long long n = scanner.bytes<std::int32_t>(order);
        scanner.check_size(n, what);
        return n;
    };
    const long long n_points = count("vertices");
    const long long n_faces = count("faces");
    (void)scanner.bytes<std::int32_t>(order); // edges
    const std::size_t extras = (header.normal ? 3 : 0) + (header.colour ? 4 : 0) + (header.texture ? 2 : 0);
    for (long long i = 0; i < n_points; ++i) {
        std::array<double, 3> point{};
        for (double& x : point) {
            x = static_cast<double>(scanner.bytes<float>(order));
        }
        collector.add_point(point);
        scanner.skip_bytes(extras * sizeof(float));
    }
    for (long long f = 0; f < n_faces; ++f) {
        const long long n_corners = count("corners of a face");
        for (long long a = 0; a < n_corners; ++a) {
            collector.add_corner(scanner.bytes<std::int32_t>(order));
        }
        collector.add_polygon();
        const long long n_colours = count("numbers of a colour");
        for (long long c = 0; c < n_colours; ++c) {
            (void)scanner.bytes<float>(order);
        }
    }
}

/// A vertex with all that its line has: a plain OFF file may have colours or the like, too.
inline void read_off_vertex(TextScanner& scanner, SurfaceCollector& collector, const OffHeader& header) {
    (void)scanner.peek(); // on to the next line
    collector.add_text_point();
    long long extras = 0;
    for (; !scanner.at_line_end(); ++extras) {
        (void)scanner.any_number("a number that belongs to the vertex");
    }
    const long long fixed = (header.normal ? 3 : 0) + (header.texture ? 2 : 0);
    if (header.colour && extras != fixed + 3 && extras != fixed + 4) {
        scanner.refuse(
            text("expected a vertex with a colour of 3 or 4 numbers, found ", extras, " numbers behind its position"));
    }
    if (!header.colour && fixed > 0 && extras != fixed) {
        scanner.refuse(text("expected ", fixed, " numbers behind the position of a vertex, found ", extras));
    }
}

[[nodiscard]] inline SurfaceFile read_off(TextScanner& scanner) {
    SurfaceCollector collector(scanner);
    const OffHeader header = read_off_header(scanner);
    if (header.binary) {
        read_binary_off(scanner, collector, header);
        return std::move(collector).finish();
    }
    if (header.dimension && scanner.count("the dimension") != 3) {
        scanner.refuse("expected points in space, found another dimension");
    }
    const long long n_points = scanner.count("the number of vertices");
    const long long n_faces = scanner.count("the number of faces");
    if (!scanner.at_line_end()) {
        (void)scanner.count("the number of edges");
    }
    scanner.check_size(n_points, "vertices");
    scanner.check_size(n_faces, "faces");
    for (long long i = 0; i < n_points; ++i) {
        read_off_vertex(scanner, collector, header);
    }
    for (long long f = 0; f < n_faces; ++f) {
        const long long n_corners = scanner.count("the number of corners of a face");
        scanner.check_size(n_corners, "corners of a face");
        for (long long a = 0; a < n_corners; ++a) {
            collector.add_corner(scanner.whole("the number of a vertex"));
        }
        collector.add_polygon();
        while (!scanner.at_line_end()) {
            (void)scanner.any_number("a colour");
        }
    }
    return std::move(collector).finish();
}

} // namespace springfit::io::detail
