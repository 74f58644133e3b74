// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <springfit/core/error.hpp>
#include <springfit/core/types.hpp>
#include <springfit/mesh/cell.hpp>

namespace springfit {

/// Cells of one kind over shared nodes, on plain arrays.
///
/// A surface cell in space (`Dim == 3`, `Cell::dimension == 2`) makes a membrane or cloth.
template <int Dim, std::floating_point Scalar, CellType Cell>
    requires SpatialDimension<Dim> && (Cell::dimension <= Dim)
struct Mesh {
    using CellArray = Eigen::Matrix<int, Cell::n_nodes, Eigen::Dynamic>;

    Points<Dim, Scalar> nodes; ///< rest positions [Dim x n_nodes], m
    CellArray cells;           ///< node numbers [Cell::n_nodes x n_cells]

    [[nodiscard]] Index n_nodes() const { return nodes.cols(); }
    [[nodiscard]] Index n_cells() const { return cells.cols(); }

    /// Rest positions of the nodes of one cell `[Dim x Cell::n_nodes]`.
    [[nodiscard]] Eigen::Matrix<Scalar, Dim, Cell::n_nodes> cell_nodes(Index cell) const {
        Eigen::Matrix<Scalar, Dim, Cell::n_nodes> positions;
        for (int a = 0; a < Cell::n_nodes; ++a) {
            positions.col(a) = nodes.col(cells(a, cell));
        }
        return positions;
    }
};

/// A mesh of the plane or of space that fills its dimension.
template <int Dim, std::floating_point Scalar, CellType Cell>
inline constexpr bool is_membrane = (Cell::dimension < Dim);

/// Throws InvalidArgument unless the mesh has cells, every node number is in range, every coordinate is finite, and
/// every node belongs to a cell. (Inverted cells are found where volumes are taken: `fem::validate`.) O(cells).
template <int Dim, std::floating_point Scalar, CellType Cell>
void validate(const Mesh<Dim, Scalar, Cell>& mesh) {
    require(mesh.n_cells() > 0, "mesh", "at least one cell", "none");
    for (Index i = 0; i < mesh.n_nodes(); ++i) {
        if (!mesh.nodes.col(i).allFinite()) {
            throw InvalidArgument("mesh", "finite coordinates",
                                  text("node ", i, " at (", mesh.nodes.col(i).transpose(), ")"));
        }
    }
    std::vector<bool> used(static_cast<std::size_t>(mesh.n_nodes()), false);
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        for (int a = 0; a < Cell::n_nodes; ++a) {
            const int node = mesh.cells(a, c);
            if (!(node >= 0 && node < mesh.n_nodes())) {
                throw InvalidArgument("mesh", text("node numbers in [0, ", mesh.n_nodes(), ")"),
                                      text("node ", node, " in cell ", c));
            }
            used[static_cast<std::size_t>(node)] = true;
        }
    }
    for (Index i = 0; i < mesh.n_nodes(); ++i) {
        require(used[static_cast<std::size_t>(i)], "mesh", "every node in a cell", text("node ", i, " in none"));
    }
}

} // namespace springfit
