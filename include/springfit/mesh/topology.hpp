// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>

#include <springfit/mesh/mesh.hpp>

namespace springfit {

namespace detail {

/// Corners of a facet with those of the cell it belongs to.
template <CellType Cell>
using FacetCorners = std::remove_cvref_t<decltype(Cell::facets[0])>;

inline NodePairs sorted_unique_pairs(std::vector<std::array<int, 2>>& pairs) {
    for (auto& pair : pairs) {
        if (pair[0] > pair[1]) {
            std::swap(pair[0], pair[1]);
        }
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    NodePairs result(2, static_cast<Index>(pairs.size()));
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        result.col(static_cast<Index>(p)) << pairs[p][0], pairs[p][1];
    }
    return result;
}

template <int Dim, std::floating_point Scalar, CellType Cell, class LocalPairs>
NodePairs collect_pairs(const Mesh<Dim, Scalar, Cell>& mesh, const LocalPairs& local_pairs) {
    std::vector<std::array<int, 2>> pairs;
    pairs.reserve(local_pairs.size() * static_cast<std::size_t>(mesh.n_cells()));
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        for (const auto& [a, b] : local_pairs) {
            pairs.push_back({mesh.cells(a, c), mesh.cells(b, c)});
        }
    }
    return sorted_unique_pairs(pairs);
}

} // namespace detail

/// The edges between corners, each once, as (lower, higher) node number in ascending order `[2 x n_edges]`.
/// O(cells log cells).
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] NodePairs edges(const Mesh<Dim, Scalar, Cell>& mesh) {
    return detail::collect_pairs(mesh, Cell::edges);
}

/// The diagonals of the cells (faces and body), each once, as (lower, higher) `[2 x n_diagonals]`; none in simplices.
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] NodePairs diagonals(const Mesh<Dim, Scalar, Cell>& mesh) {
    return detail::collect_pairs(mesh, Cell::diagonals);
}

/// A facet of a cell: an edge in the plane, a face in space.
template <CellType Cell>
struct Facet {
    detail::FacetCorners<Cell> corners; ///< node numbers, ordered so that the normal points out of `cell`
    int cell;                           ///< the cell it was taken from
    int local;                          ///< its number in `Cell::facets`
};

namespace detail {

template <CellType Cell>
FacetCorners<Cell> sorted_corners(FacetCorners<Cell> corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
}

/// Calls `visit(facets)` with the one, two or more facets that share the same corners.
template <int Dim, std::floating_point Scalar, CellType Cell, class Visit>
void for_shared_facets(const Mesh<Dim, Scalar, Cell>& mesh, const Visit& visit) {
    std::vector<Facet<Cell>> facets;
    facets.reserve(Cell::facets.size() * static_cast<std::size_t>(mesh.n_cells()));
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        for (std::size_t f = 0; f < Cell::facets.size(); ++f) {
            FacetCorners<Cell> corners = Cell::facets[f];
            for (int& corner : corners) {
                corner = mesh.cells(corner, c);
            }
            facets.push_back({corners, static_cast<int>(c), static_cast<int>(f)});
        }
    }
    std::vector<std::size_t> order(facets.size());
    std::vector<FacetCorners<Cell>> keys(facets.size());
    for (std::size_t i = 0; i < facets.size(); ++i) {
        order[i] = i;
        keys[i] = sorted_corners<Cell>(facets[i].corners);
    }
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
    std::vector<Facet<Cell>> shared;
    for (std::size_t i = 0; i < order.size();) {
        shared.clear();
        const std::size_t first = order[i];
        for (; i < order.size() && keys[order[i]] == keys[first]; ++i) {
            shared.push_back(facets[order[i]]);
        }
        visit(shared);
    }
}

} // namespace detail

/// The facets that belong to one cell only: the boundary, oriented outwards. For a membrane: its rim.
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] std::vector<Facet<Cell>> boundary_facets(const Mesh<Dim, Scalar, Cell>& mesh) {
    std::vector<Facet<Cell>> boundary;
    detail::for_shared_facets(mesh, [&](const std::vector<Facet<Cell>>& shared) {
        if (shared.size() == 1) {
            boundary.push_back(shared.front());
        }
    });
    return boundary;
}

/// The nodes on the boundary facets, ascending (corner nodes only).
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] std::vector<int> boundary_nodes(const Mesh<Dim, Scalar, Cell>& mesh) {
    std::vector<int> nodes;
    for (const auto& facet : boundary_facets(mesh)) {
        nodes.insert(nodes.end(), facet.corners.begin(), facet.corners.end());
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

/// The second ring of a simplex mesh: pairs of vertices that face each other across a shared facet, each once, without
/// the pairs that are edges already `[2 x n_pairs]`.
template <int Dim, std::floating_point Scalar, SimplexCell Cell>
[[nodiscard]] NodePairs second_ring(const Mesh<Dim, Scalar, Cell>& mesh) {
    const auto opposite = [&](const Facet<Cell>& facet) {
        for (int a = 0; a < Cell::n_corners; ++a) {
            const int node = mesh.cells(a, facet.cell);
            if (std::find(facet.corners.begin(), facet.corners.end(), node) == facet.corners.end()) {
                return node;
            }
        }
        return -1;
    };
    std::vector<std::array<int, 2>> pairs;
    detail::for_shared_facets(mesh, [&](const std::vector<Facet<Cell>>& shared) {
        for (std::size_t a = 0; a < shared.size(); ++a) {
            for (std::size_t b = a + 1; b < shared.size(); ++b) {
                const int i = opposite(shared[a]);
                const int j = opposite(shared[b]);
                if (i != j) {
                    pairs.push_back({std::min(i, j), std::max(i, j)});
                }
            }
        }
    });
    const NodePairs first_ring = edges(mesh);
    std::erase_if(pairs, [&](const std::array<int, 2>& pair) {
        Index low = 0;
        Index high = first_ring.cols();
        while (low < high) {
            const Index middle = (low + high) / 2;
            const std::array<int, 2> edge{first_ring(0, middle), first_ring(1, middle)};
            if (edge == pair) {
                return true;
            }
            (edge < pair ? low : high) = edge < pair ? middle + 1 : middle;
        }
        return false;
    });
    return detail::sorted_unique_pairs(pairs);
}

} // namespace springfit
