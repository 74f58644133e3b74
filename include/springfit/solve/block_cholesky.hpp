// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/solve/free_nodes.hpp>
#include <springfit/solve/sparse_cholesky.hpp>

namespace springfit {

/// Several vectors over the coordinates of all nodes, side by side `[Dim * n_nodes x n_columns]`, one row contiguous,
/// so that what is done to all columns alike runs as vector instructions. The number of columns is a multiple of
/// `block_lanes`.
using ColumnBlock = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

inline constexpr int block_lanes = 4;    ///< columns that are handled at once
inline constexpr int block_columns = 16; ///< most columns of a block

/// Sparse Cholesky factor of a symmetric positive definite matrix over the free coordinates, applied to whole blocks of
/// right-hand sides: the factor is read once for all columns. Immutable once factorised, so threads may share it.
template <class Factor>
class BasicBlockCholesky {
public:
    /// Factorises `lower`, the lower triangle over the coordinates of `free`, for blocks whose nodes have `Dim` rows
    /// each. The analysis is reused while the pattern stays the same. False where the matrix is not positive definite
    /// by a margin above rounding (a pivot below 1e-12 of its diagonal entry).
    template <int Dim>
    [[nodiscard]] bool factorise(const SparseMatrix<double>& lower, const FreeNodes& free) {
        const bool is_clear = m_factor.factorise(lower, 1e-12, Dim);
        m_rows.resize(static_cast<std::size_t>(lower.cols()));
        for (Index f = 0; f < free.n_free(); ++f) {
            for (int d = 0; d < Dim; ++d) {
                m_rows[static_cast<std::size_t>(m_factor.place()(Dim * f + d))] =
                    Dim * free.nodes()[static_cast<std::size_t>(f)] + d;
            }
        }
        return is_clear;
    }

    /// solution = A^-1 right-hand sides; rows of clamped nodes are not read and come out as 0. O(entries x columns).
    void solve(const ColumnBlock& right, ColumnBlock& solution) const {
        switch (right.cols()) {
        case 4: substitute<4>(right, solution); break;
        case 8: substitute<8>(right, solution); break;
        case 12: substitute<12>(right, solution); break;
        default: substitute<16>(right, solution); break;
        }
    }

private:
    template <int Columns>
    void substitute(const ColumnBlock& right, ColumnBlock& solution) const {
        typename Factor::template Rows<Columns> work(static_cast<Index>(m_rows.size()), Columns);
        for (std::size_t r = 0; r < m_rows.size(); ++r) {
            work.row(static_cast<Index>(r)) = right.row(m_rows[r]);
        }
        m_factor.template substitute<Columns>(work);
        solution.setZero(right.rows(), right.cols());
        for (std::size_t r = 0; r < m_rows.size(); ++r) {
            solution.row(m_rows[r]) = work.row(static_cast<Index>(r));
        }
    }

    Factor m_factor;
    std::vector<Index> m_rows; ///< row of a block of each unknown, in the order of elimination
};

using BlockCholesky = BasicBlockCholesky<SparseCholesky>;

} // namespace springfit
