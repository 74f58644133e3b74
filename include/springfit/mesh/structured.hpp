// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <random>

#include <springfit/mesh/topology.hpp>

namespace springfit {

/// Number of cells along each axis.
template <int Dim>
using GridSize = std::array<int, Dim>;

namespace detail {

template <int Dim, std::floating_point Scalar>
void check_grid(const GridSize<Dim>& cells, const Vector<Dim, Scalar>& size) {
    for (int d = 0; d < Dim; ++d) {
        require(cells[static_cast<std::size_t>(d)] > 0, "cells", "at least one cell along each axis",
                cells[static_cast<std::size_t>(d)]);
        require(size(d) > 0 && std::isfinite(size(d)), "size", "a positive length along each axis", size(d));
    }
}

template <int Dim, std::floating_point Scalar>
Points<Dim, Scalar> grid_nodes(const GridSize<Dim>& cells, const Vector<Dim, Scalar>& size) {
    Index n = 1;
    for (int c : cells) {
        n *= c + 1;
    }
    Points<Dim, Scalar> nodes(Dim, n);
    for (Index i = 0; i < n; ++i) {
        Index rest = i;
        for (int d = 0; d < Dim; ++d) {
            const int count = cells[static_cast<std::size_t>(d)];
            nodes(d, i) = size(d) * static_cast<Scalar>(rest % (count + 1)) / static_cast<Scalar>(count);
            rest /= count + 1;
        }
    }
    return nodes;
}

} // namespace detail

/// A box `[0, size]` of quadrilaterals; node (i, j) has number i + j (cells_x + 1).
template <std::floating_point Scalar>
[[nodiscard]] Mesh<2, Scalar, Quad4> quad_grid(const GridSize<2>& cells, const Vector<2, Scalar>& size) {
    detail::check_grid<2, Scalar>(cells, size);
    Mesh<2, Scalar, Quad4> mesh;
    mesh.nodes = detail::grid_nodes<2, Scalar>(cells, size);
    mesh.cells.resize(4, Index{cells[0]} * cells[1]);
    const int row = cells[0] + 1;
    Index c = 0;
    for (int j = 0; j < cells[1]; ++j) {
        for (int i = 0; i < cells[0]; ++i) {
            const int n = i + j * row;
            mesh.cells.col(c++) << n, n + 1, n + 1 + row, n + row;
        }
    }
    return mesh;
}

/// A box of hexahedra; node (i, j, k) has number i + (cells_x + 1) (j + (cells_y + 1) k).
template <std::floating_point Scalar>
[[nodiscard]] Mesh<3, Scalar, Hex8> hex_grid(const GridSize<3>& cells, const Vector<3, Scalar>& size) {
    detail::check_grid<3, Scalar>(cells, size);
    Mesh<3, Scalar, Hex8> mesh;
    mesh.nodes = detail::grid_nodes<3, Scalar>(cells, size);
    mesh.cells.resize(8, Index{cells[0]} * cells[1] * cells[2]);
    const int row = cells[0] + 1;
    const int layer = row * (cells[1] + 1);
    Index c = 0;
    for (int k = 0; k < cells[2]; ++k) {
        for (int j = 0; j < cells[1]; ++j) {
            for (int i = 0; i < cells[0]; ++i) {
                const int n = i + j * row + k * layer;
                mesh.cells.col(c++) << n, n + 1, n + 1 + row, n + row, n + layer, n + layer + 1, n + layer + 1 + row,
                    n + layer + row;
            }
        }
    }
    return mesh;
}

/// A box of right-angled triangles: each square is cut along the diagonal that alternates like a chessboard.
template <std::floating_point Scalar>
[[nodiscard]] Mesh<2, Scalar, Tri3> triangle_grid(const GridSize<2>& cells, const Vector<2, Scalar>& size) {
    const auto quads = quad_grid<Scalar>(cells, size);
    Mesh<2, Scalar, Tri3> mesh;
    mesh.nodes = quads.nodes;
    mesh.cells.resize(3, 2 * quads.n_cells());
    for (Index q = 0; q < quads.n_cells(); ++q) {
        const auto n = quads.cells.col(q);
        if ((q % cells[0] + q / cells[0]) % 2 == 0) {
            mesh.cells.col(2 * q) << n(0), n(1), n(2);
            mesh.cells.col(2 * q + 1) << n(0), n(2), n(3);
        } else {
            mesh.cells.col(2 * q) << n(0), n(1), n(3);
            mesh.cells.col(2 * q + 1) << n(1), n(2), n(3);
        }
    }
    return mesh;
}

/// Equilateral triangles of the given edge: `rows` rows of `columns` up- and `columns` down-pointing triangles.
template <std::floating_point Scalar>
[[nodiscard]] Mesh<2, Scalar, Tri3> equilateral_triangles(int columns, int rows, Scalar edge) {
    detail::check_grid<2, Scalar>({columns, rows}, {edge, edge});
    Mesh<2, Scalar, Tri3> mesh;
    mesh.nodes = detail::grid_nodes<2, Scalar>({columns, rows},
                                               {edge * static_cast<Scalar>(columns), edge * static_cast<Scalar>(rows)});
    mesh.cells.resize(3, 2 * Index{columns} * rows);
    const Scalar height = edge * std::sqrt(Scalar(3)) / 2;
    for (Index i = 0; i < mesh.n_nodes(); ++i) {
        const auto row = static_cast<int>(i / (columns + 1));
        mesh.nodes(0, i) += (row % 2 == 1) ? edge / 2 : Scalar(0);
        mesh.nodes(1, i) = height * static_cast<Scalar>(row);
    }
    Index c = 0;
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const int n = i + j * (columns + 1);
            const int up = n + columns + 1;
            if (j % 2 == 0) {
                mesh.cells.col(c++) << n, n + 1, up;
                mesh.cells.col(c++) << n + 1, up + 1, up;
            } else {
                mesh.cells.col(c++) << n, up + 1, up;
                mesh.cells.col(c++) << n, n + 1, up + 1;
            }
        }
    }
    return mesh;
}

