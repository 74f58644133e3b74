// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/solve/block_matrix.hpp>
#include <springfit/solve/symmetric_matrix.hpp>

namespace springfit::fem {

/// The tangent stiffness over the free nodes: what couples the nodes of one cell, as a sparse matrix, and one rank-one
/// term per node patch of the mean dilatation, which would couple nodes two cells apart.
///
/// Made by `Model::make_stiffness` (pattern) and filled by `Model::assemble`; use it again for the next positions.
template <int Dim, std::floating_point Scalar>
class Stiffness {
public:
    Stiffness() = default;

    /// `cells`: the nodes of each cell; `with_patches`: one patch around each node.
    Stiffness(const FreeNodes& free, const Cliques& cells, bool with_patches) : m_local(free, cells) {
        if (with_patches) {
            make_patches(free, cells);
        }
    }

    [[nodiscard]] const FreeNodes& free_nodes() const { return m_local.free_nodes(); }

    /// The matrix as a view that holds while this object lives and is not filled anew.
    [[nodiscard]] SymmetricMatrix<Scalar> matrix() const { return {m_local.matrix(), m_columns, m_weights}; }

    void set_zero() {
        m_local.set_zero();
        m_columns.coeffs().setZero();
        m_weights.setZero();
    }

    /// Adds a dense block `[Dim * n x Dim * n]` at the nodes of a cell.
    template <class Block>
    void add_cell(Index cell, const Block& block) {
        m_local.add(cell, block);
    }

    /// Adds `gradient` `[Dim x n]` of a cell to the columns of the patches of its nodes.
    template <class Gradient>
    void add_to_patches(Index cell, const Gradient& gradient);

    void set_patch_weight(Index patch, Scalar weight) { m_weights(patch) = weight; }

    /// The matrix becomes stiffness * A + mass * diag(masses), as the time steps need it.
    void combine(Scalar stiffness, Scalar mass, const Values<Scalar>& masses);

private:
    void make_patches(const FreeNodes& free, const Cliques& cells);

    BlockMatrix<Dim, Scalar> m_local;
    SparseMatrix<Scalar> m_columns; ///< [Dim * n_free x n_patches]
    Values<Scalar> m_weights;       ///< [n_patches]
    std::vector<int> m_places;      ///< per cell, patch of the cell and node of the cell: place among the values
};

} // namespace springfit::fem

#include <springfit/fem/detail/stiffness_impl.hpp>
