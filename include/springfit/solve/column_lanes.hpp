// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <springfit/core/lanes.hpp>
#include <springfit/solve/block_cholesky.hpp>

namespace springfit::detail {

/// The same row of `block_lanes` columns.
using ColumnLanes = Lanes<double, block_lanes>;

/// The lanes of a row of a block from a column on, a multiple of `block_lanes`.
inline const ColumnLanes& lanes(const ColumnBlock& block, Index row, Index column) {
    return ColumnLanes::at(block.data() + row * block.cols() + column);
}

inline ColumnLanes& lanes(ColumnBlock& block, Index row, Index column) {
    return ColumnLanes::at(block.data() + row * block.cols() + column);
}

/// The same of values of the columns.
inline const ColumnLanes& lanes(const Eigen::ArrayXd& values, Index column) {
    return ColumnLanes::at(values.data() + column);
}

inline ColumnLanes& lanes(Eigen::ArrayXd& values, Index column) {
    return ColumnLanes::at(values.data() + column);
}

/// Lanes of as many vectors of the plane or of space.
template <int Dim>
using LaneVector = std::array<ColumnLanes, Dim>;

/// The vectors of a node in a block over the coordinates of all nodes.
template <int Dim>
LaneVector<Dim> node_lanes(const ColumnBlock& block, Index node, Index column) {
    LaneVector<Dim> result;
    for (int d = 0; d < Dim; ++d) {
        result[d] = lanes(block, Dim * node + d, column);
    }
    return result;
}

template <int Dim>
void set_node(ColumnBlock& block, Index node, Index column, const LaneVector<Dim>& values) {
    for (int d = 0; d < Dim; ++d) {
        lanes(block, Dim * node + d, column) = values[d];
    }
}

/// The vectors from node i to node j.
template <int Dim>
LaneVector<Dim> difference(const ColumnBlock& block, int j, int i, Index column) {
    LaneVector<Dim> result;
    for (int d = 0; d < Dim; ++d) {
        result[d] = lanes(block, Dim * j + d, column) - lanes(block, Dim * i + d, column);
    }
    return result;
}

/// Calls `body(row, column)` for all lanes of a block.
template <class Body>
void for_lanes(const ColumnBlock& block, const Body& body) {
    for (Index row = 0; row < block.rows(); ++row) {
        for (Index column = 0; column < block.cols(); column += block_lanes) {
            body(row, column);
        }
    }
}

} // namespace springfit::detail
