// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <springfit/solve/free_nodes.hpp>

namespace springfit {

/// Groups of nodes that a dense block couples: the nodes of each cell, the ends of each spring, ...
using Cliques = std::vector<std::vector<int>>;

/// The cliques of an array with one column of nodes each, as `Mesh::cells` or `SpringNetwork::springs`.
template <class NodeArray>
[[nodiscard]] Cliques cliques_of(const NodeArray& columns) {
    Cliques cliques(static_cast<std::size_t>(columns.cols()));
    for (Index c = 0; c < columns.cols(); ++c) {
        cliques[static_cast<std::size_t>(c)].assign(columns.col(c).begin(), columns.col(c).end());
    }
    return cliques;
}

/// A symmetric sparse matrix over the coordinates of the free nodes, assembled from dense blocks, one per clique.
///
/// The pattern is fixed at construction, so a solver analyses it once; `add` writes straight to its place. Only the
/// lower triangle is stored. Memory: 12 bytes per pair of nodes in a clique, besides the matrix.
template <int Dim, std::floating_point Scalar>
class CliqueMatrix {
public:
    CliqueMatrix() = default;

    CliqueMatrix(const FreeNodes& free, const Cliques& cliques) : m_free(free) {
        const Index n = free.n_free();
        std::vector<std::vector<int>> below(static_cast<std::size_t>(n)); // free node numbers >= own, per column
        for (const auto& clique : cliques) {
            for (int a : clique) {
                for (int b : clique) {
                    const int column = free.number(a);
                    const int row = free.number(b);
                    if (column >= 0 && row >= column) {
                        below[static_cast<std::size_t>(column)].push_back(row);
                    }
                }
            }
        }
        Eigen::VectorXi per_column(Dim * n);
        for (Index c = 0; c < n; ++c) {
            auto& rows = below[static_cast<std::size_t>(c)];
            rows.push_back(static_cast<int>(c));
            std::sort(rows.begin(), rows.end());
            rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
            for (int d = 0; d < Dim; ++d) {
                per_column(Dim * c + d) = Dim * static_cast<int>(rows.size()) - d;
            }
        }
        m_matrix.resize(Dim * n, Dim * n);
        if (n > 0) { // Eigen's makeCompressed would read beyond a matrix without columns
            m_matrix.reserve(per_column);
        }
        for (Index c = 0; c < n; ++c) {
            for (int d = 0; d < Dim; ++d) {
                for (int row : below[static_cast<std::size_t>(c)]) {
                    for (int r = (row == c ? d : 0); r < Dim; ++r) {
                        m_matrix.insert(Dim * row + r, Dim * c + d) = 0;
                    }
                }
            }
        }
        m_matrix.makeCompressed();
        locate_blocks(cliques);
    }

    void set_zero() { m_matrix.coeffs().setZero(); }

    void scale(Scalar factor) { m_matrix.coeffs() *= factor; }

    /// Adds a dense symmetric block `[Dim * size x Dim * size]` at the nodes of a clique.
    template <class Block>
    void add(Index clique, const Block& block) {
        const std::vector<Place>& places = m_places[static_cast<std::size_t>(clique)];
        const Index size = block.cols() / Dim;
        for (Index b = 0; b < size; ++b) {
            for (Index a = 0; a < size; ++a) {
                const Place place = places[static_cast<std::size_t>(b * size + a)];
                if (place.first < 0) {
                    continue;
                }
                for (int d = 0; d < Dim; ++d) {
                    Scalar* column = m_matrix.valuePtr() + place.first + d * place.stride - skipped(d);
                    for (int r = place.diagonal ? d : 0; r < Dim; ++r) {
                        column[r] += block(Dim * a + r, Dim * b + d);
                    }
                }
            }
        }
    }

    /// Adds `value` to the diagonal entries of a free node, by its number among the free ones.
    void add_diagonal(Index free_number, Scalar value) {
        for (int d = 0; d < Dim; ++d) {
            m_matrix.valuePtr()[m_matrix.outerIndexPtr()[Dim * free_number + d]] += value;
        }
    }

    /// The lower triangle `[Dim * n_free x Dim * n_free]`.
    [[nodiscard]] const SparseMatrix<Scalar>& matrix() const { return m_matrix; }
    [[nodiscard]] const FreeNodes& free_nodes() const { return m_free; }

private:
    /// Where the block of one pair of nodes lies among the values.
    struct Place {
        int first = -1;        ///< entry of its first row in its first column; -1: above the diagonal or fixed
        int stride = 0;        ///< length of its first column
        bool diagonal = false; ///< a node with itself: only the lower triangle is stored
    };

    /// Entries that the triangle leaves out of columns 0 to d of a node, above a row of column d.
    static constexpr int skipped(int d) { return d * (d + 1) / 2; }

    void locate_blocks(const Cliques& cliques) {
        m_places.resize(cliques.size());
        for (std::size_t c = 0; c < cliques.size(); ++c) {
            m_places[c].reserve(cliques[c].size() * cliques[c].size());
            for (int b : cliques[c]) {
                for (int a : cliques[c]) {
                    m_places[c].push_back(locate(m_free.number(a), m_free.number(b)));
                }
            }
        }
    }

    [[nodiscard]] Place locate(int row, int column) const {
        if (column < 0 || row < column) {
            return {};
        }
        const int begin = m_matrix.outerIndexPtr()[Dim * column];
        const int end = m_matrix.outerIndexPtr()[Dim * column + 1];
        const int* inner = m_matrix.innerIndexPtr();
        const auto first = static_cast<int>(std::lower_bound(inner + begin, inner + end, Dim * row) - inner);
        return {first, end - begin, row == column};
    }

    FreeNodes m_free;
    SparseMatrix<Scalar> m_matrix;
    std::vector<std::vector<Place>> m_places; ///< per clique, its pairs of nodes column by column
};

} // namespace springfit
