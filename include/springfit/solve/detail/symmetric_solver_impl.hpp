// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/solve/symmetric_solver.hpp>

namespace springfit {

template <std::floating_point Scalar>
bool SymmetricSolver<Scalar>::solve(const SymmetricMatrix<Scalar>& a, const Values<Scalar>& b, Values<Scalar>& x,
                                    Scalar tolerance) {
    const auto multiply = [&](const Values<Scalar>& p, Values<Scalar>& q) { a.multiply(p, q); };
    if (m_factorised && m_max_cg_iterations > 0 &&
        conjugate_gradients(
            multiply, [&](const Values<Scalar>& r, Values<Scalar>& z) { z = apply_factor(r); }, b, x, tolerance,
            m_max_cg_iterations) == CgOutcome::solved) {
        return true;
    }
    m_factorised = false; // too far away by now
    if (m_max_diagonal_iterations > 0) {
        const Values<Scalar> inverse = a.diagonal().unaryExpr([](Scalar d) { return d > 0 ? 1 / d : Scalar(1); });
        const auto outcome = conjugate_gradients(
            multiply, [&](const Values<Scalar>& r, Values<Scalar>& z) { z = inverse.cwiseProduct(r); }, b, x, tolerance,
            m_max_diagonal_iterations);
        if (outcome == CgOutcome::solved || (outcome == CgOutcome::indefinite && b.dot(x) > 0)) {
            return true;
        }
    }
    if (!factorise(a)) {
        return false;
    }
    x = apply_factor(b);
    return x.allFinite();
}

template <std::floating_point Scalar>
bool SymmetricSolver<Scalar>::factorise(const SymmetricMatrix<Scalar>& a) {
    SparseMatrix<double> matrix = a.lower().template cast<double>();
    if (a.n_terms() > 0) {
        extend(a, matrix);
    }
    m_shift = 0;
    m_factorised = false;
    m_size = a.size();
    for (int attempt = 0; attempt < 10 && !m_factorised; ++attempt) {
        if (attempt == 0) {
            m_factorised = try_factorising(a, matrix);
        } else {
            m_shift = (m_shift > 0) ? 100 * m_shift : std::sqrt(std::numeric_limits<Scalar>::epsilon());
            SparseMatrix<double> shifted = matrix;
            for (Index i = 0; i < m_size; ++i) {
                double& diagonal = shifted.valuePtr()[shifted.outerIndexPtr()[i]];
                diagonal += m_shift * std::max<double>(std::abs(diagonal), std::numeric_limits<Scalar>::min());
            }
            m_factorised = try_factorising(a, shifted);
        }
    }
    m_n_factorisations += m_factorised ? 1 : 0;
    return m_factorised;
}

template <std::floating_point Scalar>
auto SymmetricSolver<Scalar>::apply_factor(const Values<Scalar>& b) const -> Values<Scalar> {
    Values<double> x;
    if (!m_has_terms) {
        m_factor.solve(b.template cast<double>(), x);
        return x.template cast<Scalar>();
    }
    Values<double> extended = Values<double>::Zero(m_extended_factor.rows());
    extended.head(b.size()) = b.template cast<double>();
    x = m_extended_factor.solve(extended);
    return x.head(b.size()).template cast<Scalar>();
}

template <std::floating_point Scalar>
bool SymmetricSolver<Scalar>::try_factorising(const SymmetricMatrix<Scalar>& a, const SparseMatrix<double>& matrix) {
    const bool new_pattern = !m_analysed || m_has_terms != (a.n_terms() > 0);
    m_has_terms = a.n_terms() > 0;
    m_analysed = true;
    if (!m_has_terms) {
        if (new_pattern) {
            m_factor.analyse(matrix);
        }
        return m_factor.factorise(matrix);
    }
    if (new_pattern) {
        m_extended_factor.analyzePattern(matrix);
    }
    m_extended_factor.factorize(matrix);
    return m_extended_factor.info() == Eigen::Success && pivots_agree(a);
}

template <std::floating_point Scalar>
void SymmetricSolver<Scalar>::extend(const SymmetricMatrix<Scalar>& a, SparseMatrix<double>& matrix) {
    const Index n = a.size();
    const Index terms = a.n_terms();
    const SparseMatrix<Scalar> rows = a.columns().transpose();
    SparseMatrix<double> extended(n + terms, n + terms);
    extended.reserve(matrix.nonZeros() + rows.nonZeros() + terms);
    for (Index i = 0; i < n; ++i) {
        extended.startVec(i);
        for (SparseMatrix<double>::InnerIterator entry(matrix, i); entry; ++entry) {
            extended.insertBack(entry.row(), i) = entry.value();
        }
        for (typename SparseMatrix<Scalar>::InnerIterator entry(rows, i); entry; ++entry) {
            extended.insertBack(n + entry.row(), i) = entry.value() * std::sqrt(std::abs(a.weight(entry.row())));
        }
    }
    for (Index p = 0; p < terms; ++p) {
        extended.startVec(n + p);
        extended.insertBack(n + p, n + p) = a.weight(p) < 0 ? 1 : -1;
    }
    extended.finalize();
    matrix.swap(extended);
}

template <std::floating_point Scalar>
bool SymmetricSolver<Scalar>::pivots_agree(const SymmetricMatrix<Scalar>& a) const {
    const Values<double> pivots = m_extended_factor.vectorD();
    Index expected = 0;
    for (Index p = 0; p < a.n_terms(); ++p) {
        expected += a.weight(p) < 0 ? 0 : 1;
    }
    return pivots.allFinite() && (pivots.array() < 0).count() == expected;
}

} // namespace springfit
