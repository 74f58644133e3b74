// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include <springfit/cgal/detail/body_unit.hpp>

namespace springfit::cgal::detail {

/// Polygons over shared points: in any orientation, perhaps with points given twice.
struct PolygonSoup {
    using Polygon = std::vector<std::size_t>;

    std::vector<std::array<double, 3>> points;
    std::vector<Polygon> polygons;
};

/// Points that are nearer than this part of the body's largest extent are one point.
inline constexpr double merge_share = 1e-6;

/// Coordinates below this part of it are 0: next to 0 alone can points be nearer to each other than rounding errors.
inline constexpr double zero_share = 1e-14;

/// Finds points that are near to one that came before.
class NearPoints {
public:
    NearPoints(const std::array<double, 3>& lowest, double distance) : m_lowest(lowest), m_distance(distance) {}

    /// The number of the first point within the distance, else `number`, which is then found from here on.
    [[nodiscard]] std::size_t find_or_add(const std::array<double, 3>& point, std::size_t number) {
        std::array<std::array<std::uint64_t, 2>, 3> range{}; // boxes that come within the distance
        for (std::size_t d = 0; d < 3; ++d) {
            const double from_lowest = point[d] - m_lowest[d];
            range[d] = {box(from_lowest - m_distance), box(from_lowest + m_distance)};
        }
        for (auto i = range[0][0]; i <= range[0][1]; ++i) {
            for (auto j = range[1][0]; j <= range[1][1]; ++j) {
                for (auto k = range[2][0]; k <= range[2][1]; ++k) {
                    const auto in_box = m_boxes.find(key({i, j, k}));
                    for (std::size_t n = 0; in_box != m_boxes.end() && n < in_box->second.size(); ++n) {
                        if (is_near(in_box->second[n].point, point)) {
                            return in_box->second[n].number;
                        }
                    }
                }
            }
        }
        m_boxes[key({box(point[0] - m_lowest[0]), box(point[1] - m_lowest[1]), box(point[2] - m_lowest[2])})].push_back(
            {point, number});
        return number;
    }

private:
    struct Entry {
        std::array<double, 3> point;
        std::size_t number;
    };

    /// Boxes are so much larger than the distance that most points look into one of them, and so small that few fit in.
    static constexpr double box_size = 8;

    [[nodiscard]] std::uint64_t box(double from_lowest) const {
        return from_lowest > 0 ? static_cast<std::uint64_t>(from_lowest / (box_size * m_distance)) : 0;
    }
    [[nodiscard]] static std::uint64_t key(const std::array<std::uint64_t, 3>& at) {
        return (at[0] << 42U) | (at[1] << 21U) | at[2];
    }
    [[nodiscard]] bool is_near(const std::array<double, 3>& a, const std::array<double, 3>& b) const {
        return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) <= m_distance;
    }

    std::array<double, 3> m_lowest;
    double m_distance;
    std::unordered_map<std::uint64_t, std::vector<Entry>> m_boxes;
};

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
