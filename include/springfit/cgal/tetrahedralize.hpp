// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#ifndef SPRINGFIT_COMPILED_CGAL // first: CGAL's mesher gives other meshes after CGAL's polygon mesh processing
#include <springfit/cgal/detail/mesh_3.hpp>
#include <springfit/cgal/detail/remove_slivers.hpp>
#endif

#include <springfit/cgal/surface.hpp>
#include <springfit/core/progress.hpp>

namespace springfit::cgal {

/// How a solid is cut into tetrahedra. Give `cell_size` or `n_nodes`, not both.
struct TetrahedralizeOptions {
    double cell_size = 0; ///< wanted mean edge length, m, > 0
    Index n_nodes = 0;    ///< wanted number of nodes, 4 to 2e7; met within 10 % where shape and sharp edges allow;
                          ///< up to four times as many where thin parts fell apart
    double sharp_edge_angle = 60; ///< edges whose faces' normals differ by more are kept, degrees, in (0, 180]
    double surface_distance =
        0;                    ///< farthest that the mesh's surface lies from the given one, m, >= 0; 0: cell_size / 5
    double sliver_angle = 12; ///< dihedral angles below this are removed as far as possible, degrees, >= 0; 0: none
    bool several_pieces = false; ///< accept a mesh of more pieces than the surface bounds; if not, crumbs are left out
    unsigned seed = 0;           ///< of the mesher's random numbers; the same seed gives the same mesh
    RepairOptions repair{};      ///< of the surface, before it is meshed
    ProgressCallback progress{}; ///< called after each meshing; returning false takes the best mesh so far as it is
};

/// Cuts the inside of a closed surface into tetrahedra by Delaunay refinement, its sharp edges kept.
///
/// The same input gives the same mesh. Where sharp edges nearly meet, and would take ten times the nodes wanted or
/// more, none are kept. Throws InvalidArgument for an option out of range, for a surface that does not
/// bound a solid (open, self-intersecting, without volume: what is wrong and how many), where no tetrahedron fits, and
/// where the mesh falls into more pieces than the surface has (those below 1 % of the volume are left out). O(n_nodes
/// log n_nodes) per meshing, of which a wanted `n_nodes` takes two or three as a rule.
template <std::floating_point Scalar>
[[nodiscard]] Mesh<3, Scalar, Tet4> tetrahedralize(const Surface& surface, const TetrahedralizeOptions& options);

/// Reads a surface (OFF, OBJ, STL, PLY) and cuts its inside into tetrahedra:
///
///     auto mesh = springfit::cgal::tetrahedralize<double>("elephant.off", {.n_nodes = 2000});
///
/// Throws FileError as `read_surface` does, and InvalidArgument as above.
template <std::floating_point Scalar>
[[nodiscard]] Mesh<3, Scalar, Tet4> tetrahedralize(const std::filesystem::path& path,
                                                   const TetrahedralizeOptions& options);

} // namespace springfit::cgal

#ifndef SPRINGFIT_COMPILED_CGAL
#include <springfit/cgal/detail/tetrahedralize_impl.hpp>
#endif
