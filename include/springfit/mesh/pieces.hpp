// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <springfit/core/error.hpp>
#include <springfit/core/types.hpp>

namespace springfit {

/// For each node a node of its piece, the same for all of a piece, where pairs of nodes `[2 x n_pairs]` connect them; a
/// node of no pair is a piece of its own. Throws InvalidArgument for a pair out of range. O(nodes + pairs).
[[nodiscard]] inline std::vector<Index> piece_of_nodes(Index n_nodes, const NodePairs& pairs) {
    std::vector<Index> root(static_cast<std::size_t>(n_nodes));
    std::iota(root.begin(), root.end(), Index(0));
    const auto find = [&](Index node) {
        while (root[static_cast<std::size_t>(node)] != node) {
            auto& up = root[static_cast<std::size_t>(node)];
            up = root[static_cast<std::size_t>(up)];
            node = up;
        }
        return node;
    };
    for (Index p = 0; p < pairs.cols(); ++p) {
        const int low = pairs.col(p).minCoeff();
        const int high = pairs.col(p).maxCoeff();
        require(low >= 0 && high < n_nodes, "pairs", text("node numbers in [0, ", n_nodes, ")"), low < 0 ? low : high);
        root[static_cast<std::size_t>(find(high))] = find(low);
    }
    for (Index i = 0; i < n_nodes; ++i) {
        root[static_cast<std::size_t>(i)] = find(i);
    }
    return root;
}

/// The number of nodes of each such piece, the largest first. Throws as `piece_of_nodes`.
[[nodiscard]] inline std::vector<Index> pieces(Index n_nodes, const NodePairs& pairs) {
    std::vector<Index> sizes(static_cast<std::size_t>(n_nodes), 0);
    for (const Index piece : piece_of_nodes(n_nodes, pairs)) {
        ++sizes[static_cast<std::size_t>(piece)];
    }
    std::erase(sizes, 0);
    std::sort(sizes.begin(), sizes.end(), std::greater<>());
    return sizes;
}

/// How many points lie where another one does, to a part `close` of the body's size: nodes that a mesher wrote twice,
/// between which no force passes. O(nodes log nodes).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Index n_coinciding(const Points<Dim, Scalar>& points, std::type_identity_t<Scalar> close = Scalar(1e-6)) {
    if (points.cols() < 2) {
        return 0;
    }
    const Vector<Dim, Scalar> low = points.rowwise().minCoeff();
    const Scalar distance = close * (points.rowwise().maxCoeff() - low).norm();
    if (!(distance > 0)) {
        return points.cols();
    }
    // Cells twice as wide as the distance; two points so close share a cell of one of 2^Dim shifted grids.
    std::vector<bool> coincides(static_cast<std::size_t>(points.cols()), false);
    for (int shift = 0; shift < (1 << Dim); ++shift) {
        std::vector<std::pair<std::array<std::int64_t, Dim>, Index>> cells;
        for (Index i = 0; i < points.cols(); ++i) {
            std::array<std::int64_t, Dim> cell{};
            for (int d = 0; d < Dim; ++d) {
                const Scalar at = (points(d, i) - low(d)) / (2 * distance) + ((shift >> d & 1) != 0 ? Scalar(0.5) : 0);
                cell[static_cast<std::size_t>(d)] = static_cast<std::int64_t>(std::floor(at));
            }
            cells.emplace_back(cell, i);
        }
        std::sort(cells.begin(), cells.end());
        for (std::size_t c = 1; c < cells.size(); ++c) {
            const auto& [cell, i] = cells[c];
            const auto& [before, j] = cells[c - 1];
            if (cell == before && (points.col(i) - points.col(j)).norm() <= distance) {
                coincides[static_cast<std::size_t>(i)] = true;
                coincides[static_cast<std::size_t>(j)] = true;
            }
        }
    }
    return std::count(coincides.begin(), coincides.end(), true);
}

} // namespace springfit
