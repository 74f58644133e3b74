// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cgal/detail/body_unit.hpp>
#include <springfit/cgal/detail/clean_solid.hpp>
#include <springfit/cgal/detail/pieces.hpp>
#include <springfit/cgal/detail/sharp_edges.hpp>
#include <springfit/cgal/detail/size_search.hpp>
#include <springfit/cgal/detail/solid_mesher.hpp>
#include <springfit/cgal/detail/solid_surface.hpp>
#include <springfit/cgal/tetrahedralize.hpp>

namespace springfit::cgal {

namespace detail {

/// Flatter cells that lie on the surface are taken off, degrees.
inline constexpr double flake_angle = 2;
/// Pieces that hold less than this share of the volume are taken off, where one piece is wanted.
inline constexpr double crumb_share = 0.01;

/// A body is refused where one cell across its mean thickness would make so many times the most nodes.
inline constexpr double far_too_thin = 100;

/// Where thin parts fall apart, up to so many times the wanted nodes are tried, half as many more each time.
inline constexpr Index most_more_nodes = 4;

inline void check(const TetrahedralizeOptions& options) {
    const bool by_size = options.cell_size != 0;
    require(by_size != (options.n_nodes != 0), "cell_size, n_nodes", "one of the two", by_size ? "both" : "neither");
    require(!by_size || (options.cell_size > 0 && std::isfinite(options.cell_size)), "cell_size", "a positive length",
            options.cell_size);
    require(by_size || options.n_nodes >= 4, "n_nodes", "at least the 4 of one tetrahedron", options.n_nodes);
    require(options.n_nodes <= most_nodes, "n_nodes", text("at most ", most_nodes), options.n_nodes);
    require(options.sharp_edge_angle > 0 && options.sharp_edge_angle <= 180, "sharp_edge_angle",
            "an angle in (0, 180] degrees", options.sharp_edge_angle);
    require(options.surface_distance >= 0 && std::isfinite(options.surface_distance), "surface_distance",
            "a length not below 0", options.surface_distance);
    require(options.sliver_angle >= 0 && options.sliver_angle <= 45, "sliver_angle", "an angle in [0, 45] degrees",
            options.sliver_angle);
}

/// Throws InvalidArgument unless there are cells, all of positive volume, in no more than `n_bodies` pieces if that is
/// asked for.
template <std::floating_point Scalar>
void check_result(const Mesh<3, Scalar, Tet4>& mesh, const TetrahedralizeOptions& options, Index n_bodies) {
    const std::string_view size = options.cell_size != 0 ? "cell_size" : "n_nodes";
    require(mesh.n_cells() > 0, size, "a size at which the solid holds a tetrahedron", "none");
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const Scalar volume = signed_volume<3, Scalar>(mesh.cell_nodes(c));
        if (!(volume > 0)) {
            throw InvalidArgument(size, "tetrahedra of positive volume", text("volume ", volume, " in cell ", c));
        }
    }
    if (!options.several_pieces) {
        const Index pieces = n_pieces(mesh);
        require(pieces <= n_bodies, size,
                text("a mesh of ", n_bodies == 1 ? "one piece" : text(n_bodies, " pieces"),
                     ", as the surface bounds (more nodes join thin parts)"),
                text(pieces, " pieces"));
    }
}

/// For each triangle the number of its piece of the surface, from 1 in the order of the triangles.
[[nodiscard]] inline std::vector<int> numbered_pieces(const Surface& surface) {
    std::vector<int> patch = pieces(surface);
    int n_pieces = 0;
    for (std::size_t c = 0; c < patch.size(); ++c) { // a piece goes by its first triangle
        const auto first = static_cast<std::size_t>(patch[c]);
        patch[c] = first == c ? ++n_pieces : patch[first];
    }
    return patch;
}

[[nodiscard]] inline CellList<3> cell_list(const Surface& surface) {
    CellList<3> list;
    for (const auto& p : surface.nodes.colwise()) {
        list.points.push_back({p.x(), p.y(), p.z()});
    }
    for (const auto& c : surface.cells.colwise()) {
        list.cells.push_back({c(0), c(1), c(2)});
    }
    return list;
}

[[nodiscard]] inline Solid to_mesh(const CellList<4>& list) {
    Solid mesh;
    mesh.nodes.resize(3, static_cast<Index>(list.points.size()));
    for (std::size_t i = 0; i < list.points.size(); ++i) {
        mesh.nodes.col(static_cast<Index>(i)) << list.points[i][0], list.points[i][1], list.points[i][2];
    }
    mesh.cells.resize(4, static_cast<Index>(list.cells.size()));
    for (std::size_t c = 0; c < list.cells.size(); ++c) {
        const auto& cell = list.cells[c];
        mesh.cells.col(static_cast<Index>(c)) << cell[0], cell[1], cell[2], cell[3];
    }
    return mesh;
}

/// Nodes at edge length h: about 1.4 V / h^3 inside and 0.6 A / h^2 on the surface.
[[nodiscard]] inline double expected_nodes(const SolidSurface& solid, double h) {
    return 1.4 * solid.volume / (h * h * h) + 0.6 * solid.area / (h * h);
}

/// Nodes at which meshing ends. Throws TooManyNodes for a body that is far too thin for them: CGAL may not come to an
/// end there.
[[nodiscard]] inline std::size_t node_limit(const SolidSurface& solid, double wanted) {
    const double limit = few_nodes + far_more_nodes * wanted;
    const double thickness = 2 * solid.volume / solid.area;
    const double needed = expected_nodes(solid, thickness);
    if (!(needed <= far_too_thin * limit)) {
        throw TooManyNodes(text("a mean thickness of ", thickness, " of its extent, which takes some ", needed));
    }
    return static_cast<std::size_t>(limit);
}

/// Meshes at the wanted size, or at sizes that approach the wanted number of nodes, and removes slivers.
[[nodiscard]] inline Solid refined_solid(const SolidSurface& solid, const TetrahedralizeOptions& options) {
    const auto nodes_at = [&](double h) { return expected_nodes(solid, h); };
    // Sharp edges are kept in networks at least this many cells long, without dangling branches shorter than that: a
    // mesh could not show shorter ones.
    constexpr double shortest_network = 4;
    constexpr double shortest_branch = 1;
    const SharpEdges all_edges(solid, options.sharp_edge_angle);
    SolidMesher mesher(cell_list(solid.surface), numbered_pieces(solid.surface), options.seed);
    bool interrupted = false;
    const auto report = [&](double fraction) {
        interrupted = !go_on(options.progress, "mesh", fraction);
        return !interrupted;
    };
    const std::size_t limit =
        node_limit(solid, options.cell_size > 0 ? nodes_at(options.cell_size) : static_cast<double>(options.n_nodes));
    bool keeps_edges = true;
    const auto mesh_at = [&](double size) {
        const double distance = options.surface_distance > 0 ? options.surface_distance : size / 5;
        if (keeps_edges) {
            SharpEdges edges = all_edges;
            edges.drop_short(shortest_branch * size, shortest_network * size);
            try {
                return mesher.refined(size, distance, edges.lines(), limit);
            } catch (const TooManyNodes&) {
                keeps_edges = false; // they run nearer to each other than cells can follow
            }
        }
        return mesher.refined(size, distance, {}, limit);
    };
    const auto complex =
        options.cell_size > 0
            ? mesh_at(options.cell_size)
            : mesh_with_nodes(
                  options.n_nodes, size_where(nodes_at, static_cast<double>(options.n_nodes), std::cbrt(solid.volume)),
                  3, mesh_at, [](const auto& mesh) { return static_cast<Index>(count_nodes(*mesh)); },
                  [&](double share) { return report(0.7 * share); });
    if (!interrupted && report(0.7) && options.sliver_angle > 0) {
        mesher.remove_slivers(*complex, options.sliver_angle);
    }
    (void)go_on(options.progress, "mesh", 1);
    return to_mesh(cell_list(*complex));
}

template <std::floating_point Scalar>
[[nodiscard]] Mesh<3, Scalar, Tet4> tetrahedralize(SolidSurface surface, TetrahedralizeOptions options,
                                                   std::string_view name) {
    const double unit = body_unit<3>(surface.surface.nodes);
    surface.surface.nodes = in_unit<3>(surface.surface.nodes, unit);
    surface.volume = in_unit(surface.volume, unit * unit * unit);
    surface.area = in_unit(surface.area, unit * unit);
    options.cell_size /= unit;
    options.surface_distance /= unit;
    check_cell_size(options.cell_size, unit, [&](double h) { return expected_nodes(surface, h); });
    const Index bodies = n_bodies(surface.surface);
    const Index limit = most_more_nodes * options.n_nodes;
    Solid solid;
    for (bool is_torn = true; is_torn;) {
        try {
            solid = without_flakes(refined_solid(surface, options), flake_angle);
        } catch (const TooManyNodes& failure) {
            throw InvalidArgument(name, "parts so thick that the wanted nodes can fill them (ask for more)",
                                  failure.what());
        } catch (const MesherFailure& failure) {
            throw InvalidArgument(name, "a surface that CGAL's mesher can follow", failure.what());
        }
        if (!options.several_pieces) {
            solid = without_crumbs(solid, crumb_share);
        }
        is_torn = !options.several_pieces && n_pieces(solid) > bodies && 3 * options.n_nodes / 2 <= limit &&
                  options.cell_size == 0 && go_on(options.progress, "mesh", 1);
        options.n_nodes = is_torn ? 3 * options.n_nodes / 2 : options.n_nodes;
    }
    Mesh<3, Scalar, Tet4> mesh{solid.nodes.cast<Scalar>(), solid.cells};
    check_result(mesh, options, bodies);
    mesh.nodes *= static_cast<Scalar>(unit);
    return mesh;
}

} // namespace detail

template <std::floating_point Scalar>
Mesh<3, Scalar, Tet4> tetrahedralize(const Surface& surface, const TetrahedralizeOptions& options) {
    detail::check(options);
    return detail::tetrahedralize<Scalar>(
        detail::solid_surface(surface, options.repair, options.sharp_edge_angle, "surface"), options, "surface");
}

template <std::floating_point Scalar>
Mesh<3, Scalar, Tet4> tetrahedralize(const std::filesystem::path& path, const TetrahedralizeOptions& options) {
    detail::check(options);
    return detail::tetrahedralize<Scalar>(detail::read_solid_surface(path, options.repair, options.sharp_edge_angle),
                                          options, path.string());
}

} // namespace springfit::cgal
