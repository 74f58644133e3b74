// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <map>

#include <springfit/cgal/detail/body_unit.hpp>
#include <springfit/cgal/detail/mesh_2.hpp>
#include <springfit/cgal/detail/near_points.hpp>
#include <springfit/cgal/detail/pieces.hpp>
#include <springfit/cgal/detail/size_search.hpp>
#include <springfit/cgal/triangulate.hpp>
#include <springfit/io/outline_file.hpp>

namespace springfit::cgal {

namespace detail {

inline PlaneGraph plane_graph(const Outline& outline) {
    PlaneGraph graph;
    for (Index i = 0; i < outline.points.cols(); ++i) {
        graph.points.emplace_back(outline.points(0, i), outline.points(1, i));
    }
    for (Index s = 0; s < outline.segments.cols(); ++s) {
        graph.segments.push_back({outline.segments(0, s), outline.segments(1, s)});
    }
    return graph;
}

template <class Number>
[[nodiscard]] Eigen::Matrix<Number, 2, Eigen::Dynamic> columns(const std::vector<std::array<Number, 2>>& list) {
    Eigen::Matrix<Number, 2, Eigen::Dynamic> matrix(2, static_cast<Index>(list.size()));
    for (std::size_t i = 0; i < list.size(); ++i) {
        matrix.col(static_cast<Index>(i)) << list[i][0], list[i][1];
    }
    return matrix;
}

/// True for a point, which lies on no segment, inside a ring: a ray along x crosses the ring an odd number of times.
[[nodiscard]] inline bool is_in_ring(const Points<2, double>& points, const std::vector<int>& ring,
                                     const Vector<2, double>& p) {
    bool is_inside = false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vector<2, double> a = points.col(ring[i]);
        const Vector<2, double> b = points.col(ring[(i + 1) % ring.size()]);
        if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
            is_inside = !is_inside;
        }
    }
    return is_inside;
}

/// True for a point inside the outer ring of an area and outside of its holes.
[[nodiscard]] inline bool is_in_area(const Points<2, double>& points, const io::OutlineFile::Area& area,
                                     const Vector<2, double>& p) {
    const auto is_in = [&](const std::vector<int>& ring) { return is_in_ring(points, ring, p); };
    return !area.empty() && is_in(area.front()) && std::none_of(area.begin() + 1, area.end(), is_in);
}

inline void check(const TriangulateOptions& options) {
    const bool by_size = options.cell_size != 0;
    require(by_size != (options.n_nodes != 0), "cell_size, n_nodes", "one of the two", by_size ? "both" : "neither");
    require(!by_size || (options.cell_size > 0 && std::isfinite(options.cell_size)), "cell_size", "a positive length",
            options.cell_size);
    require(by_size || options.n_nodes >= 3, "n_nodes", "at least the 3 of one triangle", options.n_nodes);
    require(options.n_nodes <= most_nodes, "n_nodes", text("at most ", most_nodes), options.n_nodes);
}

template <std::floating_point Scalar>
[[nodiscard]] Mesh<2, Scalar, Tri3> triangulate(const Outline& given, TriangulateOptions options,
                                                std::string_view name) {
    Outline outline = checked(given, name);
    const double unit = body_unit<2>(outline.points);
    outline.points = in_unit<2>(outline.points, unit);
    outline.holes = in_unit<2>(outline.holes, unit);
    options.cell_size /= unit;
    PlaneMesher mesher(plane_graph(outline));
    for (Index h = 0; h < outline.holes.cols(); ++h) {
        require(mesher.empty_at({outline.holes(0, h), outline.holes(1, h)}), name, "a hole's point inside the outline",
                text("hole ", h, " at (", given.holes.col(h).transpose(), ")"));
    }
    const double area = mesher.area();
    require(area > 0, name, "an outline around an area", "none that is not a hole");
    double perimeter = 0;
    for (Index s = 0; s < outline.segments.cols(); ++s) {
        perimeter += (outline.points.col(outline.segments(1, s)) - outline.points.col(outline.segments(0, s))).norm();
    }
    // Nodes at edge length h: about 1.15 A / h^2 inside and half a node per h of boundary.
    const auto nodes_at = [&](double h) { return 1.15 * area / (h * h) + 0.5 * perimeter / h; };
    check_cell_size(options.cell_size, unit, nodes_at);
    const double wanted = options.cell_size > 0 ? nodes_at(options.cell_size) : static_cast<double>(options.n_nodes);
    const auto limit = static_cast<std::size_t>(few_nodes + far_more_nodes * wanted);
    const auto mesh_at = [&](double size) {
        auto mesh = mesher.refined(size, limit);
        require(mesh.number_of_vertices() < limit, name,
                "parts so thick that the wanted nodes can fill them (ask for more)",
                text("thin parts that take more than ", limit));
        return mesh;
    };
    const auto triangulation =
        options.cell_size > 0
            ? mesh_at(options.cell_size)
            : mesh_with_nodes(
                  options.n_nodes, size_where(nodes_at, static_cast<double>(options.n_nodes), std::sqrt(area)), 2,
                  mesh_at, [](const PlaneMesher::Triangulation& mesh) { return count_nodes(mesh); },
                  [&](double share) { return go_on(options.progress, "mesh", 0.9 * share); });
    (void)go_on(options.progress, "mesh", 1);
    auto mesh = to_mesh<Scalar>(triangulation);
    if (!options.several_pieces) {
        const Index pieces = n_pieces(mesh);
        require(pieces == 1, name, "an outline of one piece (several_pieces accepts more)", text(pieces, " pieces"));
    }
    mesh.nodes *= static_cast<Scalar>(unit);
    return mesh;
}

} // namespace detail

