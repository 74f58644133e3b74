// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <queue>
#include <unordered_set>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Polygon_2_algorithms.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <springfit/cgal/detail/kernel.hpp>
#include <springfit/cgal/detail/polygon_soup.hpp>

namespace springfit::cgal::detail {

/// A polygon seen along the axis from which it looks largest; the coordinates are the polygon's own.
struct FlatPolygon {
    std::vector<Kernel::Point_2> corners;
    double area = 0; ///< as it is seen; below 0 where the corners run clockwise
};

[[nodiscard]] inline FlatPolygon flat_polygon(const PolygonSoup& soup, const PolygonSoup::Polygon& polygon) {
    const auto corner = [&](std::size_t i) -> const std::array<double, 3>& {
        return soup.points[polygon[i % polygon.size()]];
    };
    std::array<double, 3> area{}; // seen along x, y, z
    const auto& origin = corner(0);
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        for (std::size_t d = 0; d < 3; ++d) {
            const std::size_t u = (d + 1) % 3;
            const std::size_t v = (d + 2) % 3;
            area[d] += ((corner(i)[u] - origin[u]) * (corner(i + 1)[v] - origin[v]) -
                        (corner(i)[v] - origin[v]) * (corner(i + 1)[u] - origin[u])) /
                       2;
        }
    }
    const auto along = static_cast<std::size_t>(
        std::max_element(area.begin(), area.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }) -
        area.begin());
    FlatPolygon flat;
    flat.area = area[along];
    for (const std::size_t i : polygon) {
        flat.corners.emplace_back(soup.points[i][(along + 1) % 3], soup.points[i][(along + 2) % 3]);
    }
    return flat;
}

/// Cuts a polygon that does not cross itself into triangles of the numbers of its corners.
[[nodiscard]] inline std::vector<std::array<std::size_t, 3>> triangles_of(const FlatPolygon& polygon) {
    using Vertex = CGAL::Triangulation_vertex_base_with_info_2<std::size_t, Kernel>;
    using Data = CGAL::Triangulation_data_structure_2<Vertex, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
    using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Data>;
    Triangulation triangulation;
    std::vector<Triangulation::Vertex_handle> vertices;
    for (const auto& corner : polygon.corners) {
        vertices.push_back(triangulation.insert(corner));
        vertices.back()->info() = vertices.size() - 1;
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        triangulation.insert_constraint(vertices[i], vertices[(i + 1) % vertices.size()]);
    }
    std::unordered_set<const void*> outside{&*triangulation.infinite_face()};
    std::queue<Triangulation::Face_handle> queue({triangulation.infinite_face()});
    for (; !queue.empty(); queue.pop()) {
        const auto face = queue.front();
        for (int i = 0; i < 3; ++i) {
            if (!face->is_constrained(i) && outside.insert(&*face->neighbor(i)).second) {
                queue.push(face->neighbor(i));
            }
        }
    }
    std::vector<std::array<std::size_t, 3>> triangles;
    for (const auto face : triangulation.finite_face_handles()) {
        if (!outside.contains(&*face)) {
            triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
            if (polygon.area < 0) {
                std::swap(triangles.back()[0], triangles.back()[1]);
            }
        }
    }
    return triangles;
}

/// True where all corners of a polygon lie on a line.
[[nodiscard]] inline bool is_line(const PolygonSoup& soup, const PolygonSoup::Polygon& polygon) {
    const auto corner = [&](std::size_t i) {
        const auto& p = soup.points[polygon[i]];
        return Kernel::Point_3(p[0], p[1], p[2]);
    };
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        if (!CGAL::collinear(corner(0), corner(1), corner(i))) {
            return false;
        }
    }
    return true;
}

/// Cuts all polygons into triangles; empty ones and those whose corners lie on a line are dropped. Throws
/// InvalidArgument, naming `name` and the number of the polygon (from 1), for one that crosses or touches itself.
inline void cut_polygons(PolygonSoup& soup, std::string_view name) {
    std::vector<PolygonSoup::Polygon> triangles;
    for (std::size_t f = 0; f < soup.polygons.size(); ++f) {
        const auto& polygon = soup.polygons[f];
        if (polygon.size() <= 3) {
            if (polygon.size() == 3) {
                triangles.push_back(polygon);
            }
            continue;
        }
        const FlatPolygon flat = flat_polygon(soup, polygon);
        if (!CGAL::is_simple_2(flat.corners.begin(), flat.corners.end(), Kernel())) {
            require(is_line(soup, polygon), name, "faces that neither cross nor touch themselves",
                    text("face ", f + 1, ", whose ", polygon.size(), " corners begin at (", soup.points[polygon[0]][0],
                         ' ', soup.points[polygon[0]][1], ' ', soup.points[polygon[0]][2], ')'));
            continue;
        }
        for (const auto& [a, b, c] : triangles_of(flat)) {
            triangles.push_back({polygon[a], polygon[b], polygon[c]});
        }
    }
    soup.polygons = std::move(triangles);
}

} // namespace springfit::cgal::detail