/// A box of tetrahedra: each cube is cut into six around its main diagonal (Kuhn), which fits from cube to cube.
template <std::floating_point Scalar>
[[nodiscard]] Mesh<3, Scalar, Tet4> tetrahedron_grid(const GridSize<3>& cells, const Vector<3, Scalar>& size) {
    constexpr int kuhn[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
    const auto hexes = hex_grid<Scalar>(cells, size);
    Mesh<3, Scalar, Tet4> mesh;
    mesh.nodes = hexes.nodes;
    mesh.cells.resize(4, 6 * hexes.n_cells());
    for (Index h = 0; h < hexes.n_cells(); ++h) {
        for (int t = 0; t < 6; ++t) {
            for (int a = 0; a < 4; ++a) {
                mesh.cells(a, 6 * h + t) = hexes.cells(kuhn[t][a], h);
            }
        }
    }
    return mesh;
}

/// Moves every interior node by a random vector of length up to `fraction` of its shortest edge; the boundary stays.
/// The seed fixes the result.
template <int Dim, std::floating_point Scalar, CellType Cell>
void jitter(Mesh<Dim, Scalar, Cell>& mesh, Scalar fraction, unsigned seed) {
    require(fraction >= 0 && fraction < Scalar(0.5), "fraction", "a value in [0, 0.5)", fraction);
    Values<Scalar> shortest = Values<Scalar>::Constant(mesh.n_nodes(), std::numeric_limits<Scalar>::max());
    const NodePairs pairs = edges(mesh);
    for (Index e = 0; e < pairs.cols(); ++e) {
        const Scalar length = (mesh.nodes.col(pairs(0, e)) - mesh.nodes.col(pairs(1, e))).norm();
        for (int end = 0; end < 2; ++end) {
            shortest(pairs(end, e)) = std::min(shortest(pairs(end, e)), length);
        }
    }
    for (int node : boundary_nodes(mesh)) {
        shortest(node) = 0;
    }
    std::mt19937 random(seed);
    std::uniform_real_distribution<Scalar> coordinate(-1, 1);
    for (Index i = 0; i < mesh.n_nodes(); ++i) {
        Vector<Dim, Scalar> direction;
        for (int d = 0; d < Dim; ++d) {
            direction(d) = coordinate(random);
        }
        mesh.nodes.col(i) += fraction * shortest(i) / std::sqrt(Scalar(Dim)) * direction;
    }
}

/// The same cells with a node in the middle of every edge: Tri3 to Tri6, Tet4 to Tet10. Vertices keep their numbers.
template <int Dim, std::floating_point Scalar, CellType Cell>
    requires std::same_as<Cell, Tri3> || std::same_as<Cell, Tet4>
[[nodiscard]] auto quadratic(const Mesh<Dim, Scalar, Cell>& mesh) {
    using Quadratic = std::conditional_t<std::same_as<Cell, Tri3>, Tri6, Tet10>;
    const NodePairs pairs = edges(mesh);
    std::map<std::array<int, 2>, int> middle;
    Mesh<Dim, Scalar, Quadratic> result;
    result.nodes.resize(Dim, mesh.n_nodes() + pairs.cols());
    result.nodes.leftCols(mesh.n_nodes()) = mesh.nodes;
    for (Index e = 0; e < pairs.cols(); ++e) {
        const auto node = static_cast<int>(mesh.n_nodes() + e);
        middle[{pairs(0, e), pairs(1, e)}] = node;
        result.nodes.col(node) = (mesh.nodes.col(pairs(0, e)) + mesh.nodes.col(pairs(1, e))) / 2;
    }
    result.cells.resize(Quadratic::n_nodes, mesh.n_cells());
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        result.cells.col(c).template head<Cell::n_nodes>() = mesh.cells.col(c);
        for (std::size_t e = 0; e < Cell::edges.size(); ++e) {
            const int a = mesh.cells(Cell::edges[e][0], c);
            const int b = mesh.cells(Cell::edges[e][1], c);
            result.cells(Cell::n_nodes + static_cast<int>(e), c) = middle.at({std::min(a, b), std::max(a, b)});
        }
    }
    return result;
}

/// A plane mesh laid into space at height 0: a membrane.
template <std::floating_point Scalar, CellType Cell>
[[nodiscard]] Mesh<3, Scalar, Cell> membrane(const Mesh<2, Scalar, Cell>& plane) {
    Mesh<3, Scalar, Cell> mesh;
    mesh.nodes = Points<3, Scalar>::Zero(3, plane.n_nodes());
    mesh.nodes.template topRows<2>() = plane.nodes;
    mesh.cells = plane.cells;
    return mesh;
}

} // namespace springfit
