// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <queue>
#include <unordered_map>
#include <vector>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/squared_distance_2.h>

#include <springfit/cgal/detail/kernel.hpp>
#include <springfit/core/error.hpp>
#include <springfit/mesh/mesh.hpp>

namespace springfit::cgal::detail {

/// Points and the segments between them, each once; the segments meet at their ends only.
struct PlaneGraph {
    std::vector<Kernel::Point_2> points;
    std::vector<std::array<int, 2>> segments;
};

/// Pairs of segments that cross, or come as near to each other as `distance` elsewhere than at an end that they share.
/// O(n log n) as a rule.
inline Index count_crossings(const PlaneGraph& graph, double distance) {
    using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 2, int>;
    std::vector<Box> boxes;
    for (std::size_t s = 0; s < graph.segments.size(); ++s) {
        const auto& p = graph.points[static_cast<std::size_t>(graph.segments[s][0])];
        const auto& q = graph.points[static_cast<std::size_t>(graph.segments[s][1])];
        const CGAL::Bbox_2 box = p.bbox() + q.bbox();
        boxes.emplace_back(
            CGAL::Bbox_2(box.xmin() - distance, box.ymin() - distance, box.xmax() + distance, box.ymax() + distance),
            static_cast<int>(s));
    }
    Index crossings = 0;
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& first, const Box& second) {
        const auto& s = graph.segments[static_cast<std::size_t>(first.info())];
        const auto& t = graph.segments[static_cast<std::size_t>(second.info())];
        const auto point = [&](int i) { return graph.points[static_cast<std::size_t>(i)]; };
        const Kernel::Segment_2 on_s(point(s[0]), point(s[1]));
        const Kernel::Segment_2 on_t(point(t[0]), point(t[1]));
        const auto is_near = [&](int i, const Kernel::Segment_2& segment) {
            return CGAL::squared_distance(point(i), segment) <= distance * distance;
        };
        for (const std::size_t a : {0, 1}) {
            for (const std::size_t b : {0, 1}) {
                if (s[a] == t[b]) { // joined at one end: they may still lie on each other
                    crossings += is_near(s[1 - a], on_t) || is_near(t[1 - b], on_s) ? 1 : 0;
                    return;
                }
            }
        }
        const bool is_crossing = CGAL::do_intersect(on_s, on_t) || is_near(s[0], on_t) || is_near(s[1], on_t) ||
                                 is_near(t[0], on_s) || is_near(t[1], on_s);
        crossings += is_crossing ? 1 : 0;
    });
    return crossings;
}

/// The plane cut by a graph's segments into regions, and Delaunay refinement of those that are to be meshed.
class PlaneMesher {
public:
    using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
        Kernel, CGAL::Triangulation_data_structure_2<CGAL::Delaunay_mesh_vertex_base_2<Kernel>,
                                                     CGAL::Delaunay_mesh_face_base_2<Kernel>>>;
    using Face = Triangulation::Face_handle;

    explicit PlaneMesher(const PlaneGraph& graph) {
        std::vector<Triangulation::Vertex_handle> vertices;
        for (const auto& point : graph.points) {
            vertices.push_back(m_triangulation.insert(point));
        }
        for (const auto& [a, b] : graph.segments) {
            m_triangulation.insert_constraint(vertices[static_cast<std::size_t>(a)],
                                              vertices[static_cast<std::size_t>(b)]);
        }
        for (const auto face : m_triangulation.all_face_handles()) {
            face->set_in_domain(true);
        }
        empty(m_triangulation.infinite_face());
    }

    /// Empties the region that a point lies in; false where it lies outside the outline or on a segment.
    [[nodiscard]] bool empty_at(const Kernel::Point_2& point) {
        Triangulation::Locate_type type;
        int index = 0;
        const Face face = m_triangulation.locate(point, type, index);
        if (type == Triangulation::VERTEX || type == Triangulation::OUTSIDE_CONVEX_HULL ||
            type == Triangulation::OUTSIDE_AFFINE_HULL ||
            (type == Triangulation::EDGE && m_triangulation.is_constrained({face, index})) || is_outside(face)) {
            return false;
        }
        empty(face);
        return true;
    }

    /// A point well inside each region that is to be meshed.
    [[nodiscard]] std::vector<Kernel::Point_2> region_points() const {
        std::vector<Kernel::Point_2> points;
        std::unordered_map<const void*, bool> seen;
        for (const auto start : m_triangulation.finite_face_handles()) {
            if (!start->is_in_domain() || !seen.emplace(&*start, true).second) {
                continue;
            }
            Face largest = start;
            for_region(
                start, [&](Face next) { return seen.emplace(&*next, true).second; },
                [&](Face face) { largest = area(face) > area(largest) ? face : largest; });
            points.push_back(CGAL::centroid(m_triangulation.triangle(largest)));
        }
        return points;
    }

