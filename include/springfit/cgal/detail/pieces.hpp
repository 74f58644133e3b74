// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <numeric>

#include <springfit/mesh/topology.hpp>

namespace springfit::cgal::detail {

/// For each cell a number that it shares with those it hangs together with through facets: the lowest cell among them.
/// O(cells log cells).
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] std::vector<int> pieces(const Mesh<Dim, Scalar, Cell>& mesh) {
    std::vector<int> piece(static_cast<std::size_t>(mesh.n_cells()));
    std::iota(piece.begin(), piece.end(), 0);
    const auto root = [&](int c) {
        while (piece[static_cast<std::size_t>(c)] != c) {
            const int up = piece[static_cast<std::size_t>(c)];
            c = piece[static_cast<std::size_t>(c)] = piece[static_cast<std::size_t>(up)];
        }
        return c;
    };
    springfit::detail::for_shared_facets(mesh, [&](const std::vector<Facet<Cell>>& shared) {
        for (std::size_t s = 1; s < shared.size(); ++s) {
            const int a = root(shared[0].cell);
            const int b = root(shared[s].cell);
            piece[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
        }
    });
    for (int& p : piece) {
        p = root(p);
    }
    return piece;
}

/// Number of parts of a mesh that no shared facet joins. O(cells log cells).
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] Index n_pieces(const Mesh<Dim, Scalar, Cell>& mesh) {
    const std::vector<int> piece = pieces(mesh);
    Index n = 0;
    for (std::size_t c = 0; c < piece.size(); ++c) {
        n += piece[c] == static_cast<int>(c) ? 1 : 0;
    }
    return n;
}

/// Number of pieces of a surface that have their inside within: bodies, not the hollows in them.
template <std::floating_point Scalar>
[[nodiscard]] Index n_bodies(const Mesh<3, Scalar, Tri3>& surface) {
    const std::vector<int> piece = pieces(surface);
    std::vector<Scalar> volume(piece.size(), Scalar(0));
    for (std::size_t c = 0; c < piece.size(); ++c) {
        const auto corners = surface.cell_nodes(static_cast<Index>(c));
        volume[static_cast<std::size_t>(piece[c])] += corners.col(0).dot(corners.col(1).cross(corners.col(2)));
    }
    return std::count_if(volume.begin(), volume.end(), [](Scalar v) { return v > 0; });
}

/// The mesh of the cells that are kept, with the nodes that they use, both in their old order.
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] Mesh<Dim, Scalar, Cell> kept_cells(const Mesh<Dim, Scalar, Cell>& mesh, const std::vector<bool>& keep) {
    std::vector<int> number(static_cast<std::size_t>(mesh.n_nodes()), -1);
    Mesh<Dim, Scalar, Cell> result;
    result.cells.resize(Cell::n_nodes, std::count(keep.begin(), keep.end(), true));
    Index column = 0;
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        if (keep[static_cast<std::size_t>(c)]) {
            result.cells.col(column++) = mesh.cells.col(c);
            for (int a = 0; a < Cell::n_nodes; ++a) {
                number[static_cast<std::size_t>(mesh.cells(a, c))] = 0;
            }
        }
    }
    std::vector<int> used;
    for (std::size_t i = 0; i < number.size(); ++i) {
        if (number[i] == 0) {
            number[i] = static_cast<int>(used.size());
            used.push_back(static_cast<int>(i));
        }
    }
    result.nodes.resize(Dim, static_cast<Index>(used.size()));
    for (std::size_t i = 0; i < used.size(); ++i) {
        result.nodes.col(static_cast<Index>(i)) = mesh.nodes.col(used[i]);
    }
    result.cells = result.cells.unaryExpr([&](int node) { return number[static_cast<std::size_t>(node)]; }).eval();
    return result;
}

} // namespace springfit::cgal::detail
