// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <springfit/io/detail/read_text.hpp>
#include <springfit/io/detail/surface_collector.hpp>

namespace springfit::io::detail {

// A binary STL file holds 80 bytes of any kind, the number of its facets, and 50 bytes for each.
inline constexpr std::size_t stl_header = 80;
inline constexpr std::size_t stl_facet = 50;

/// True for a binary STL file. Some begin with `solid`, as those in text do.
[[nodiscard]] inline bool is_binary_stl(std::string_view content) {
    const std::size_t begin = std::min(content.find_first_not_of(" \t\r\n"), content.size());
    const bool says_solid = lower_case(content.substr(begin, 5)) == "solid";
    return !says_solid || content.substr(0, 4 * stl_header).find('\0') != std::string_view::npos;
}

[[nodiscard]] inline SurfaceFile read_binary_stl(TextScanner& scanner, std::size_t size) {
    SurfaceCollector collector(scanner);
    if (size < stl_header + sizeof(std::uint32_t)) {
        throw FileError(scanner.file(), text("expected an STL file: the word solid, or ", stl_header,
                                             " bytes and the number of facets; found ", size, " bytes"));
    }
    scanner.begin_binary();
    scanner.skip_bytes(stl_header - scanner.position());
    const std::size_t n_facets = scanner.bytes<std::uint32_t>(std::endian::little);
    const std::size_t room = (size - scanner.position()) / stl_facet;
    if (n_facets > room) {
        scanner.refuse(text("expected the number of facets of a binary STL file, at most the ", room,
                            " that it has bytes for, found ", n_facets));
    }
    for (std::size_t f = 0; f < n_facets; ++f) {
        scanner.skip_bytes(3 * sizeof(float)); // the normal
        for (int a = 0; a < 3; ++a) {
            std::array<double, 3> point{};
            for (double& x : point) {
                x = static_cast<double>(scanner.bytes<float>(std::endian::little));
            }
            collector.add_corner(collector.n_points());
            collector.add_point(point);
        }
        collector.add_polygon();
        scanner.skip_bytes(2);
    }
    return std::move(collector).finish();
}

/// Text: solids one after another, in any case; each may lack its end.
[[nodiscard]] inline SurfaceFile read_text_stl(TextScanner& scanner) {
    SurfaceCollector collector(scanner);
    const auto next = [&] { return lower_case(scanner.peek()); };
    const auto take = [&](std::string_view expected) {
        if (next() != expected) {
            scanner.refuse(text("expected ", expected, ", found \"", scanner.peek().substr(0, 40), '"'));
        }
        (void)scanner.word(expected);
    };
    for (std::string word = next(); !word.empty(); word = next()) {
        if (word == "solid" || word == "endsolid" || word == "end") {
            scanner.skip_line(); // with the solid's name
            continue;
        }
        take("facet");
        take("normal");
        for (int d = 0; d < 3 && next() != "outer"; ++d) {
            (void)scanner.word("a component of the normal");
        }
        take("outer");
        take("loop");
        while (next() == "vertex") {
            take("vertex");
            collector.add_corner(collector.n_points());
            collector.add_text_point();
        }
        take("endloop");
        take("endfacet");
        collector.add_polygon();
    }
    return std::move(collector).finish();
}

} // namespace springfit::io::detail
