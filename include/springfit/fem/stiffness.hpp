// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/solve/clique_matrix.hpp>
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
    void add_to_patches(Index cell, const Gradient& gradient) {
        const Index n = gradient.cols();
        const int* place = m_places.data() + cell * n * n;
        for (Index p = 0; p < n; ++p) {
            for (Index a = 0; a < n; ++a, ++place) {
                if (*place >= 0) {
                    for (int d = 0; d < Dim; ++d) {
                        m_columns.valuePtr()[*place + d] += gradient(d, a);
                    }
                }
            }
        }
    }

    void set_patch_weight(Index patch, Scalar weight) { m_weights(patch) = weight; }

    /// The matrix becomes stiffness * A + mass * diag(masses), as the time steps need it.
    void combine(Scalar stiffness, Scalar mass, const Values<Scalar>& masses) {
        m_local.scale(stiffness);
        m_weights *= stiffness;
        const auto& nodes = free_nodes().nodes();
        for (std::size_t f = 0; f < nodes.size(); ++f) {
            m_local.add_diagonal(static_cast<Index>(f), mass * masses(nodes[f]));
        }
    }

private:
    void make_patches(const FreeNodes& free, const Cliques& cells) {
        const Index n_patches = free.n_nodes();
        std::vector<std::vector<int>> rows(static_cast<std::size_t>(n_patches)); // free numbers of the nodes around
        for (const auto& cell : cells) {
            for (int p : cell) {
                for (int a : cell) {
                    if (free.number(a) >= 0) {
                        rows[static_cast<std::size_t>(p)].push_back(free.number(a));
                    }
                }
            }
        }
        Eigen::VectorXi per_column(n_patches);
        for (Index p = 0; p < n_patches; ++p) {
            auto& around = rows[static_cast<std::size_t>(p)];
            std::sort(around.begin(), around.end());
            around.erase(std::unique(around.begin(), around.end()), around.end());
            per_column(p) = Dim * static_cast<int>(around.size());
        }
        m_columns.resize(Dim * free.n_free(), n_patches);
        m_columns.reserve(per_column);
        for (Index p = 0; p < n_patches; ++p) {
            for (int row : rows[static_cast<std::size_t>(p)]) {
                for (int d = 0; d < Dim; ++d) {
                    m_columns.insert(Dim * row + d, p) = 0;
                }
            }
        }
        m_columns.makeCompressed();
        m_weights.setZero(n_patches);
        for (const auto& cell : cells) {
            for (int p : cell) {
                const auto& around = rows[static_cast<std::size_t>(p)];
                for (int a : cell) {
                    const auto found = std::lower_bound(around.begin(), around.end(), free.number(a));
                    m_places.push_back(free.number(a) < 0 ? -1
                                                          : m_columns.outerIndexPtr()[p] +
                                                                Dim * static_cast<int>(found - around.begin()));
                }
            }
        }
    }

    CliqueMatrix<Dim, Scalar> m_local;
    SparseMatrix<Scalar> m_columns; ///< [Dim * n_free x n_patches]
    Values<Scalar> m_weights;       ///< [n_patches]
    std::vector<int> m_places;      ///< per cell, patch of the cell and node of the cell: place among the values
};

} // namespace springfit::fem
