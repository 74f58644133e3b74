// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <springfit/solve/column_lanes.hpp>
#include <springfit/solve/detail/node_rotations.hpp>

namespace springfit::detail {

/// `CorotatedPreconditioner` for a block of states of one body, each column turned by rotations of its own; over the
/// coordinates of all nodes.
template <int Dim>
class CorotatedBlockPreconditioner {
public:
    /// The rotations at `positions`, none where no pair has turned by more than 0.03. `factor` is that of the stiffness
    /// at rest and must outlive this. O(pairs x columns).
    CorotatedBlockPreconditioner(const BlockCholesky& factor, const NodePairs& pairs, const Points<Dim, double>& rest,
                                 const ColumnBlock& positions)
        : m_factor(&factor) {
        if (!is_turned(pairs, rest, positions)) {
            return;
        }
        const auto weighted = weighted_vectors<Dim, double>(pairs, rest);
        for (Index column = 0; column < positions.cols(); column += block_lanes) {
            m_rotations.emplace_back(rest.cols(), pairs, weighted, [&](Index e) {
                return difference<Dim>(positions, pairs(1, e), pairs(0, e), column);
            });
        }
    }

    /// solution = R K0^-1 R' right in each column. O(entries of the factor x columns).
    void solve(const ColumnBlock& right, ColumnBlock& solution) const {
        if (m_rotations.empty()) {
            m_factor->solve(right, solution);
            return;
        }
        ColumnBlock turned_back(right.rows(), right.cols());
        for_nodes(right, [&](Index node, Index column, const auto& rotations) {
            set_node<Dim>(turned_back, node, column, rotations.turned_back(node, node_lanes<Dim>(right, node, column)));
        });
        m_factor->solve(turned_back, solution);
        for_nodes(right, [&](Index node, Index column, const auto& rotations) {
            set_node<Dim>(solution, node, column, rotations.turned(node, node_lanes<Dim>(solution, node, column)));
        });
    }

private:
    static bool is_turned(const NodePairs& pairs, const Points<Dim, double>& rest, const ColumnBlock& positions) {
        constexpr double cosine = 1 - 0.03 * 0.03 / 2;
        for (Index e = 0; e < pairs.cols(); ++e) {
            const Vector<Dim, double> n = (rest.col(pairs(1, e)) - rest.col(pairs(0, e))).normalized();
            for (Index column = 0; column < positions.cols(); column += block_lanes) {
                const auto r = difference<Dim>(positions, pairs(1, e), pairs(0, e), column);
                ColumnLanes along = n(0) * r[0];
                for (int d = 1; d < Dim; ++d) {
                    along += n(d) * r[d];
                }
                if (any_less(along, cosine * sqrt(dot<Dim>(r, r)))) {
                    return true;
                }
            }
        }
        return false;
    }

    template <class Body>
    void for_nodes(const ColumnBlock& block, const Body& body) const {
        for (Index column = 0; column < block.cols(); column += block_lanes) {
            for (Index node = 0; node < block.rows() / Dim; ++node) {
                body(node, column, m_rotations[static_cast<std::size_t>(column / block_lanes)]);
            }
        }
    }

    const BlockCholesky* m_factor;
    std::vector<NodeRotations<Dim, ColumnLanes>> m_rotations; ///< of the columns lane by lane; none: not turned
};

} // namespace springfit::detail
