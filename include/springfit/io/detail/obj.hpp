// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/io/detail/surface_collector.hpp>

namespace springfit::io::detail {

/// The number of a vertex in one corner of a face: `7`, `7/1`, `7//3`, `7/1/3`; -1 is the vertex given last.
[[nodiscard]] inline long long obj_corner(TextScanner& scanner, long long n_points) {
    const std::string_view word = scanner.peek();
    long long number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc{} || !(end == word.data() + word.size() || *end == '/')) {
        scanner.refuse(text("expected the number of a vertex, found \"", word.substr(0, 40), '"'));
    }
    if (number == 0 || number < -n_points) {
        scanner.refuse(text("expected the number of a vertex, from 1 or from -1 down, found ", number, "; there are ",
                            n_points, " so far"));
    }
    (void)scanner.word("a corner");
    return number > 0 ? number - 1 : n_points + number;
}

[[nodiscard]] inline SurfaceFile read_obj(TextScanner& scanner) {
    SurfaceCollector collector(scanner);
    while (!scanner.peek().empty()) {
        const std::string keyword(scanner.word("a keyword"));
        if (keyword == "v") {
            collector.add_text_point(); // its weight or colour may follow
        } else if (keyword == "f" || keyword == "fo") {
            while (!scanner.at_line_end()) {
                collector.add_corner(obj_corner(scanner, collector.n_points()));
            }
            collector.add_polygon();
        }
        scanner.skip_words_of_line();
    }
    return std::move(collector).finish(1);
}

} // namespace springfit::io::detail
