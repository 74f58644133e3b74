// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cgal/detail/repair_surface.hpp>

namespace springfit::cgal {

/// A triangle surface in space on plain arrays: points `[3 x n_nodes]`, m, and triangles `[3 x n_cells]`.
using Surface = Mesh<3, double, Tri3>;

/// What is mended beyond the usual (points given twice merged, faces oriented alike, stitched, cut into triangles,
/// degenerate and repeated faces dropped).
struct RepairOptions {
    int max_hole_edges = 0; ///< holes with at most this many boundary edges are filled, >= 0; 0 leaves all open
};

/// What a surface is like; a solid can be meshed where `bounds_volume` is true.
struct SurfaceExamination {
    Index boundary_edges = 0;     ///< edges with a face on one side only
    Index holes = 0;              ///< closed loops of such edges
    Index self_intersections = 0; ///< pairs of faces that cross or overlap
    Index pieces = 0;             ///< parts that no edge joins
    double volume = 0;            ///< enclosed volume, m^3; 0 for an open surface
    bool bounds_volume = false;   ///< closed, free of self-intersections, with a volume
};

namespace detail {

[[nodiscard]] inline TriangleSurface repaired(const Surface& surface, const RepairOptions& options) {
    require(options.max_hole_edges >= 0, "max_hole_edges", "a number of edges not below 0", options.max_hole_edges);
    auto result = repaired(to_soup(surface), options.max_hole_edges);
    require(result.number_of_faces() > 0, "surface", "triangles with an area", "degenerate ones only");
    return result;
}

[[nodiscard]] inline TriangleSurface read_repaired(const std::filesystem::path& path, const RepairOptions& options) {
    require(options.max_hole_edges >= 0, "max_hole_edges", "a number of edges not below 0", options.max_hole_edges);
    auto result = repaired(read_polygons(path), options.max_hole_edges);
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

inline SurfaceExamination require_solid(const TriangleSurface& surface, std::string_view name) {
    const SurfaceExamination found = examine(surface);
    require(found.holes == 0, name, "a closed surface",
            text("an open one: ", found.boundary_edges, " boundary edges around ", found.holes,
                 found.holes == 1 ? " hole" : " holes"));
    require(
        found.self_intersections == 0, name, "a surface that does not cross itself",
        text(found.self_intersections, found.self_intersections == 1 ? " pair" : " pairs", " of intersecting faces"));
    require(found.bounds_volume, name, "a surface that bounds a volume", text("volume ", found.volume));
    return found;
}

} // namespace detail

/// A repaired copy of a surface; closed ones come back with their normals outwards.
///
/// Throws InvalidArgument for arrays that do not fit together, for coordinates that are not finite, and where nothing
/// but degenerate triangles was given. O(n log n).
[[nodiscard]] inline Surface repair(const Surface& surface, const RepairOptions& options = {}) {
    return detail::to_arrays(detail::repaired(surface, options));
}

/// Reads and repairs a surface: OFF, OBJ, STL or PLY, text or binary, told apart by the extension.
///
/// Open surfaces are fine here (`require_solid` refuses them). Throws FileError for a missing, unreadable or empty file
/// and for a coordinate that is not finite, with the line where the file is text.
[[nodiscard]] inline Surface read_surface(const std::filesystem::path& path, const RepairOptions& options = {}) {
    return detail::to_arrays(detail::read_repaired(path, options));
}

/// Reads a surface as the mesh of a membrane or cloth.
template <std::floating_point Scalar>
[[nodiscard]] Mesh<3, Scalar, Tri3> surface_mesh(const std::filesystem::path& path, const RepairOptions& options = {}) {
    const Surface surface = read_surface(path, options);
    return {surface.nodes.cast<Scalar>(), surface.cells};
}

/// Counts what keeps a surface, repaired, from bounding a solid. O(n log n).
[[nodiscard]] inline SurfaceExamination examine(const Surface& surface) {
    return detail::examine(detail::repaired(surface, {}));
}

/// Throws InvalidArgument, saying what is wrong and how many, unless the surface bounds a solid.
inline SurfaceExamination require_solid(const Surface& surface, std::string_view name = "surface") {
    return detail::require_solid(detail::repaired(surface, {}), name);
}

} // namespace springfit::cgal
