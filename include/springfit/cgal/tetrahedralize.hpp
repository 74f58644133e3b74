// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cgal/detail/clean_solid.hpp>
#include <springfit/cgal/detail/mesh_3.hpp>
#include <springfit/cgal/detail/size_search.hpp>
#include <springfit/cgal/surface.hpp>
#include <springfit/core/progress.hpp>

namespace springfit::cgal {

/// How a solid is cut into tetrahedra. Give `cell_size` or `n_nodes`, not both.
struct TetrahedralizeOptions {
    double cell_size = 0;         ///< wanted mean edge length, m, > 0
    Index n_nodes = 0;            ///< wanted number of nodes, >= 4; met within 10 % where shape and sharp edges allow
    double sharp_edge_angle = 60; ///< edges whose faces' normals differ by more are kept, degrees, in (0, 180]
    double surface_distance =
        0;                    ///< farthest that the mesh's surface lies from the given one, m, >= 0; 0: cell_size / 5
    double sliver_angle = 12; ///< dihedral angles below this are removed as far as possible, degrees, >= 0; 0: none
    bool several_pieces = false; ///< accept a mesh of several pieces that no face joins; if not, crumbs are left out
    unsigned seed = 0;           ///< of the mesher's random numbers; the same seed gives the same mesh
    RepairOptions repair{};      ///< of the surface, before it is meshed
    ProgressCallback progress{}; ///< called after each meshing; returning false takes the best mesh so far as it is
};

namespace detail {

/// Flatter cells that lie on the surface are taken off, degrees.
inline constexpr double flake_angle = 2;
/// Pieces that hold less than this share of the volume are taken off, where one piece is wanted.
inline constexpr double crumb_share = 0.01;

inline void check(const TetrahedralizeOptions& options) {
    const bool by_size = options.cell_size != 0;
    require(by_size != (options.n_nodes != 0), "cell_size, n_nodes", "one of the two", by_size ? "both" : "neither");
    require(!by_size || (options.cell_size > 0 && std::isfinite(options.cell_size)), "cell_size", "a positive length",
            options.cell_size);
    require(by_size || options.n_nodes >= 4, "n_nodes", "at least the 4 of one tetrahedron", options.n_nodes);
    require(options.sharp_edge_angle > 0 && options.sharp_edge_angle <= 180, "sharp_edge_angle",
            "an angle in (0, 180] degrees", options.sharp_edge_angle);
    require(options.surface_distance >= 0 && std::isfinite(options.surface_distance), "surface_distance",
            "a length not below 0", options.surface_distance);
    require(options.sliver_angle >= 0 && options.sliver_angle <= 45, "sliver_angle", "an angle in [0, 45] degrees",
            options.sliver_angle);
}

/// Throws InvalidArgument unless there are cells, all of positive volume, in one piece if that is asked for.
template <std::floating_point Scalar>
void check_result(const Mesh<3, Scalar, Tet4>& mesh, const TetrahedralizeOptions& options) {
    const std::string_view size = options.cell_size != 0 ? "cell_size" : "n_nodes";
    require(mesh.n_cells() > 0, size, "a size at which the solid holds a tetrahedron", "none");
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const auto x = mesh.cell_nodes(c);
        const Scalar volume = (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).dot(x.col(3) - x.col(0)) / 6;
        if (!(volume > 0)) {
            throw InvalidArgument(size, "tetrahedra of positive volume", text("volume ", volume, " in cell ", c));
        }
    }
    if (!options.several_pieces) {
        const Index pieces = n_pieces(mesh);
        require(pieces == 1, size, "a mesh of one piece (finer cells join thin parts; several_pieces accepts more)",
                text(pieces, " pieces"));
    }
}

/// Meshes at the wanted size, or at sizes that approach the wanted number of nodes, and removes slivers.
[[nodiscard]] inline Mesh<3, double, Tet4> refined_solid(const TriangleSurface& surface, double volume,
                                                         const TetrahedralizeOptions& options) {
    const double area = CGAL::Polygon_mesh_processing::area(surface);
    SolidMesher mesher(surface, options.sharp_edge_angle, options.seed);
    bool interrupted = false;
    const auto report = [&](double fraction) {
        interrupted = !go_on(options.progress, "mesh", fraction);
        return !interrupted;
    };
    const auto mesh_at = [&](double size) {
        return mesher.refined(size, options.surface_distance > 0 ? options.surface_distance : size / 5);
    };
    // Nodes at edge length h: about 1.4 V / h^3 inside and 0.6 A / h^2 on the surface.
    const auto nodes_at = [&](double h) { return 1.4 * volume / (h * h * h) + 0.6 * area / (h * h); };
    auto complex = options.cell_size > 0
                       ? mesh_at(options.cell_size)
                       : mesh_with_nodes(options.n_nodes,
                                         size_where(nodes_at, static_cast<double>(options.n_nodes), std::cbrt(volume)),
                                         3, mesh_at, count_nodes, [&](double share) { return report(0.7 * share); });
    if (!interrupted && report(0.7) && options.sliver_angle > 0) {
        mesher.remove_slivers(complex, options.sliver_angle);
    }
    (void)go_on(options.progress, "mesh", 1);
    return to_mesh(complex);
}

template <std::floating_point Scalar>
[[nodiscard]] Mesh<3, Scalar, Tet4> tetrahedralize(const TriangleSurface& surface, const TetrahedralizeOptions& options,
                                                   std::string_view name) {
    const double volume = require_solid(surface, name).volume;
    Mesh<3, double, Tet4> solid;
    try {
        solid = without_flakes(refined_solid(surface, volume, options), flake_angle);
    } catch (const CGAL::Failure_exception& failure) {
        throw InvalidArgument(name, "a surface that CGAL's mesher can follow", failure.message());
    }
    if (!options.several_pieces) {
        solid = without_crumbs(solid, crumb_share);
    }
    Mesh<3, Scalar, Tet4> mesh{solid.nodes.cast<Scalar>(), solid.cells};
    check_result(mesh, options);
    return mesh;
}

} // namespace detail

/// Cuts the inside of a closed surface into tetrahedra by Delaunay refinement, its sharp edges kept.
///
/// The same input gives the same mesh. Throws InvalidArgument for an option out of range, for a surface that does not
/// bound a solid (open, self-intersecting, without volume: what is wrong and how many), where no tetrahedron fits, and
/// where the mesh falls into pieces (those below 1 % of the volume are left out). O(n_nodes log n_nodes) per meshing,
/// of which a wanted `n_nodes` takes two or three as a rule.
template <std::floating_point Scalar>
[[nodiscard]] Mesh<3, Scalar, Tet4> tetrahedralize(const Surface& surface, const TetrahedralizeOptions& options) {
    detail::check(options);
    return detail::tetrahedralize<Scalar>(detail::repaired(surface, options.repair), options, "surface");
}

/// Reads a surface (OFF, OBJ, STL, PLY) and cuts its inside into tetrahedra:
///
///     auto mesh = springfit::cgal::tetrahedralize<double>("elephant.off", {.n_nodes = 2000});
///
/// Throws FileError as `read_surface` does, and InvalidArgument as above.
template <std::floating_point Scalar>
[[nodiscard]] Mesh<3, Scalar, Tet4> tetrahedralize(const std::filesystem::path& path,
                                                   const TetrahedralizeOptions& options) {
    detail::check(options);
    return detail::tetrahedralize<Scalar>(detail::read_repaired(path, options.repair), options, path.string());
}

} // namespace springfit::cgal
