// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/types.hpp>

namespace springfit {

/// Sparse Cholesky factor P A P' = L L' of symmetric positive definite matrices of one pattern, by dense fronts.
///
/// Columns of L with (nearly) the same rows form a supernode, found once by `analyse`. Its front, the dense part of the
/// matrix over its rows, collects what its children in the elimination tree leave over; its own columns are eliminated
/// by dense kernels and the rest is left to its parent. So the arithmetic runs at the speed of dense matrices, several
/// times that of a factorisation entry by entry where L fills in much, as in space.
///
/// Memory: 8 bytes per entry of L, and less than as much again while factorising.
class MultifrontalCholesky {
public:
    /// Orders (minimum degree) and finds the supernodes of a matrix given by its lower triangle `[n x n]`.
    void analyse(const SparseMatrix<double>& lower);

    /// Factorises a matrix of the pattern analysed; false where a pivot is not positive, and then `solve` is not to be
    /// called.
    [[nodiscard]] bool factorise(const SparseMatrix<double>& lower);

    /// x = A^-1 b. O(n_entries).
    void solve(const Values<double>& b, Values<double>& x) const;

    [[nodiscard]] Index size() const { return static_cast<Index>(m_place.size()); }
    /// Entries of L that are stored.
    [[nodiscard]] double n_entries() const { return m_n_entries; }
    /// Multiplications and additions of one factorisation.
    [[nodiscard]] double flops() const { return m_flops; }

private:
    /// Consecutive columns of L, from `first`, over the same rows.
    struct Supernode {
        int first = 0;
        int width = 0;
        std::vector<int> rows;     ///< in the order of elimination, ascending, its own columns first
        std::vector<int> children; ///< supernodes that leave something to this one
        std::vector<int> to;       ///< place among the parent's rows, of each of its rows behind its own columns
        std::vector<int> entries;  ///< of the matrix, in its own order
        std::vector<Index> places; ///< of these in `l`
        DenseMatrix<double> l;     ///< [rows x width]; above the diagonal anything
        DenseMatrix<double> left;  ///< what it leaves to its parent, while factorising

        [[nodiscard]] Index n_rows() const { return static_cast<Index>(rows.size()); }
        [[nodiscard]] Index below() const { return n_rows() - width; }
    };

    /// Per column of L, in the order of elimination: the first row below its diagonal (-1: none), and its number of
    /// rows.
    struct Tree {
        std::vector<int> parent, count;
    };

    void order(const SparseMatrix<double>& lower);
    [[nodiscard]] std::vector<std::vector<int>> row_patterns(const SparseMatrix<double>& lower) const;
    static void find_parents(const std::vector<std::vector<int>>& rows, Tree& tree);
    static void count_rows(const std::vector<std::vector<int>>& rows, Tree& tree);
    void find_supernodes(const Tree& tree);
    void find_rows(const SparseMatrix<double>& lower, const Tree& tree);
    [[nodiscard]] bool eliminate(const SparseMatrix<double>& lower, Supernode& node);

    std::vector<int> m_place; ///< of each unknown in the order of elimination
    std::vector<Supernode> m_supernodes;
    double m_n_entries = 0;
    double m_flops = 0;
};

} // namespace springfit

#include <springfit/solve/detail/multifrontal_cholesky.hpp>
