// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/SparseCholesky>

#include <springfit/solve/free_nodes.hpp>

namespace springfit {

/// Several vectors over the coordinates of all nodes, side by side `[Dim * n_nodes x n_columns]`, one row contiguous,
/// so that what is done to all columns alike runs as vector instructions. The number of columns is a multiple of
/// `block_lanes`.
using ColumnBlock = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

inline constexpr int block_lanes = 4;    ///< columns that are handled at once
inline constexpr int block_columns = 16; ///< most columns of a block

/// The lanes of one row of a block.
using ColumnLanes = Eigen::Array<double, block_lanes, 1>;

/// Sparse Cholesky factor L L' of a symmetric positive definite matrix over the free coordinates, applied to whole
/// blocks of right-hand sides: the factor is read once for all columns. Immutable once factorised, so threads may share
/// it. Memory: 12 bytes per entry of L.
class BlockCholesky {
public:
    /// Factorises `lower`, the lower triangle over the coordinates of `free`, for blocks whose nodes have `Dim` rows
    /// each. The analysis is reused while the pattern stays the same. False where the matrix is not positive definite
    /// by a margin above rounding (a pivot below 1e-12 of its diagonal entry).
    template <int Dim>
    [[nodiscard]] bool factorise(const SparseMatrix<double>& lower, const FreeNodes& free) {
        if (m_rows.size() != static_cast<std::size_t>(lower.cols()) || lower.nonZeros() != m_pattern_size) {
            m_factor.analyzePattern(lower);
            m_pattern_size = lower.nonZeros();
            const auto& place = m_factor.permutationP().indices();
            m_rows.assign(static_cast<std::size_t>(lower.cols()), 0);
            for (Index f = 0; f < free.n_free(); ++f) {
                for (int d = 0; d < Dim; ++d) {
                    m_rows[static_cast<std::size_t>(place(Dim * f + d))] =
                        Dim * free.nodes()[static_cast<std::size_t>(f)] + d;
                }
            }
        }
        m_factor.factorize(lower);
        if (m_factor.info() != Eigen::Success) {
            return false;
        }
        const auto& l = entries();
        const auto& place = m_factor.permutationP().indices();
        for (Index c = 0; c < lower.cols(); ++c) {
            const double pivot = l.valuePtr()[l.outerIndexPtr()[place(c)]];
            const double diagonal = lower.valuePtr()[lower.outerIndexPtr()[c]];
            if (!(pivot * pivot > 1e-12 * diagonal)) {
                return false;
            }
        }
        return true;
    }

    /// solution = A^-1 right-hand sides; rows of clamped nodes are not read and come out as 0. O(entries x columns).
    void solve(const ColumnBlock& right, ColumnBlock& solution) const {
        ColumnBlock work(static_cast<Index>(m_rows.size()), right.cols());
        for (std::size_t r = 0; r < m_rows.size(); ++r) {
            work.row(static_cast<Index>(r)) = right.row(m_rows[r]);
        }
        switch (right.cols()) {
        case 4: substitute<4>(work); break;
        case 8: substitute<8>(work); break;
        case 12: substitute<12>(work); break;
        default: substitute<16>(work); break;
        }
        solution.setZero(right.rows(), right.cols());
        for (std::size_t r = 0; r < m_rows.size(); ++r) {
            solution.row(m_rows[r]) = work.row(static_cast<Index>(r));
        }
    }

    /// Entries of L.
    [[nodiscard]] Index n_entries() const { return entries().nonZeros(); }

private:
    [[nodiscard]] const SparseMatrix<double>& entries() const { return m_factor.matrixL().nestedExpression(); }

    template <int Columns>
    void substitute(ColumnBlock& work) const {
        using Row = Eigen::Array<double, Columns, 1>;
        const auto& l = entries();
        const int* begin = l.outerIndexPtr();
        const int* index = l.innerIndexPtr();
        const double* value = l.valuePtr();
        double* rows = work.data();
        const auto row = [rows](Index r) { return Eigen::Map<Row>(rows + r * Columns); };
        for (Index c = 0; c < l.cols(); ++c) {
            const Row x = row(c) / value[begin[c]];
            row(c) = x;
            for (int p = begin[c] + 1; p < begin[c + 1]; ++p) {
                row(index[p]) -= value[p] * x;
            }
        }
        for (Index c = l.cols() - 1; c >= 0; --c) {
            Row x = row(c);
            for (int p = begin[c] + 1; p < begin[c + 1]; ++p) {
                x -= value[p] * row(index[p]);
            }
            row(c) = x / value[begin[c]];
        }
    }

    Eigen::SimplicialLLT<SparseMatrix<double>, Eigen::Lower> m_factor;
    Index m_pattern_size = -1;
    std::vector<Index> m_rows; ///< row of a block of each unknown, in the order of elimination
};

} // namespace springfit
