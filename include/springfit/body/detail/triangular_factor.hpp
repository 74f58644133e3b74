// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/body/detail/moving_nodes.hpp>
#include <springfit/solve/sparse_cholesky.hpp>

namespace springfit::detail {

/// The Cholesky factor of one matrix over the nodes, for right-hand sides of a vector per node.
///
/// Single precision, as a correction of positions needs no more: half the memory to read.
class TriangularFactor {
public:
    /// False where the matrix, given by the entries of its lower triangle, is not positive definite.
    template <std::same_as<float> Entry>
    [[nodiscard]] bool factorise(int size, const std::vector<Eigen::Triplet<Entry>>& entries) {
        m_rows.clear();
        m_values.clear();
        SparseMatrix<double> matrix(size, size);
        matrix.setFromTriplets(entries.begin(), entries.end());
        SparseCholesky cholesky;
        if (!cholesky.factorise(matrix)) {
            return false;
        }
        m_first.assign(1, 0);
        cholesky.for_columns([&](int, const int* rows, const double* values, int entries_of_column) {
            m_rows.insert(m_rows.end(), rows, rows + entries_of_column);
            m_values.insert(m_values.end(), values, values + entries_of_column);
            m_first.push_back(static_cast<int>(m_rows.size()));
        });
        m_place.assign(cholesky.place().begin(), cholesky.place().end());
        m_work.resize(static_cast<std::size_t>(size));
        for (std::size_t column = 0; column + 1 < m_first.size(); ++column) { // the solves multiply
            float& diagonal = m_values[static_cast<std::size_t>(m_first[column])];
            diagonal = 1 / diagonal;
        }
        return true;
    }

    [[nodiscard]] Index n_entries() const { return static_cast<Index>(m_values.size()); }

    void solve(const std::vector<Four<float>>& right, std::vector<Four<float>>& solution) {
        for (std::size_t i = 0; i < m_place.size(); ++i) {
            m_work[static_cast<std::size_t>(m_place[i])] = right[i];
        }
        Four<float>* const x = m_work.data();
        const int* const rows = m_rows.data();
        const float* const values = m_values.data();
        const int n = static_cast<int>(m_work.size());
        for (int column = 0; column < n; ++column) {
            const int first = m_first[static_cast<std::size_t>(column)];
            const int end = m_first[static_cast<std::size_t>(column) + 1];
            const Simd<float, 4> own = values[first] * x[column].lanes;
            x[column].lanes = own;
            for (int e = first + 1; e < end; ++e) {
                x[rows[e]].lanes -= values[e] * own;
            }
        }
        for (int column = n - 1; column >= 0; --column) {
            const int first = m_first[static_cast<std::size_t>(column)];
            const int end = m_first[static_cast<std::size_t>(column) + 1];
            Simd<float, 4> sums[4] = {x[column].lanes};
            int e = first + 1;
            for (; e + 4 <= end; e += 4) { // in four sums, which do not wait for each other
                for (int s = 0; s < 4; ++s) {
                    sums[s] -= values[e + s] * x[rows[e + s]].lanes;
                }
            }
            for (; e < end; ++e) {
                sums[0] -= values[e] * x[rows[e]].lanes;
            }
            x[column].lanes = values[first] * ((sums[0] + sums[1]) + (sums[2] + sums[3]));
        }
        for (std::size_t i = 0; i < m_place.size(); ++i) {
            solution[i] = m_work[static_cast<std::size_t>(m_place[i])];
        }
    }

private:
    std::vector<int> m_first, m_rows, m_place;
    std::vector<float> m_values; ///< by columns, the inverse of the diagonal entry first
    std::vector<Four<float>> m_work;
};

} // namespace springfit::detail
