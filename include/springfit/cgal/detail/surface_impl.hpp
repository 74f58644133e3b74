// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CGAL/Polygon_mesh_processing/detect_features.h>

#include <springfit/cgal/detail/repair_surface.hpp>
#include <springfit/cgal/detail/solid_surface.hpp>
#include <springfit/cgal/surface.hpp>

namespace springfit::cgal {

namespace detail {

/// `for_mesher`: the points are rounded to the mesher's grid first.
[[nodiscard]] inline TriangleSurface repaired(const Surface& surface, const RepairOptions& options,
                                              bool for_mesher = false) {
    require(options.max_hole_edges >= 0, "max_hole_edges", "a number of edges not below 0", options.max_hole_edges);
    PolygonSoup soup = to_soup(surface);
    if (for_mesher) {
        round_to_grid(soup);
    }
    auto result = repaired(std::move(soup), options.max_hole_edges, "surface");
    require(result.number_of_faces() > 0, "surface", "triangles with an area", "degenerate ones only");
    return result;
}

[[nodiscard]] inline TriangleSurface read_repaired(const std::filesystem::path& path, const RepairOptions& options,
                                                   bool for_mesher = false) {
    require(options.max_hole_edges >= 0, "max_hole_edges", "a number of edges not below 0", options.max_hole_edges);
    PolygonSoup soup = to_soup(io::read_surface_file(path));
    if (for_mesher) {
        round_to_grid(soup);
    }
    auto result = repaired(std::move(soup), options.max_hole_edges, path.string());
    if (result.number_of_faces() == 0) {
        throw FileError(path.string(), "empty surface: every face is degenerate");
    }
    return result;
}

[[nodiscard]] inline SurfaceExamination examine(const TriangleSurface& surface) {
    namespace pmp = CGAL::Polygon_mesh_processing;
    SurfaceExamination found;
    for (const auto hole : holes(surface)) {
        ++found.holes;
        found.boundary_edges += hole_edges(surface, hole);
    }
    std::vector<std::pair<TriangleSurface::Face_index, TriangleSurface::Face_index>> crossings;
    pmp::self_intersections(surface, std::back_inserter(crossings));
    found.self_intersections = static_cast<Index>(crossings.size());
    std::vector<std::size_t> piece(surface.number_of_faces());
    found.pieces = static_cast<Index>(pmp::connected_components(
        surface, boost::make_function_property_map<TriangleSurface::Face_index, std::size_t&>(
                     [&](TriangleSurface::Face_index f) -> std::size_t& { return piece[f]; })));
    if (found.holes == 0) {
        found.volume = pmp::volume(surface);
        found.bounds_volume = found.self_intersections == 0 && found.volume > 0 && pmp::does_bound_a_volume(surface);
    }
    return found;
}

/// The extent of some vertices along each axis, m.
template <class Vertices>
[[nodiscard]] std::array<double, 3> extent(const TriangleSurface& surface, const Vertices& vertices) {
    CGAL::Bbox_3 box;
    for (const auto v : vertices) {
        box += surface.point(v).bbox();
    }
    return {box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin()};
}

/// An open surface in words: how many edges bound how many holes, how large the largest is, and whether it is a sheet,
/// which is as wide as its hole.
[[nodiscard]] inline std::string open_in_words(const TriangleSurface& surface, const SurfaceExamination& found) {
    const auto size = [](const std::array<double, 3>& box) { return std::hypot(box[0], box[1], box[2]); };
    std::array<double, 3> largest{};
    for (const auto hole : holes(surface)) {
        const auto box = extent(surface, CGAL::vertices_around_face(hole, surface));
        largest = size(box) > size(largest) ? box : largest;
    }
    const auto whole = extent(surface, surface.vertices());
    bool is_sheet = true;
    for (std::size_t d = 0; d < 3; ++d) {
        is_sheet = is_sheet && largest[d] >= 0.9 * whole[d];
    }
    if (is_sheet) {
        return text("a sheet: ", found.boundary_edges, " boundary edges, ", size(largest),
                    " across (it would be a membrane; a volume is needed)");
    }
    return text("an open one: ", found.boundary_edges, " boundary edges around ", found.holes,
                found.holes == 1 ? " hole, " : " holes, the largest ", size(largest), " across (the surface is ",
                size(whole), "); close it first, or fill its holes (--fill-holes)");
}

inline SurfaceExamination require_solid(const TriangleSurface& surface, std::string_view name) {
    const SurfaceExamination found = examine(surface);
    require(found.holes == 0, name, "a closed surface", found.holes == 0 ? "" : open_in_words(surface, found));
    require(
        found.self_intersections == 0, name, "a surface that does not cross itself",
        text(found.self_intersections, found.self_intersections == 1 ? " pair" : " pairs", " of intersecting faces"));
    require(found.bounds_volume, name, "a surface that bounds a volume", text("volume ", found.volume));
    return found;
}

[[nodiscard]] inline std::vector<std::array<int, 2>> sharp_edges(const TriangleSurface& surface, double angle) {
    std::vector<char> sharp(surface.number_of_edges(), 0);
    CGAL::Polygon_mesh_processing::detect_sharp_edges(
        surface, angle,
        boost::make_function_property_map<TriangleSurface::Edge_index, char&>(
            [&](TriangleSurface::Edge_index e) -> char& { return sharp[e]; }));
    std::vector<std::array<int, 2>> pairs;
    for (const auto edge : surface.edges()) {
        if (sharp[edge] != 0) {
            pairs.push_back({static_cast<int>(surface.vertex(edge, 0)), static_cast<int>(surface.vertex(edge, 1))});
        }
    }
    return pairs;
}

[[nodiscard]] inline SolidSurface solid_surface(const TriangleSurface& surface, double sharp_edge_angle,
                                                std::string_view name) {
    const double volume = require_solid(surface, name).volume;
    return {to_arrays(surface), volume, CGAL::Polygon_mesh_processing::area(surface),
            sharp_edges(surface, sharp_edge_angle)};
}

SPRINGFIT_CGAL_INLINE SolidSurface solid_surface(const Surface& surface, const RepairOptions& options,
                                                 double sharp_edge_angle, std::string_view name) {
    return solid_surface(repaired(surface, options, true), sharp_edge_angle, name);
}

SPRINGFIT_CGAL_INLINE SolidSurface read_solid_surface(const std::filesystem::path& path, const RepairOptions& options,
                                                      double sharp_edge_angle) {
    return solid_surface(read_repaired(path, options, true), sharp_edge_angle, path.string());
}

} // namespace detail

SPRINGFIT_CGAL_INLINE Surface repair(const Surface& surface, const RepairOptions& options) {
    return detail::to_arrays(detail::repaired(surface, options));
}

SPRINGFIT_CGAL_INLINE Surface read_surface(const std::filesystem::path& path, const RepairOptions& options) {
    return detail::to_arrays(detail::read_repaired(path, options));
}

SPRINGFIT_CGAL_INLINE SurfaceExamination examine(const Surface& surface) {
    return detail::examine(detail::repaired(surface, {}));
}

SPRINGFIT_CGAL_INLINE SurfaceExamination require_solid(const Surface& surface, std::string_view name) {
    return detail::require_solid(detail::repaired(surface, {}), name);
}

} // namespace springfit::cgal
