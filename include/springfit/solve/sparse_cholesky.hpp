// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <memory>
#include <utility>
#include <vector>

#include <springfit/core/error.hpp>
#include <springfit/core/types.hpp>
#include <springfit/solve/sparse_factor.hpp>

namespace springfit {

/// Sparse Cholesky factorisations L L' of symmetric positive definite matrices of one pattern.
///
/// Eigen finds the factor, or CHOLMOD in programs that call `cholmod::use_supernodal_factors()`: its nested dissection
/// fills solids less and its dense kernels are several times as fast. One factorisation at a time; once made, threads
/// may share it. Memory: 12 bytes per entry of L, 8 with CHOLMOD.
template <std::same_as<double> Scalar>
class BasicSparseCholesky {
public:
    /// With a factor of the program's choice at this time: `set_default_sparse_factor`.
    BasicSparseCholesky();
    /// With this factor: `simplicial_factor()`, `cholmod::supernodal_factor()`.
    explicit BasicSparseCholesky(std::unique_ptr<SparseFactor> factor) : m_factor(std::move(factor)) {
        require(m_factor != nullptr, "factor", "one to fill", "none");
    }

    /// Operations of a factorisation in the time of one of Eigen's, about.
    [[nodiscard]] double relative_speed() const { return m_factor->relative_speed(); }

    /// Finds the order of elimination and the pattern of L. The unknowns come in groups of `group`, all coupled or not
    /// coupled at all, as the coordinates of nodes are: the order keeps a group together. O(entries of L) at most.
    void analyse(const SparseMatrix<double>& lower, int group = 1);

    /// Factorises the matrix of which `lower` is the lower triangle, `analyse`d anew where its size or number of
    /// entries is another. False where it is not positive definite by a margin: a pivot is not above `margin` of its
    /// diagonal entry; then nothing can be solved.
    [[nodiscard]] bool factorise(const SparseMatrix<double>& lower, double margin = 0, int group = 1);

    /// The group of unknowns at each place in the order of elimination.
    [[nodiscard]] const std::vector<int>& order() const { return m_order; }
    /// The place of each unknown in the order of elimination [n].
    [[nodiscard]] const Eigen::VectorXi& place() const { return m_place.indices(); }

    /// Several right-hand sides, one row per unknown in the order of elimination.
    template <int Columns>
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Columns, Columns == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

    /// rows becomes (L L')^-1 rows; L is read twice for all columns together. O(entries of L * Columns).
    template <int Columns>
    void substitute(Rows<Columns>& rows) const;

    /// x = A^-1 b.
    void solve(const Values<double>& b, Values<double>& x) const {
        Rows<1> rows = m_place * b;
        substitute<1>(rows);
        x = m_place.transpose() * rows;
    }

    /// Calls `visit(column, rows, values, size)` for all columns of L in turn, the diagonal entry first.
    template <class Visit>
    void for_columns(const Visit& visit) const;

    /// Entries of L; known once analysed.
    [[nodiscard]] double n_entries() const {
        return sum_over_columns([](double height) { return height; });
    }
    /// Multiplications and additions that a factorisation takes; known once analysed.
    [[nodiscard]] double flops() const {
        return sum_over_columns([](double height) { return height * height; });
    }

private:
    static constexpr int tile = 4; ///< rows or columns of L that are handled at once, so that sums stay in registers

    template <int Columns>
    using Row = Eigen::Map<Eigen::Array<double, Columns, 1>>;

    /// Subtracts what the supernode's own unknowns, once found, take from the right-hand sides below.
    template <int Columns>
    static void eliminate(const detail::Supernode& node, double* data);

    /// Finds the supernode's own unknowns from those below.
    template <int Columns>
    static void substitute_back(const detail::Supernode& node, double* data);

    template <class Body>
    static void in_tiles(int begin, int end, const Body& body);

    static SparseMatrix<double> graph_of(const SparseMatrix<double>& lower, int group);

    /// The lower triangle in the order of elimination; its rows ascend in each column.
    [[nodiscard]] SparseMatrix<double> ordered(const SparseMatrix<double>& lower) const {
        SparseMatrix<double> upper(lower.rows(), lower.cols());
        upper.selfadjointView<Eigen::Upper>() = lower.selfadjointView<Eigen::Lower>().twistedBy(m_place);
        return upper.transpose();
    }

    template <class Term>
    [[nodiscard]] double sum_over_columns(const Term& term) const;

    Index m_pattern_size = -1;
    std::vector<int> m_order;
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> m_place;
    std::unique_ptr<SparseFactor> m_factor;
};

using SparseCholesky = BasicSparseCholesky<double>;

} // namespace springfit

#include <springfit/solve/detail/sparse_cholesky_impl.hpp>
