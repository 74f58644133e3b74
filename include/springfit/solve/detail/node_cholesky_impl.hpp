// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/solve/detail/node_cholesky.hpp>

namespace springfit::detail {

template <int Dim, std::floating_point Scalar>
NodeCholesky<Dim, Scalar>::NodeCholesky(const SparseMatrix<Scalar>& lower) {
    SparseCholesky factor;
    if (factor.factorise(lower.template cast<double>(), 1000 * std::numeric_limits<Scalar>::epsilon(), Dim)) {
        m_order = factor.order();
        take_blocks(factor);
        m_is_usable = true;
    }
}

template <int Dim, std::floating_point Scalar>
void NodeCholesky<Dim, Scalar>::solve(Work& work) const {
    Scalar* const rows = work.data();
    const int n = static_cast<int>(m_order.size());
    for (int c = 0; c < n; ++c) {
        Scalar* const own = rows + stride * c;
        std::array<Scalar, Dim> x{};
        const Corner& inverse = m_corners[static_cast<std::size_t>(c)];
        for (int d = 0; d < Dim; ++d) {
            for (int e = 0; e <= d; ++e) {
                x[d] += inverse(d, e) * own[e];
            }
        }
        for (int d = 0; d < Dim; ++d) {
            own[d] = x[d];
        }
        for (int b = m_begin[c]; b < m_begin[c + 1]; ++b) {
            const float* const block = m_blocks.data() + Dim * stride * static_cast<std::size_t>(b);
            Scalar* const other = rows + stride * m_rows[b];
            for (int r = 0; r < stride; ++r) {
                Scalar sum = other[r];
                for (int d = 0; d < Dim; ++d) {
                    sum -= static_cast<Scalar>(block[stride * d + r]) * x[d];
                }
                other[r] = sum;
            }
        }
    }
    for (int c = n; c-- > 0;) {
        std::array<std::array<Scalar, stride>, Dim> sums{};
        for (int b = m_begin[c]; b < m_begin[c + 1]; ++b) {
            const float* const block = m_blocks.data() + Dim * stride * static_cast<std::size_t>(b);
            const Scalar* const other = rows + stride * m_rows[b];
            for (int d = 0; d < Dim; ++d) {
                for (int r = 0; r < stride; ++r) {
                    sums[d][r] += static_cast<Scalar>(block[stride * d + r]) * other[r];
                }
            }
        }
        Scalar* const own = rows + stride * c;
        std::array<Scalar, Dim> y{};
        for (int d = 0; d < Dim; ++d) {
            y[d] = own[d];
            for (int r = 0; r < stride; ++r) {
                y[d] -= sums[d][r];
            }
        }
        const Corner& inverse = m_corners[static_cast<std::size_t>(c)];
        for (int d = 0; d < Dim; ++d) {
            own[d] = 0;
            for (int e = d; e < Dim; ++e) {
                own[d] += inverse(e, d) * y[e];
            }
        }
    }
}

template <int Dim, std::floating_point Scalar>
void NodeCholesky<Dim, Scalar>::take_blocks(const SparseCholesky& factor) {
    m_begin.assign(1, 0);
    m_corners.reserve(m_order.size());
    Corner corner = Corner::Zero();
    std::size_t first = 0; // block of the node at hand
    factor.for_columns([&](int column, const int* rows, const double* values, int size) {
        const int d = column % Dim;
        std::size_t block = first;
        for (int p = 0; p < size; ++p) {
            const int r = rows[p] % Dim;
            if (rows[p] / Dim == column / Dim) {
                corner(r, d) = static_cast<Scalar>(values[p]);
                continue;
            }
            if (d == 0 && r == 0) {
                m_rows.push_back(rows[p] / Dim);
                m_blocks.resize(m_blocks.size() + Dim * stride, 0.F);
            }
            m_blocks[block + static_cast<std::size_t>(stride * d + r)] = static_cast<float>(values[p]);
            block += r == Dim - 1 ? Dim * stride : 0;
        }
        if (d == Dim - 1) {
            m_begin.push_back(static_cast<int>(m_rows.size()));
            m_corners.push_back(corner.template triangularView<Eigen::Lower>().solve(Corner::Identity()));
            first = m_blocks.size();
        }
    });
}

} // namespace springfit::detail
