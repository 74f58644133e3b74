// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <vector>

#include <springfit/solve/sparse_cholesky.hpp>

namespace springfit::detail {

/// Cholesky factor L L' of a symmetric positive definite matrix whose unknowns come in groups of `Dim`, one per node,
/// all coupled or not coupled at all. Kept as dense blocks in single precision, which is a third of the memory that a
/// triangular solve has to read otherwise: for preconditioners. Immutable once made.
template <int Dim, std::floating_point Scalar>
class NodeCholesky {
public:
    NodeCholesky() = default;

    /// Factorises a matrix given by its lower triangle, in double precision.
    explicit NodeCholesky(const SparseMatrix<Scalar>& lower);

    /// False where the matrix is not positive definite by a margin above rounding; then nothing else may be called.
    [[nodiscard]] bool is_usable() const { return m_is_usable; }

    /// Unknowns of one node, padded for vector instructions; the padding of `work` must be 0 and stays so.
    static constexpr int stride = Dim == 3 ? 4 : 2;
    using Work = Eigen::Matrix<Scalar, stride, Eigen::Dynamic>; ///< one column per node, in the order of elimination

    /// The node at each place in the order of elimination.
    [[nodiscard]] const std::vector<int>& order() const { return m_order; }

    /// work becomes (L L')^-1 work. O(entries of L).
    void solve(Work& work) const;

private:
    using Corner = Eigen::Matrix<Scalar, Dim, Dim>;

    void take_blocks(const SparseCholesky& factor);

    bool m_is_usable = false;
    std::vector<int> m_order;
    std::vector<int> m_begin;      ///< of each node's blocks below the diagonal
    std::vector<int> m_rows;       ///< place of the node in each block's rows
    std::vector<float> m_blocks;   ///< `stride` values per column of a block
    std::vector<Corner> m_corners; ///< inverses of the blocks on the diagonal
};

} // namespace springfit::detail

#include <springfit/solve/detail/node_cholesky_impl.hpp>
