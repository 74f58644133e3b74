// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/small_vectors.hpp>

namespace springfit::detail {

/// What the columns of a Jacobian `[Dim x cell dimension]` span: the determinant, of either sign, where they fill the
/// plane or space; the area of a piece of membrane; the length of a piece of edge.
template <class Jacobian>
typename Jacobian::Scalar measure(const Jacobian& jacobian) {
    constexpr int rows = Jacobian::RowsAtCompileTime;
    constexpr int columns = Jacobian::ColsAtCompileTime;
    if constexpr (rows == columns) {
        return jacobian.determinant();
    } else if constexpr (columns == 1) {
        return jacobian.norm();
    } else {
        using Vec = Vector<3, typename Jacobian::Scalar>;
        return cross<Vec>(jacobian.col(0), jacobian.col(1)).norm();
    }
}

} // namespace springfit::detail
