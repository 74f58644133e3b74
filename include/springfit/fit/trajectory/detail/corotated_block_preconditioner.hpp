// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fit/trajectory/detail/spring_block.hpp>

namespace springfit::detail {

/// The factor of the matrix at the rest shape, turned with the body: R K0^-1 R', R the rotation of each node's
/// surroundings in each column. What a body answers hardly depends on how it is turned, so this preconditions bent and
/// twisted states almost as well as the rest shape.
template <int Dim>
class CorotatedBlockPreconditioner {
public:
    /// The rotations at `positions`, none where no spring has turned by more than 0.03. O(springs x columns).
    CorotatedBlockPreconditioner(const SpringNetwork<Dim, double>& network, const BlockCholesky& factor,
                                 const ColumnBlock& positions)
        : m_factor(&factor) {
        if (!is_turned(network, positions)) {
            return;
        }
        // A = sum r r0' over the springs at a node; its polar part turns r0 into r as well as a rotation can.
        m_rotations = ColumnBlock::Zero(Dim * Dim * network.n_nodes(), positions.cols());
        for (Index column = 0; column < positions.cols(); column += block_lanes) {
            for (Index e = 0; e < network.n_springs(); ++e) {
                const int i = network.springs(0, e);
                const int j = network.springs(1, e);
                const auto r = difference<Dim>(positions, j, i, column);
                const Vector<Dim, double> r0 = network.rest_positions.col(j) - network.rest_positions.col(i);
                const double weight = 1 / r0.squaredNorm();
                for (int a = 0; a < Dim; ++a) {
                    for (int b = 0; b < Dim; ++b) {
                        const ColumnLanes product = weight * r0(b) * r[a];
                        entry(i, a, b, column) += product;
                        entry(j, a, b, column) += product;
                    }
                }
            }
            for (Index node = 0; node < network.n_nodes(); ++node) {
                make_rotation(node, column);
            }
        }
    }

    void solve(const ColumnBlock& right, ColumnBlock& solution) const {
        if (m_rotations.size() == 0) {
            m_factor->solve(right, solution);
            return;
        }
        ColumnBlock turned(right.rows(), right.cols());
        apply(right, true, turned);
        ColumnBlock z;
        m_factor->solve(turned, z);
        solution.resize(right.rows(), right.cols());
        apply(z, false, solution);
    }

private:
    using Entries = std::array<std::array<ColumnLanes, Dim>, Dim>;

    ColumnLanes& entry(Index node, int a, int b, Index column) {
        return lanes(m_rotations, Dim * Dim * node + Dim * a + b, column);
    }
    [[nodiscard]] const ColumnLanes& entry(Index node, int a, int b, Index column) const {
        return lanes(m_rotations, Dim * Dim * node + Dim * a + b, column);
    }

    static bool is_turned(const SpringNetwork<Dim, double>& network, const ColumnBlock& positions) {
        for (Index e = 0; e < network.n_springs(); ++e) {
            const int i = network.springs(0, e);
            const int j = network.springs(1, e);
            const Vector<Dim, double> n = (network.rest_positions.col(j) - network.rest_positions.col(i)).normalized();
            for (Index column = 0; column < positions.cols(); column += block_lanes) {
                const SpringLanes<Dim> spring(positions, i, j, column);
                ColumnLanes along = n(0) * spring.n[0];
                for (int d = 1; d < Dim; ++d) {
                    along += n(d) * spring.n[d];
                }
                if (any_less(along, 1 - 0.03 * 0.03 / 2)) {
                    return true;
                }
            }
        }
        return false;
    }

    /// Replaces A of a node by its polar part, by the identity where that is no rotation.
    void make_rotation(Index node, Index column) {
        Entries x;
        for (int a = 0; a < Dim; ++a) {
            for (int b = 0; b < Dim; ++b) {
                x[a][b] = entry(node, a, b, column);
            }
        }
        ColumnLanes good;
        if constexpr (Dim == 2) {
            const ColumnLanes c = x[0][0] + x[1][1];
            const ColumnLanes s = x[1][0] - x[0][1];
            const ColumnLanes size = sqrt(c * c + s * s);
            good = where_less(0, size, 1, 0);
            x = {{{c / size, -s / size}, {s / size, c / size}}};
        } else {
            ColumnLanes squares = 0;
            for (int a = 0; a < 3; ++a) {
                squares += dot<3>(x[a], x[a]);
            }
            const ColumnLanes scale = sqrt(3 / squares);
            for (int a = 0; a < 3; ++a) {
                x[a] = scaled<3>(scale, x[a]);
            }
            ColumnLanes determinant = 0;
            for (int iteration = 0; iteration < 12; ++iteration) { // Newton's for the polar part: X <- (X + X^-T) / 2
                const std::array<LaneVector<3>, 3> cofactors{cross(x[1], x[2]), cross(x[2], x[0]), cross(x[0], x[1])};
                determinant = dot<3>(x[0], cofactors[0]);
                for (int a = 0; a < 3; ++a) {
                    for (int b = 0; b < 3; ++b) {
                        x[a][b] = (x[a][b] + cofactors[a][b] / determinant) / 2;
                    }
                }
            }
            const ColumnLanes away = determinant - 1;
            good = where_less(away, 1e-3, where_less(-1e-3, away, 1, 0), 0);
        }
        for (int a = 0; a < Dim; ++a) {
            for (int b = 0; b < Dim; ++b) {
                entry(node, a, b, column) = where_less(0, good, x[a][b], a == b ? 1. : 0.);
            }
        }
    }

    void apply(const ColumnBlock& in, bool transposed, ColumnBlock& out) const {
        for (Index node = 0; node < in.rows() / Dim; ++node) {
            for (Index column = 0; column < in.cols(); column += block_lanes) {
                for (int a = 0; a < Dim; ++a) {
                    ColumnLanes sum = 0;
                    for (int b = 0; b < Dim; ++b) {
                        sum += (transposed ? entry(node, b, a, column) : entry(node, a, b, column)) *
                               lanes(in, Dim * node + b, column);
                    }
                    lanes(out, Dim * node + a, column) = sum;
                }
            }
        }
    }

    const BlockCholesky* m_factor;
    ColumnBlock m_rotations; ///< [Dim * Dim * n_nodes x n_columns]; empty: none
};

} // namespace springfit::detail
