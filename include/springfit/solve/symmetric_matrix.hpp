// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <springfit/core/types.hpp>

namespace springfit {

/// A view of a symmetric matrix: a sparse one by its lower triangle, plus any number of weighted rank-one terms,
/// A = L + sum_p w_p b_p b_p', which are kept apart where their product would fill the pattern.
///
/// A sparse lower triangle converts to it. The view must not outlive what it looks at.
template <std::floating_point Scalar>
class SymmetricMatrix {
public:
    SymmetricMatrix(const SparseMatrix<Scalar>& lower) : m_lower(&lower) {} // NOLINT(google-explicit-constructor)

    /// `columns` holds the b_p `[n x n_terms]`, `weights` the w_p `[n_terms]`.
    SymmetricMatrix(const SparseMatrix<Scalar>& lower, const SparseMatrix<Scalar>& columns,
                    const Values<Scalar>& weights)
        : m_lower(&lower), m_columns(columns.cols() > 0 ? &columns : nullptr), m_weights(&weights) {}

    [[nodiscard]] Index size() const { return m_lower->cols(); }
    [[nodiscard]] const SparseMatrix<Scalar>& lower() const { return *m_lower; }
    [[nodiscard]] Index n_terms() const { return m_columns != nullptr ? m_columns->cols() : 0; }
    /// The b_p; only where `n_terms() > 0`.
    [[nodiscard]] const SparseMatrix<Scalar>& columns() const { return *m_columns; }
    [[nodiscard]] Scalar weight(Index term) const { return (*m_weights)(term); }

    /// y = A x. O(entries).
    void multiply(const Values<Scalar>& x, Values<Scalar>& y) const;

    /// The diagonal of A.
    [[nodiscard]] Values<Scalar> diagonal() const;

    /// The lower triangle of A with the rank-one terms multiplied out.
    [[nodiscard]] SparseMatrix<Scalar> assembled() const;

private:
    const SparseMatrix<Scalar>* m_lower;
    const SparseMatrix<Scalar>* m_columns = nullptr;
    const Values<Scalar>* m_weights = nullptr;
};

} // namespace springfit

#include <springfit/solve/detail/symmetric_matrix_impl.hpp>
