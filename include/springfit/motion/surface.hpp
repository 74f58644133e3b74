// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/mesh/topology.hpp>
#include <springfit/motion/transfer.hpp>

namespace springfit {

/// Points that follow the nodes of a network, which may be coarser than they are: x_s = X_s + sum_i w_is (x_i - X_i),
/// with X at rest `[Dim x n_points]`, m.
///
/// Displacements are interpolated, not positions: at rest every point is where it belongs even if it lies a little
/// outside the network. Translations are followed exactly, rotations and affine motions as far as the weights reproduce
/// the point at rest. Throws InvalidArgument for sizes that do not fit. O(weights).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Points<Dim, Scalar>
deform(const Interpolation<Scalar>& from_nodes, const Points<Dim, Scalar>& rest_points,
       const Points<Dim, Scalar>& rest_positions, const Points<Dim, Scalar>& positions) {
    require(rest_points.cols() == from_nodes.n_targets(), "rest_points",
            text(from_nodes.n_targets(), " points, one per target"), rest_points.cols());
    require(positions.cols() == rest_positions.cols(), "positions", text(rest_positions.cols(), " nodes, as at rest"),
            positions.cols());
    return rest_points + interpolate<Dim, Scalar>(from_nodes, positions - rest_positions);
}

/// A surface for display that the nodes of a network carry.
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
struct EmbeddedSurface {
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    Points<Dim, Scalar> rest_positions; ///< [Dim x n_points], m
    /// Corners of triangles whose normals point out of the body; in the plane, ends of segments [Dim x n_cells].
    Eigen::Matrix<int, Dim, Eigen::Dynamic> cells;
    Interpolation<Scalar> from_nodes; ///< nodes of the network to points

    [[nodiscard]] Index n_points() const { return rest_positions.cols(); }
    [[nodiscard]] Index n_cells() const { return cells.cols(); }
};

/// Throws InvalidArgument unless the surface has finite points, each with weights of nodes in [0, `n_nodes`) that sum
/// to 1, and its cells name points that it has.
template <int Dim, std::floating_point Scalar>
void validate(const EmbeddedSurface<Dim, Scalar>& surface, Index n_nodes) {
    require(surface.n_points() > 0 && surface.rest_positions.allFinite(), "surface", "points at finite positions",
            text(surface.n_points(), " points"));
    require(surface.from_nodes.n_sources() == n_nodes && surface.from_nodes.n_targets() == surface.n_points(),
            "surface", text("weights [", n_nodes, " x ", surface.n_points(), "]"),
            text("[", surface.from_nodes.n_sources(), " x ", surface.from_nodes.n_targets(), "]"));
    validate(surface.from_nodes, "surface");
    for (Index i = 0; i < surface.cells.size(); ++i) {
        require(surface.cells(i) >= 0 && surface.cells(i) < surface.n_points(), "surface",
                text("point numbers in [0, ", surface.n_points(), ")"), surface.cells(i));
    }
}

/// Positions of the surface's points when the network's nodes are at `positions` `[Dim x n_points]`, m: see above.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Points<Dim, Scalar> deform(const EmbeddedSurface<Dim, Scalar>& surface,
                                         const Points<Dim, Scalar>& rest_positions,
                                         const Points<Dim, Scalar>& positions) {
    return deform<Dim, Scalar>(surface.from_nodes, surface.rest_positions, rest_positions, positions);
}

/// Positions of the surface's points in every frame of a network's motion: n_frames of `[Dim x n_points]`, m.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] std::vector<Points<Dim, Scalar>> deform(const EmbeddedSurface<Dim, Scalar>& surface,
                                                      const Motion<Dim, Scalar>& motion) {
    std::vector<Points<Dim, Scalar>> frames;
    for (const auto& positions : motion.positions) {
        frames.push_back(deform(surface, motion.rest_positions, positions));
    }
    return frames;
}

/// The boundary of a mesh as a surface that a network carries; its points are `boundary_nodes(mesh)` in their order,
/// and quadrilaterals are cut in two. `at_nodes`: nodes of the network to nodes of the mesh.
///
/// Throws InvalidArgument where `at_nodes` has other targets than the mesh has nodes. O(cells log cells).
template <int Dim, std::floating_point Scalar, CellType Cell>
    requires(Cell::dimension == Dim)
[[nodiscard]] EmbeddedSurface<Dim, Scalar> boundary_surface(const Mesh<Dim, Scalar, Cell>& mesh,
                                                            const Interpolation<Scalar>& at_nodes) {
    require(at_nodes.n_targets() == mesh.n_nodes(), "at_nodes", text(mesh.n_nodes(), " targets, the mesh's nodes"),
            at_nodes.n_targets());
    const auto facets = boundary_facets(mesh);
    const std::vector<int> nodes = boundary_nodes(mesh);
    std::vector<int> number(static_cast<std::size_t>(mesh.n_nodes()), -1);
    EmbeddedSurface<Dim, Scalar> surface;
    surface.rest_positions = mesh.nodes(Eigen::all, nodes);
    surface.from_nodes.weights.resize(at_nodes.n_sources(), static_cast<Index>(nodes.size()));
    for (std::size_t p = 0; p < nodes.size(); ++p) {
        number[static_cast<std::size_t>(nodes[p])] = static_cast<int>(p);
        surface.from_nodes.weights.startVec(static_cast<Index>(p));
        for (typename SparseMatrix<Scalar>::InnerIterator weight(at_nodes.weights, nodes[p]); weight; ++weight) {
            surface.from_nodes.weights.insertBack(weight.row(), static_cast<Index>(p)) = weight.value();
        }
    }
    surface.from_nodes.weights.finalize();

    constexpr std::size_t n_corners = std::tuple_size_v<decltype(Facet<Cell>::corners)>;
    constexpr Index n_pieces = static_cast<Index>(n_corners) - Dim + 1;
    surface.cells.resize(Dim, n_pieces * static_cast<Index>(facets.size()));
    Index cell = 0;
    for (const auto& facet : facets) {
        const auto point = [&](std::size_t corner) { return number[static_cast<std::size_t>(facet.corners[corner])]; };
        for (std::size_t piece = 0; piece < static_cast<std::size_t>(n_pieces); ++piece, ++cell) {
            surface.cells(0, cell) = point(0);
            for (std::size_t a = 1; a < static_cast<std::size_t>(Dim); ++a) {
                surface.cells(static_cast<Index>(a), cell) = point(piece + a);
            }
        }
    }
    return surface;
}

} // namespace springfit