    /// Area that is to be meshed, m^2.
    [[nodiscard]] double area() const {
        double sum = 0;
        for (const auto face : m_triangulation.finite_face_handles()) {
            sum += face->is_in_domain() ? area(face) : 0;
        }
        return sum;
    }

    /// Triangles with edges of about `size`, no angle below 20.7 degrees except at sharp corners of the outline.
    /// Ends, unfinished, at `most_nodes`.
    [[nodiscard]] Triangulation refined(double size, std::size_t most_nodes) const {
        Triangulation triangulation = m_triangulation;
        CGAL::Delaunay_mesher_2<Triangulation, CGAL::Delaunay_mesh_size_criteria_2<Triangulation>> mesher(
            triangulation, CGAL::Delaunay_mesh_size_criteria_2<Triangulation>(0.125, longest * size));
        mesher.init(true);
        while (triangulation.number_of_vertices() < most_nodes && mesher.step_by_step_refine_mesh()) {
        }
        return triangulation;
    }

private:
    /// Longest edge allowed per wanted edge length, at which the mean edge has that length.
    static constexpr double longest = 1.5;

    static double area(Face face) {
        return std::abs(CGAL::area(face->vertex(0)->point(), face->vertex(1)->point(), face->vertex(2)->point()));
    }

    /// Visits the faces of the region of `start`; `enter` says of a neighbour whether it is new.
    template <class Enter, class Visit>
    void for_region(Face start, const Enter& enter, const Visit& visit) const {
        std::queue<Face> queue;
        for (queue.push(start); !queue.empty(); queue.pop()) {
            const Face face = queue.front();
            visit(face);
            for (int i = 0; i < 3; ++i) {
                if (!face->is_constrained(i) && enter(face->neighbor(i))) {
                    queue.push(face->neighbor(i));
                }
            }
        }
    }

    void empty(Face start) {
        start->set_in_domain(false);
        for_region(
            start,
            [](Face next) {
                const bool is_new = next->is_in_domain();
                next->set_in_domain(false);
                return is_new;
            },
            [](Face) {});
    }

    /// True where a face belongs to the region around the whole outline.
    [[nodiscard]] bool is_outside(Face face) const {
        bool outside = false;
        std::unordered_map<const void*, bool> seen{{&*face, true}};
        for_region(
            face, [&](Face next) { return seen.emplace(&*next, true).second; },
            [&](Face at) { outside = outside || m_triangulation.is_infinite(at); });
        return outside;
    }

    Triangulation m_triangulation;
};

/// Vertices of the faces that are to be meshed.
inline Index count_nodes(const PlaneMesher::Triangulation& triangulation) {
    std::unordered_map<const void*, bool> seen;
    for (const auto face : triangulation.finite_face_handles()) {
        for (int a = 0; a < 3 && face->is_in_domain(); ++a) {
            seen.emplace(&*face->vertex(a), true);
        }
    }
    return static_cast<Index>(seen.size());
}

/// The triangles to be meshed, counter-clockwise, with their nodes numbered as the triangles come.
template <std::floating_point Scalar>
[[nodiscard]] Mesh<2, Scalar, Tri3> to_mesh(const PlaneMesher::Triangulation& triangulation) {
    std::unordered_map<const void*, int> number;
    std::vector<Kernel::Point_2> points;
    std::vector<std::array<int, 3>> cells;
    for (const auto face : triangulation.finite_face_handles()) {
        if (face->is_in_domain()) {
            auto& cell = cells.emplace_back();
            for (int a = 0; a < 3; ++a) {
                const auto [at, is_new] = number.emplace(&*face->vertex(a), static_cast<int>(points.size()));
                if (is_new) {
                    points.push_back(face->vertex(a)->point());
                }
                cell[static_cast<std::size_t>(a)] = at->second;
            }
        }
    }
    Mesh<2, Scalar, Tri3> mesh;
    mesh.nodes.resize(2, static_cast<Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        mesh.nodes.col(static_cast<Index>(i)) << static_cast<Scalar>(points[i].x()), static_cast<Scalar>(points[i].y());
    }
    mesh.cells.resize(3, static_cast<Index>(cells.size()));
    for (std::size_t c = 0; c < cells.size(); ++c) {
        mesh.cells.col(static_cast<Index>(c)) << cells[c][0], cells[c][1], cells[c][2];
    }
    return mesh;
}

} // namespace springfit::cgal::detail