SPRINGFIT_CGAL_INLINE Outline checked(const Outline& outline, std::string_view name) {
    require(outline.points.allFinite() && outline.holes.allFinite(), name, "finite coordinates",
            "one that is not finite");
    const double extent = outline.points.cols() > 0
                              ? (outline.points.rowwise().maxCoeff() - outline.points.rowwise().minCoeff()).maxCoeff()
                              : 0.;
    detail::check_extent(extent, name);
    const Vector<2, double> lowest =
        outline.points.cols() > 0 ? Vector<2, double>(outline.points.rowwise().minCoeff()) : Vector<2, double>(0, 0);
    const double distance = extent > 0 ? detail::merge_share * extent : 1.;
    detail::NearPoints near({lowest.x(), lowest.y(), 0}, distance);
    std::vector<Vector<2, double>> points;
    std::vector<std::array<int, 2>> segments;
    std::map<int, int> n_segments_at;
    for (Index s = 0; s < outline.segments.cols(); ++s) {
        std::array<int, 2> ends{};
        for (const int e : {0, 1}) {
            const int i = outline.segments(e, s);
            if (!(i >= 0 && i < outline.points.cols())) {
                throw InvalidArgument(name, text("point numbers in [0, ", outline.points.cols(), ")"),
                                      text(i, " in segment ", s));
            }
            const std::size_t found = near.find_or_add({outline.points(0, i), outline.points(1, i), 0}, points.size());
            if (found == points.size()) {
                points.emplace_back(outline.points.col(i));
            }
            ends[static_cast<std::size_t>(e)] = static_cast<int>(found);
        }
        if (ends[0] != ends[1]) {
            segments.push_back(ends);
        }
    }
    const NodePairs unique = springfit::detail::sorted_unique_pairs(segments);
    require(unique.cols() >= 3, name, "an outline of at least three segments", unique.cols());

    detail::PlaneGraph graph;
    Outline result;
    result.points.resize(2, static_cast<Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        graph.points.emplace_back(points[i].x(), points[i].y());
        result.points.col(static_cast<Index>(i)) = points[i];
    }
    for (Index s = 0; s < unique.cols(); ++s) {
        graph.segments.push_back({unique(0, s), unique(1, s)});
        ++n_segments_at[unique(0, s)];
        ++n_segments_at[unique(1, s)];
    }
    const auto loose =
        std::count_if(n_segments_at.begin(), n_segments_at.end(), [](const auto& at) { return at.second == 1; });
    if (loose > 0) {
        const int first = std::find_if(n_segments_at.begin(), n_segments_at.end(), [](const auto& at) {
                              return at.second == 1;
                          })->first;
        throw InvalidArgument(name, "a closed outline",
                              text("an open one: ", loose, loose == 1 ? " loose end" : " loose ends",
                                   ", the first at (", result.points.col(first).transpose(), ")"));
    }
    const Index crossings = detail::count_crossings(graph, distance);
    require(crossings == 0, name, "segments that meet at their ends only",
            text(crossings, crossings == 1 ? " pair" : " pairs", " that cross, touch or overlap"));
    result.segments = unique;
    result.holes = outline.holes;
    return result;
}

SPRINGFIT_CGAL_INLINE Outline read_outline(const std::filesystem::path& path) {
    const io::OutlineFile file = io::read_outline_file(path);
    Outline outline{detail::columns(file.points), detail::columns(file.segments), detail::columns(file.holes)};
    outline = checked(outline, file.file);
    if (!file.areas.empty()) { // what lies in none of the areas is a hole
        const double unit = detail::body_unit<2>(outline.points);
        const Points<2, double> points = detail::in_unit<2>(detail::columns(file.points), unit);
        Outline scaled = outline;
        scaled.points = detail::in_unit<2>(outline.points, unit);
        std::vector<std::array<double, 2>> holes;
        for (const auto& point : detail::PlaneMesher(detail::plane_graph(scaled)).region_points()) {
            const Vector<2, double> p(point.x(), point.y());
            if (std::none_of(file.areas.begin(), file.areas.end(),
                             [&](const auto& area) { return detail::is_in_area(points, area, p); })) {
                holes.push_back({p.x() * unit, p.y() * unit});
            }
        }
        outline.holes = detail::columns(holes);
    }
    return outline;
}

template <std::floating_point Scalar>
Mesh<2, Scalar, Tri3> triangulate(const Outline& outline, const TriangulateOptions& options) {
    detail::check(options);
    return detail::triangulate<Scalar>(outline, options, "outline");
}

template <std::floating_point Scalar>
Mesh<2, Scalar, Tri3> triangulate(const std::filesystem::path& path, const TriangulateOptions& options) {
    detail::check(options);
    return detail::triangulate<Scalar>(read_outline(path), options, path.string());
}

} // namespace springfit::cgal
