// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numeric>

#include <springfit/mesh/topology.hpp>

namespace springfit::cgal::detail {

/// Number of parts of a mesh that no shared facet joins. O(cells log cells).
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] Index n_pieces(const Mesh<Dim, Scalar, Cell>& mesh) {
    std::vector<std::size_t> piece(static_cast<std::size_t>(mesh.n_cells()));
    std::iota(piece.begin(), piece.end(), std::size_t{0});
    const auto root = [&](int cell) {
        auto c = static_cast<std::size_t>(cell);
        while (piece[c] != c) {
            c = piece[c] = piece[piece[c]];
        }
        return c;
    };
    Index pieces = mesh.n_cells();
    springfit::detail::for_shared_facets(mesh, [&](const std::vector<Facet<Cell>>& shared) {
        for (std::size_t s = 1; s < shared.size(); ++s) {
            const std::size_t a = root(shared[0].cell);
            const std::size_t b = root(shared[s].cell);
            if (a != b) {
                piece[std::max(a, b)] = std::min(a, b);
                --pieces;
            }
        }
    });
    return pieces;
}

} // namespace springfit::cgal::detail
