// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/solve/block_matrix.hpp>

namespace springfit {

template <int Dim, std::floating_point Scalar>
BlockMatrix<Dim, Scalar>::BlockMatrix(const FreeNodes& free, const Cliques& cliques) : m_free(free) {
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

template <int Dim, std::floating_point Scalar>
template <class Block>
void BlockMatrix<Dim, Scalar>::add(Index clique, const Block& block) {
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

template <int Dim, std::floating_point Scalar>
void BlockMatrix<Dim, Scalar>::locate_blocks(const Cliques& cliques) {
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

template <int Dim, std::floating_point Scalar>
auto BlockMatrix<Dim, Scalar>::locate(int row, int column) const -> Place {
    if (column < 0 || row < column) {
        return {};
    }
    const int begin = m_matrix.outerIndexPtr()[Dim * column];
    const int end = m_matrix.outerIndexPtr()[Dim * column + 1];
    const int* inner = m_matrix.innerIndexPtr();
    const auto first = static_cast<int>(std::lower_bound(inner + begin, inner + end, Dim * row) - inner);
    return {first, end - begin, row == column};
}

} // namespace springfit
