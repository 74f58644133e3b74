// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

#include <springfit/cgal/detail/inline.hpp>
#include <springfit/mesh/mesh.hpp>

namespace springfit::cgal {

/// A triangle surface in space on plain arrays: points `[3 x n_nodes]`, m, and triangles `[3 x n_cells]`.
using Surface = Mesh<3, double, Tri3>;

/// Repairs beyond the usual ones (points nearer than 1e-6 of the largest extent merged, faces oriented alike, stitched,
/// cut into triangles, degenerate and repeated faces dropped).
struct RepairOptions {
    int max_hole_edges = 0; ///< holes with at most this many boundary edges are filled, >= 0; 0 leaves all open
};

/// Properties of a surface; a solid can be meshed where `bounds_volume` is true.
struct SurfaceExamination {
    Index boundary_edges = 0;     ///< edges with a face on one side only
    Index holes = 0;              ///< closed loops of such edges
    Index self_intersections = 0; ///< pairs of faces that cross or overlap
    Index pieces = 0;             ///< parts that no edge joins
    double volume = 0;            ///< enclosed volume, m^3; 0 for an open surface
    bool bounds_volume = false;   ///< closed, free of self-intersections, with a volume
};

/// A repaired copy of a surface; closed ones come back with their normals outwards.
///
/// Throws InvalidArgument for arrays that do not fit together, for coordinates that are not finite, for a body of a
/// size outside 1e-30 to 1e30 m, and where nothing but degenerate triangles was given. O(n log n).
[[nodiscard]] SPRINGFIT_CGAL_INLINE Surface repair(const Surface& surface, const RepairOptions& options = {});

/// Reads and repairs a surface: OFF, OBJ, STL or PLY, text or binary, told apart by the extension.
///
/// Open surfaces are fine here (`require_solid` refuses them). Throws FileError as `io::read_surface_file`, and
/// InvalidArgument, naming the file, as above and for a face that crosses or touches itself.
[[nodiscard]] SPRINGFIT_CGAL_INLINE Surface read_surface(const std::filesystem::path& path,
                                                         const RepairOptions& options = {});

/// Reads a surface as the mesh of a membrane or cloth.
template <std::floating_point Scalar>
[[nodiscard]] Mesh<3, Scalar, Tri3> surface_mesh(const std::filesystem::path& path, const RepairOptions& options = {}) {
    const Surface surface = read_surface(path, options);
    return {surface.nodes.cast<Scalar>(), surface.cells};
}

/// Counts what keeps a surface, repaired, from bounding a solid. O(n log n).
[[nodiscard]] SPRINGFIT_CGAL_INLINE SurfaceExamination examine(const Surface& surface);

/// Throws InvalidArgument, saying what is wrong and how many, unless the surface bounds a solid.
SPRINGFIT_CGAL_INLINE SurfaceExamination require_solid(const Surface& surface, std::string_view name = "surface");

} // namespace springfit::cgal

#ifndef SPRINGFIT_COMPILED_CGAL
#include <springfit/cgal/detail/surface_impl.hpp>
#endif
