// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace springfit::cgal::detail {

/// Points that are nearer than this part of the body's largest extent are one point.
inline constexpr double merge_share = 1e-6;

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

} // namespace springfit::cgal::detail
