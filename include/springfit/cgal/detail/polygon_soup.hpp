// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <springfit/cgal/detail/body_unit.hpp>
#include <springfit/cgal/detail/near_points.hpp>

namespace springfit::cgal::detail {

/// Polygons over shared points: in any orientation, perhaps with points given twice.
struct PolygonSoup {
    using Polygon = std::vector<std::size_t>;

    std::vector<std::array<double, 3>> points;
    std::vector<Polygon> polygons;
};

/// Coordinates below this part of the body's largest extent are 0: next to 0 alone can points be nearer to each other
/// than rounding errors.
inline constexpr double zero_share = 1e-14;

/// The lowest corner of the points that polygons use, and the largest extent.
[[nodiscard]] inline std::pair<std::array<double, 3>, double> lowest_and_extent(const PolygonSoup& soup) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<double, 3> low{infinity, infinity, infinity};
    std::array<double, 3> high{-infinity, -infinity, -infinity};
    for (const auto& polygon : soup.polygons) {
        for (const std::size_t corner : polygon) {
            for (std::size_t d = 0; d < 3; ++d) {
                low[d] = std::min(low[d], soup.points[corner][d]);
                high[d] = std::max(high[d], soup.points[corner][d]);
            }
        }
    }
    return {low, std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2], 0.})};
}

/// Rounds points to the grid that meshers work on, 2^-40 of the body: what is thinner has no area then, and is dropped.
inline void round_to_grid(PolygonSoup& soup) {
    const double extent = lowest_and_extent(soup).second;
    if (extent > 0 && std::isfinite(extent)) {
        for (auto& point : soup.points) {
            for (double& x : point) {
                x = in_unit(x, extent) * extent;
            }
        }
    }
}

/// Drops corners that follow themselves, and those where a polygon turns back on itself.
inline void drop_repeated_corners(PolygonSoup::Polygon& polygon) {
    for (std::size_t i = 0; i < polygon.size() && polygon.size() >= 3;) {
        const std::size_t n = polygon.size();
        const std::size_t next = polygon[(i + 1) % n];
        const bool is_spike = polygon[(i + n - 1) % n] == next;
        if (polygon[i] != next && !is_spike) {
            ++i;
            continue;
        }
        polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(i));
        i = i < 2 ? 0 : i - 2; // its neighbours may now be such corners
    }
}

/// Merges points that are near to each other into the first of them, and coordinates near to 0 into 0. Polygons keep
/// their place; those that have no area left become empty. Throws InvalidArgument, naming `name`, for a body of a size
/// that `check_extent` refuses. O(points).
inline void merge_near_points(PolygonSoup& soup, std::string_view name) {
    const auto [low, extent] = lowest_and_extent(soup);
    check_extent(extent, name);
    for (auto& point : soup.points) {
        for (double& x : point) {
            x = std::abs(x) < zero_share * extent ? 0. : x;
        }
    }
    NearPoints near(low, extent > 0 ? merge_share * extent : 1.);
    constexpr auto none = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> merged(soup.points.size(), none);
    for (auto& polygon : soup.polygons) {
        for (std::size_t& corner : polygon) {
            std::size_t& first = merged[corner];
            first = first == none ? near.find_or_add(soup.points[corner], corner) : first;
            corner = first;
        }
        drop_repeated_corners(polygon);
        if (polygon.size() < 3) {
            polygon.clear();
        }
    }
}

} // namespace springfit::cgal::detail
