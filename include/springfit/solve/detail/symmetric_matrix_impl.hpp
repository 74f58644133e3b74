// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/solve/symmetric_matrix.hpp>

namespace springfit {

template <std::floating_point Scalar>
void SymmetricMatrix<Scalar>::multiply(const Values<Scalar>& x, Values<Scalar>& y) const {
    y.noalias() = m_lower->template selfadjointView<Eigen::Lower>() * x;
    for (Index p = 0; p < n_terms(); ++p) {
        Scalar along = 0;
        for (typename SparseMatrix<Scalar>::InnerIterator entry(*m_columns, p); entry; ++entry) {
            along += entry.value() * x(entry.row());
        }
        along *= weight(p);
        for (typename SparseMatrix<Scalar>::InnerIterator entry(*m_columns, p); entry; ++entry) {
            y(entry.row()) += along * entry.value();
        }
    }
}

template <std::floating_point Scalar>
auto SymmetricMatrix<Scalar>::diagonal() const -> Values<Scalar> {
    Values<Scalar> diagonal(size());
    for (Index i = 0; i < size(); ++i) {
        diagonal(i) = m_lower->valuePtr()[m_lower->outerIndexPtr()[i]];
    }
    for (Index p = 0; p < n_terms(); ++p) {
        for (typename SparseMatrix<Scalar>::InnerIterator entry(*m_columns, p); entry; ++entry) {
            diagonal(entry.row()) += weight(p) * entry.value() * entry.value();
        }
    }
    return diagonal;
}

template <std::floating_point Scalar>
auto SymmetricMatrix<Scalar>::assembled() const -> SparseMatrix<Scalar> {
    if (n_terms() == 0) {
        return *m_lower;
    }
    SparseMatrix<Scalar> weighted = *m_columns;
    for (Index p = 0; p < n_terms(); ++p) {
        for (typename SparseMatrix<Scalar>::InnerIterator entry(weighted, p); entry; ++entry) {
            entry.valueRef() *= weight(p);
        }
    }
    const SparseMatrix<Scalar> transposed = m_columns->transpose();
    const SparseMatrix<Scalar> product = weighted * transposed;
    SparseMatrix<Scalar> lower_product = product.template triangularView<Eigen::Lower>();
    return *m_lower + lower_product;
}

} // namespace springfit
