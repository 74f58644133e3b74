// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <springfit/core/types.hpp>

namespace springfit {

namespace detail {

/// For each node, its neighbours: entries `first[i]` to `first[i + 1]` of `nodes`.
struct Neighbours {
    std::vector<int> first, nodes;

    Neighbours(Index n_nodes, const NodePairs& pairs)
        : first(static_cast<std::size_t>(n_nodes) + 1, 0), nodes(static_cast<std::size_t>(2 * pairs.cols())) {
        for (int node : pairs.reshaped()) {
            ++first[static_cast<std::size_t>(node) + 1];
        }
        for (std::size_t i = 1; i < first.size(); ++i) {
            first[i] += first[i - 1];
        }
        std::vector<int> next(first.begin(), first.end() - 1);
        for (Index p = 0; p < pairs.cols(); ++p) {
            for (int end : {0, 1}) {
                int& slot = next[static_cast<std::size_t>(pairs(end, p))];
                nodes[static_cast<std::size_t>(slot++)] = pairs(1 - end, p);
            }
        }
    }
};

/// Appends the nodes that can be reached from `start` to `order`, the nearest first; `seen` is marked `mark` there.
inline void append_by_distance(const Neighbours& neighbours, int start, int mark, std::vector<int>& seen,
                               std::vector<int>& order) {
    std::size_t next = order.size();
    order.push_back(start);
    seen[static_cast<std::size_t>(start)] = mark;
    for (; next < order.size(); ++next) {
        const auto i = static_cast<std::size_t>(order[next]);
        for (int n = neighbours.first[i]; n < neighbours.first[i + 1]; ++n) {
            const int node = neighbours.nodes[static_cast<std::size_t>(n)];
            if (seen[static_cast<std::size_t>(node)] != mark) {
                seen[static_cast<std::size_t>(node)] = mark;
                order.push_back(node);
            }
        }
    }
}

} // namespace detail

/// An order of nodes in which joined nodes are near each other: by the number of springs from an end of the body, a
/// wave that runs through it (Cuthill and McKee's order without their rule for ties).
///
/// `pairs` `[2 x n]` are the ends of the springs; returns which node comes at each place `[n_nodes]`. Pieces that are
/// not joined follow one another. What a loop over springs in this order looks at is a window of about two layers of
/// nodes, which moves on through memory without jumps. O(nodes + springs).
[[nodiscard]] inline std::vector<int> locality_order(Index n_nodes, const NodePairs& pairs) {
    const detail::Neighbours neighbours(n_nodes, pairs);
    std::vector<int> seen(static_cast<std::size_t>(n_nodes), 0);
    std::vector<int> order, reached;
    order.reserve(seen.size());
    for (int node = 0; node < static_cast<int>(n_nodes); ++node) {
        if (seen[static_cast<std::size_t>(node)] != 0) {
            continue;
        }
        reached.clear();
        detail::append_by_distance(neighbours, node, 1, seen, reached);
        detail::append_by_distance(neighbours, reached.back(), 2, seen, order);
    }
    return order;
}

} // namespace springfit
