// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <springfit/mesh/mesh.hpp>

namespace springfit {

/// The nodes that are a corner of some cell, ascending: all nodes of a linear mesh, the vertices of a quadratic one.
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] std::vector<int> corner_nodes(const Mesh<Dim, Scalar, Cell>& mesh) {
    std::vector<int> nodes;
    nodes.reserve(static_cast<std::size_t>(Cell::n_corners * mesh.n_cells()));
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        for (int a = 0; a < Cell::n_corners; ++a) {
            nodes.push_back(mesh.cells(a, c));
        }
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

/// The mesh of the corners alone, with straight edges: node n is node `corner_nodes(mesh)[n]` of `mesh`. A linear mesh
/// comes back as it is.
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] Mesh<Dim, Scalar, LinearCell<Cell>> corner_mesh(const Mesh<Dim, Scalar, Cell>& mesh) {
    if constexpr (std::same_as<LinearCell<Cell>, Cell>) {
        return mesh;
    } else {
        const std::vector<int> corners = corner_nodes(mesh);
        std::vector<int> number(static_cast<std::size_t>(mesh.n_nodes()), -1);
        Mesh<Dim, Scalar, LinearCell<Cell>> result;
        result.nodes.resize(Dim, static_cast<Index>(corners.size()));
        for (std::size_t n = 0; n < corners.size(); ++n) {
            number[static_cast<std::size_t>(corners[n])] = static_cast<int>(n);
            result.nodes.col(static_cast<Index>(n)) = mesh.nodes.col(corners[n]);
        }
        result.cells = mesh.cells.template topRows<Cell::n_corners>().unaryExpr(
            [&](int node) { return number[static_cast<std::size_t>(node)]; });
        return result;
    }
}

} // namespace springfit
