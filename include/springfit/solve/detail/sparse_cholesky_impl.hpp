// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/solve/sparse_cholesky.hpp>

namespace springfit {

template <std::same_as<double> Scalar>
BasicSparseCholesky<Scalar>::BasicSparseCholesky() {
    const MakeSparseFactor make = detail::default_sparse_factor;
    m_factor = make ? make() : simplicial_factor<Scalar>();
}

template <std::same_as<double> Scalar>
void BasicSparseCholesky<Scalar>::analyse(const SparseMatrix<double>& lower, int group) {
    m_pattern_size = lower.nonZeros();
    m_order = m_factor->order(graph_of(lower, group));
    m_place.resize(lower.cols());
    for (std::size_t p = 0; p < m_order.size(); ++p) {
        for (int d = 0; d < group; ++d) {
            m_place.indices()(group * m_order[p] + d) = group * static_cast<int>(p) + d;
        }
    }
    m_factor->analyse(ordered(lower));
}

template <std::same_as<double> Scalar>
bool BasicSparseCholesky<Scalar>::factorise(const SparseMatrix<double>& lower, double margin, int group) {
    if (m_place.size() != lower.cols() || m_pattern_size != lower.nonZeros()) {
        analyse(lower, group);
    }
    const SparseMatrix<double> matrix = ordered(lower);
    if (!m_factor->factorise(matrix)) {
        return false;
    }
    const detail::Supernodes nodes = m_factor->supernodes();
    for (int s = 0; s < nodes.size; ++s) {
        const detail::Supernode node = nodes[s];
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

template <std::same_as<double> Scalar>
template <int Columns>
void BasicSparseCholesky<Scalar>::substitute(Rows<Columns>& rows) const {
    const detail::Supernodes nodes = m_factor->supernodes();
    for (int s = 0; s < nodes.size; ++s) {
        eliminate<Columns>(nodes[s], rows.data());
    }
    for (int s = nodes.size; s-- > 0;) {
        substitute_back<Columns>(nodes[s], rows.data());
    }
}

template <std::same_as<double> Scalar>
template <class Visit>
void BasicSparseCholesky<Scalar>::for_columns(const Visit& visit) const {
    const detail::Supernodes nodes = m_factor->supernodes();
    for (int s = 0; s < nodes.size; ++s) {
        const detail::Supernode node = nodes[s];
        for (int j = 0; j < node.width; ++j) {
            visit(node.rows[j], node.rows + j, node.values + j * static_cast<Index>(node.height) + j, node.height - j);
        }
    }
}

template <std::same_as<double> Scalar>
template <int Columns>
void BasicSparseCholesky<Scalar>::eliminate(const detail::Supernode& node, double* data) {
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

template <std::same_as<double> Scalar>
template <int Columns>
void BasicSparseCholesky<Scalar>::substitute_back(const detail::Supernode& node, double* data) {
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

template <std::same_as<double> Scalar>
template <class Body>
void BasicSparseCholesky<Scalar>::in_tiles(int begin, int end, const Body& body) {
    for (; begin + tile <= end; begin += tile) {
        body(std::integral_constant<int, tile>{}, begin);
    }
    for (; begin < end; ++begin) {
        body(std::integral_constant<int, 1>{}, begin);
    }
}

template <std::same_as<double> Scalar>
auto BasicSparseCholesky<Scalar>::graph_of(const SparseMatrix<double>& lower, int group) -> SparseMatrix<double> {
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

template <std::same_as<double> Scalar>
template <class Term>
double BasicSparseCholesky<Scalar>::sum_over_columns(const Term& term) const {
    const detail::Supernodes nodes = m_factor->supernodes();
    double sum = 0;
    for (int s = 0; s < nodes.size; ++s) {
        for (int j = 0; j < nodes.width(s); ++j) {
            sum += term(static_cast<double>(nodes.height(s) - j));
        }
    }
    return sum;
}

} // namespace springfit
