// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <springfit/core/types.hpp>

#ifdef SPRINGFIT_CHOLMOD
#include <springfit/cholmod/supernodal_factor.hpp>
#else
#include <springfit/solve/detail/simplicial_factor.hpp>
#endif

namespace springfit {

/// Sparse Cholesky factorisations L L' of symmetric positive definite matrices of one pattern.
///
/// Eigen's, or CHOLMOD's in programs that link springfit::cholmod: its nested dissection fills solids less and its
/// dense kernels are several times as fast. One factorisation at a time; once made, threads may share it.
/// Memory: 12 bytes per entry of L, 8 with CHOLMOD.
template <class Factor>
class BasicSparseCholesky {
public:
    /// Operations of a factorisation in the time of one of Eigen's, about.
    static constexpr double relative_speed = Factor::relative_speed;

    /// Finds the order of elimination and the pattern of L. The unknowns come in groups of `group`, all coupled or not
    /// coupled at all, as the coordinates of nodes are: the order keeps a group together. O(entries of L) at most.
    void analyse(const SparseMatrix<double>& lower, int group = 1) {
        m_pattern_size = lower.nonZeros();
        m_order = Factor::order(graph_of(lower, group));
        m_place.resize(lower.cols());
        for (std::size_t p = 0; p < m_order.size(); ++p) {
            for (int d = 0; d < group; ++d) {
                m_place.indices()(group * m_order[p] + d) = group * static_cast<int>(p) + d;
            }
        }
        m_factor.analyse(ordered(lower));
    }

    /// Factorises the matrix of which `lower` is the lower triangle, `analyse`d anew where its size or number of
    /// entries is another. False where it is not positive definite by a margin: a pivot is not above `margin` of its
    /// diagonal entry; then nothing can be solved.
    [[nodiscard]] bool factorise(const SparseMatrix<double>& lower, double margin = 0, int group = 1) {
        if (m_place.size() != lower.cols() || m_pattern_size != lower.nonZeros()) {
            analyse(lower, group);
        }
        const SparseMatrix<double> matrix = ordered(lower);
        if (!m_factor.factorise(matrix)) {
            return false;
        }
        for (int s = 0; s < m_factor.n_supernodes(); ++s) {
            const detail::Supernode node = m_factor.supernode(s);
            for (int j = 0; j < node.width; ++j) {
                const double pivot = node.values[j * static_cast<Index>(node.height) + j];
                const double diagonal = matrix.valuePtr()[matrix.outerIndexPtr()[node.rows[j]]];
                if (!(pivot * pivot > margin * diagonal)) {
                    return false;
                }
            }
        }
        return true;
    }

    /// The group of unknowns at each place in the order of elimination.
    [[nodiscard]] const std::vector<int>& order() const { return m_order; }
    /// The place of each unknown in the order of elimination [n].
    [[nodiscard]] const Eigen::VectorXi& place() const { return m_place.indices(); }

    /// Several right-hand sides, one row per unknown in the order of elimination.
    template <int Columns>
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Columns, Columns == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

    /// rows becomes (L L')^-1 rows; L is read twice for all columns together. O(entries of L * Columns).
    template <int Columns>
    void substitute(Rows<Columns>& rows) const {
        for (int s = 0; s < m_factor.n_supernodes(); ++s) {
            eliminate<Columns>(m_factor.supernode(s), rows.data());
        }
        for (int s = m_factor.n_supernodes(); s-- > 0;) {
            substitute_back<Columns>(m_factor.supernode(s), rows.data());
        }
    }

    /// x = A^-1 b.
    void solve(const Values<double>& b, Values<double>& x) const {
        Rows<1> rows = m_place * b;
        substitute<1>(rows);
        x = m_place.transpose() * rows;
    }

