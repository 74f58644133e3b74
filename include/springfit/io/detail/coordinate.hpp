// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <springfit/io/detail/text_scanner.hpp>

namespace springfit::io::detail {

/// A coordinate beyond this has no volume in double precision.
inline constexpr double largest_coordinate = 1e100;

/// Refuses a coordinate that cannot be computed with.
inline void check_coordinate(const TextScanner& scanner, double x) {
    if (!std::isfinite(x)) {
        scanner.refuse(text("a coordinate is not finite: ", x));
    }
    if (!(std::abs(x) <= largest_coordinate)) {
        scanner.refuse(text("expected coordinates up to ", largest_coordinate, ", found ", x));
    }
}

/// A coordinate in the text part of a file.
[[nodiscard]] inline double text_coordinate(TextScanner& scanner) {
    const double x = scanner.any_number("a coordinate");
    check_coordinate(scanner, x);
    return x;
}

} // namespace springfit::io::detail
