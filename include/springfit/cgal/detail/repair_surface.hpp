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
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <springfit/cgal/detail/read_polygons.hpp>
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

/// Merges points, orients and stitches the polygons, cuts them into triangles, drops degenerate ones, fills the holes
/// of at most `max_hole_edges` edges, and turns a closed surface outwards.
inline TriangleSurface repaired(PolygonSoup soup, int max_hole_edges) {
    namespace pmp = CGAL::Polygon_mesh_processing;
    pmp::repair_polygon_soup(soup.points, soup.polygons);
    pmp::orient_polygon_soup(soup.points, soup.polygons);
    TriangleSurface surface;
    pmp::polygon_soup_to_polygon_mesh(soup.points, soup.polygons, surface);
    pmp::stitch_borders(surface);
    pmp::triangulate_faces(surface);
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
    for (Index i = 0; i < mesh.n_nodes(); ++i) {
        soup.points.emplace_back(mesh.nodes(0, i), mesh.nodes(1, i), mesh.nodes(2, i));
    }
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        soup.polygons.push_back({static_cast<std::size_t>(mesh.cells(0, c)), static_cast<std::size_t>(mesh.cells(1, c)),
                                 static_cast<std::size_t>(mesh.cells(2, c))});
    }
    return soup;
}

} // namespace springfit::cgal::detail