    /// Calls `visit(column, rows, values, size)` for all columns of L in turn, the diagonal entry first.
    template <class Visit>
    void for_columns(const Visit& visit) const {
        for (int s = 0; s < m_factor.n_supernodes(); ++s) {
            const detail::Supernode node = m_factor.supernode(s);
            for (int j = 0; j < node.width; ++j) {
                visit(node.rows[j], node.rows + j, node.values + j * static_cast<Index>(node.height) + j,
                      node.height - j);
            }
        }
    }

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
    static void eliminate(const detail::Supernode& node, double* data) {
        const Index height = node.height;
        const auto row = [data](Index r) { return Row<Columns>(data + r * Columns); };
        for (int j = 0; j < node.width; ++j) {
            const double* const column = node.values + j * height;
            const Eigen::Array<double, Columns, 1> x = row(node.rows[j]) / column[j];
            row(node.rows[j]) = x;
            for (int i = j + 1; i < node.width; ++i) {
                row(node.rows[i]) -= column[i] * x;
            }
        }
        const auto below = [&]<int N>(std::integral_constant<int, N>, int first) {
            Eigen::Array<double, Columns, N> sums = Eigen::Array<double, Columns, N>::Zero();
            for (int j = 0; j < node.width; ++j) {
                const double* const column = node.values + j * height + first;
                const auto x = row(node.rows[j]);
                for (int i = 0; i < N; ++i) {
                    sums.col(i) += column[i] * x;
                }
            }
            for (int i = 0; i < N; ++i) {
                row(node.rows[first + i]) -= sums.col(i);
            }
        };
        in_tiles(node.width, node.height, below);
    }

    /// Finds the supernode's own unknowns from those below.
    template <int Columns>
    static void substitute_back(const detail::Supernode& node, double* data) {
        const Index height = node.height;
        const auto row = [data](Index r) { return Row<Columns>(data + r * Columns); };
        const auto gather = [&]<int N>(std::integral_constant<int, N>, int first) {
            Eigen::Array<double, Columns, N> sums = Eigen::Array<double, Columns, N>::Zero();
            const double* const columns = node.values + first * height;
            for (int r = node.width; r < node.height; ++r) {
                const auto x = row(node.rows[r]);
                for (int i = 0; i < N; ++i) {
                    sums.col(i) += columns[i * height + r] * x;
                }
            }
            for (int i = 0; i < N; ++i) {
                row(node.rows[first + i]) -= sums.col(i);
            }
        };
        in_tiles(0, node.width, gather);
        for (int j = node.width; j-- > 0;) {
            const double* const column = node.values + j * height;
            Eigen::Array<double, Columns, 1> x = row(node.rows[j]);
            for (int i = j + 1; i < node.width; ++i) {
                x -= column[i] * row(node.rows[i]);
            }
            row(node.rows[j]) = x / column[j];
        }
    }

    template <class Body>
    static void in_tiles(int begin, int end, const Body& body) {
        for (; begin + tile <= end; begin += tile) {
            body(std::integral_constant<int, tile>{}, begin);
        }
        for (; begin < end; ++begin) {
            body(std::integral_constant<int, 1>{}, begin);
        }
    }

    static SparseMatrix<double> graph_of(const SparseMatrix<double>& lower, int group) {
        const Index n = lower.cols() / group;
        std::vector<Eigen::Triplet<double>> entries;
        for (Index c = 0; c < n; ++c) {
            for (SparseMatrix<double>::InnerIterator entry(lower, group * c); entry; ++entry) {
                if (entry.row() % group == 0) {
                    entries.emplace_back(static_cast<int>(entry.row() / group), static_cast<int>(c), 1.);
                }
            }
        }
        SparseMatrix<double> graph(n, n);
        graph.setFromTriplets(entries.begin(), entries.end());
        return graph;
    }

    /// The lower triangle in the order of elimination; its rows ascend in each column.
    [[nodiscard]] SparseMatrix<double> ordered(const SparseMatrix<double>& lower) const {
        SparseMatrix<double> upper(lower.rows(), lower.cols());
        upper.selfadjointView<Eigen::Upper>() = lower.selfadjointView<Eigen::Lower>().twistedBy(m_place);
        return upper.transpose();
    }

    template <class Term>
    [[nodiscard]] double sum_over_columns(const Term& term) const {
        double sum = 0;
        for (int s = 0; s < m_factor.n_supernodes(); ++s) {
            const detail::Supernode node = m_factor.supernode(s);
            for (int j = 0; j < node.width; ++j) {
                sum += term(static_cast<double>(node.height - j));
            }
        }
        return sum;
    }

    Index m_pattern_size = -1;
    std::vector<int> m_order;
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> m_place;
    Factor m_factor;
};

#ifdef SPRINGFIT_CHOLMOD
using SparseCholesky = BasicSparseCholesky<detail::SupernodalFactor>;
#else
using SparseCholesky = BasicSparseCholesky<detail::SimplicialFactor>;
#endif

} // namespace springfit
