// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <springfit/cgal/detail/cut_polygons.hpp>
#include <springfit/io/surface_file.hpp>
#include <springfit/mesh/mesh.hpp>

namespace springfit::cgal::detail {

using TriangleSurface = CGAL::Surface_mesh<Kernel::Point_3>;

inline std::vector<TriangleSurface::Halfedge_index> holes(const TriangleSurface& surface) {
    std::vector<TriangleSurface::Halfedge_index> cycles;
    CGAL::Polygon_mesh_processing::extract_boundary_cycles(surface, std::back_inserter(cycles));
    return cycles;
}

inline bool is_closed(const TriangleSurface& surface) {
    return CGAL::is_closed(surface);
}

inline Index hole_edges(const TriangleSurface& surface, TriangleSurface::Halfedge_index hole) {
    Index n = 0;
    for ([[maybe_unused]] const auto halfedge : CGAL::halfedges_around_face(hole, surface)) {
        ++n;
    }
    return n;
}

/// Merges points, cuts polygons into triangles, orients and stitches them, drops degenerate ones, fills the holes of at
/// most `max_hole_edges` edges, and turns a closed surface outwards. Throws InvalidArgument, naming `name`, for faces
/// that cross themselves and for a body too large or too small to compute with.
inline TriangleSurface repaired(PolygonSoup soup, int max_hole_edges, std::string_view name) {
    namespace pmp = CGAL::Polygon_mesh_processing;
    merge_near_points(soup, name);
    cut_polygons(soup, name);
    std::vector<Kernel::Point_3> points;
    for (const auto& p : soup.points) {
        points.emplace_back(p[0], p[1], p[2]);
    }
    pmp::repair_polygon_soup(points, soup.polygons);
    pmp::orient_polygon_soup(points, soup.polygons);
    TriangleSurface surface;
    pmp::polygon_soup_to_polygon_mesh(points, soup.polygons, surface);
    pmp::stitch_borders(surface);
    pmp::remove_degenerate_faces(surface);
    for (const auto hole : holes(surface)) {
        if (hole_edges(surface, hole) <= max_hole_edges) {
            std::vector<TriangleSurface::Face_index> patch;
            pmp::triangulate_hole(surface, hole, std::back_inserter(patch));
        }
    }
    pmp::remove_isolated_vertices(surface);
    surface.collect_garbage();
    if (surface.number_of_faces() > 0 && is_closed(surface) && !pmp::does_self_intersect(surface)) {
        pmp::orient_to_bound_a_volume(surface);
    }
    return surface;
}

/// The plain arrays of a surface.
inline Mesh<3, double, Tri3> to_arrays(const TriangleSurface& surface) {
    Mesh<3, double, Tri3> mesh;
    mesh.nodes.resize(3, static_cast<Index>(surface.number_of_vertices()));
    mesh.cells.resize(3, static_cast<Index>(surface.number_of_faces()));
    for (const auto v : surface.vertices()) {
        const auto& p = surface.point(v);
        mesh.nodes.col(static_cast<Index>(v)) << p.x(), p.y(), p.z();
    }
    for (const auto f : surface.faces()) {
        int a = 0;
        for (const auto v : surface.vertices_around_face(surface.halfedge(f))) {
            mesh.cells(a++, static_cast<Index>(f)) = static_cast<int>(v);
        }
    }
    return mesh;
}

inline PolygonSoup to_soup(const Mesh<3, double, Tri3>& mesh) {
    validate(mesh);
    PolygonSoup soup;
    for (const auto& p : mesh.nodes.colwise()) {
        soup.points.push_back({p.x(), p.y(), p.z()});
    }
    for (const auto& c : mesh.cells.colwise()) {
        soup.polygons.push_back(
            {static_cast<std::size_t>(c(0)), static_cast<std::size_t>(c(1)), static_cast<std::size_t>(c(2))});
    }
    return soup;
}

inline PolygonSoup to_soup(io::SurfaceFile file) {
    PolygonSoup soup{std::move(file.points), {}};
    for (const auto& polygon : file.polygons) {
        soup.polygons.emplace_back(polygon.begin(), polygon.end());
    }
    return soup;
}

} // namespace springfit::cgal::detail
