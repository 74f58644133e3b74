// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <springfit/solve/block_matrix.hpp>

namespace springfit::detail {

/// Windows of motions that are simulated side by side: all static, or all dynamic of one length and one step, under the
/// same clamps.
struct WindowBlock {
    std::size_t group = 0;            ///< which system matrix
    std::vector<std::size_t> motions; ///< of each column; the last is repeated to a whole number of lanes
    std::vector<Index> first;         ///< frame that a window starts from
    Values<double> weight;            ///< of |x - x_ref|^2 in the objective, 1/m^2; 0 for repeated columns
    Index frames = 0;                 ///< that a window predicts; 0: a static case
};

/// The matrix that the windows of some blocks share.
template <int Dim>
struct WindowGroup {
    std::vector<int> clamped;
    FreeNodes free;
    double step = 0; ///< h, s; 0: statics
    BlockMatrix<Dim, double> pattern;
    Points<Dim, double> mean; ///< positions that its motions begin with
    int n_motions = 0;
};

} // namespace springfit::detail
