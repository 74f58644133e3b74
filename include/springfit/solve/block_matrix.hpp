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
class BlockMatrix {
public:
    BlockMatrix() = default;

    BlockMatrix(const FreeNodes& free, const Cliques& cliques);

    void set_zero() { m_matrix.coeffs().setZero(); }

    void scale(Scalar factor) { m_matrix.coeffs() *= factor; }

    /// Adds a dense symmetric block `[Dim * size x Dim * size]` at the nodes of a clique.
    template <class Block>
    void add(Index clique, const Block& block);

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

    void locate_blocks(const Cliques& cliques);

    [[nodiscard]] Place locate(int row, int column) const;

    FreeNodes m_free;
    SparseMatrix<Scalar> m_matrix;
    std::vector<std::vector<Place>> m_places; ///< per clique, its pairs of nodes column by column
};

} // namespace springfit

#include <springfit/solve/detail/block_matrix_impl.hpp>
