// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fem/stiffness.hpp>

namespace springfit::fem {

template <int Dim, std::floating_point Scalar>
template <class Gradient>
void Stiffness<Dim, Scalar>::add_to_patches(Index cell, const Gradient& gradient) {
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

template <int Dim, std::floating_point Scalar>
void Stiffness<Dim, Scalar>::combine(Scalar stiffness, Scalar mass, const Values<Scalar>& masses) {
    m_local.scale(stiffness);
    m_weights *= stiffness;
    const auto& nodes = free_nodes().nodes();
    for (std::size_t f = 0; f < nodes.size(); ++f) {
        m_local.add_diagonal(static_cast<Index>(f), mass * masses(nodes[f]));
    }
}

template <int Dim, std::floating_point Scalar>
void Stiffness<Dim, Scalar>::make_patches(const FreeNodes& free, const Cliques& cells) {
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
                m_places.push_back(free.number(a) < 0
                                       ? -1
                                       : m_columns.outerIndexPtr()[p] + Dim * static_cast<int>(found - around.begin()));
            }
        }
    }
}

} // namespace springfit::fem
