// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include <springfit/io/detail/coordinate.hpp>
#include <springfit/io/surface_file.hpp>

namespace springfit::io::detail {

/// Gathers points and polygons in the order of a file.
class SurfaceCollector {
public:
    explicit SurfaceCollector(TextScanner& scanner) : m_scanner(&scanner) {}

    [[nodiscard]] long long n_points() const { return static_cast<long long>(m_surface.points.size()); }

    void add_point(const std::array<double, 3>& point) {
        for (const double x : point) {
            check_coordinate(*m_scanner, x);
        }
        m_surface.points.push_back(point);
    }

    /// Three coordinates that come next on a line of text.
    void add_text_point() {
        std::array<double, 3> point{};
        for (double& x : point) {
            m_scanner->require_on_line("three coordinates of a vertex");
            x = text_coordinate(*m_scanner);
        }
        m_surface.points.push_back(point);
    }

    /// The next corner of the polygon to be added; its point may come later in the file.
    void add_corner(long long point) {
        if (!(point >= 0 && point < std::numeric_limits<int>::max())) {
            m_scanner->refuse(text("face ", m_n_polygons, " names vertex ", point));
        }
        if (point > m_highest) {
            m_highest = point;
            m_highest_at = m_scanner->position();
            m_highest_face = m_n_polygons;
        }
        m_corners.push_back(static_cast<int>(point));
    }

    /// Ends a polygon; one of fewer than three corners (a line) is left out.
    void add_polygon() {
        if (m_corners.size() >= 3) {
            m_surface.polygons.push_back(m_corners);
        }
        m_corners.clear();
        ++m_n_polygons;
    }

    /// `first`: the number of the first vertex in the file, for messages.
    [[nodiscard]] SurfaceFile finish(long long first = 0) && {
        if (m_highest >= n_points()) {
            m_scanner->refuse_at(m_highest_at, text("face ", m_highest_face + first, " names vertex ",
                                                    m_highest + first, ", there are ", n_points()));
        }
        if (m_surface.points.empty() || m_surface.polygons.empty()) {
            throw FileError(m_scanner->file(),
                            text("empty surface: ", n_points(), " vertices, ", m_surface.polygons.size(), " faces"));
        }
        m_surface.file = m_scanner->file();
        return std::move(m_surface);
    }

private:
    TextScanner* m_scanner;
    SurfaceFile m_surface;
    std::vector<int> m_corners;
    long long m_n_polygons = 0;
    long long m_highest = -1; ///< of all corners, and where it is named
    std::size_t m_highest_at = 0;
    long long m_highest_face = 0;
};

} // namespace springfit::io::detail
