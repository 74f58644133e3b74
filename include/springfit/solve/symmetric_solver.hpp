// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>

#include <Eigen/SparseCholesky>

#include <springfit/solve/conjugate_gradients.hpp>
#include <springfit/solve/sparse_cholesky.hpp>

namespace springfit {

/// Solves A x = b for a sequence of symmetric matrices of one sparsity pattern (lower triangles, with any rank-one
/// terms kept apart).
///
/// The symbolic analysis is done once. A numeric factorisation is kept as the preconditioner of conjugate gradients for
/// the matrices that follow, and is renewed when they take more than `max_cg_iterations`: near each other, as from one
/// Newton or time step to the next, a few cheap iterations replace an expensive factorisation. Well conditioned
/// matrices, as of short time steps, need none: `set_max_diagonal_iterations` tries the diagonal as preconditioner
/// before a new factorisation.
///
/// A matrix that is not positive definite is shifted, A + s diag(|A|), until it is: the Newton direction then points
/// downhill. (With the diagonal as preconditioner, the iterate before the negative curvature is returned instead, which
/// also points downhill.) Rank-one terms are factorised as extra unknowns,
///     [ L       B sqrt|w| ] [x]   [b]
///     [ sym.   -sign w    ] [q] = [0],
/// which fills much less than their product; the signs of the pivots tell whether A is positive definite.
template <std::floating_point Scalar>
class SymmetricSolver {
public:
    /// Forgets everything; call it when the pattern changes.
    void reset() {
        m_analysed = false;
        m_factorised = false;
    }

    /// Allow 0 iterations to factorise every matrix anew.
    void set_max_cg_iterations(int iterations) { m_max_cg_iterations = iterations; }

    /// Iterations with the diagonal as preconditioner that are tried before every factorisation; 0, the default: none.
    void set_max_diagonal_iterations(int iterations) { m_max_diagonal_iterations = iterations; }

    /// The solution to a relative residual of `tolerance`; false where no factorisation could be had.
    [[nodiscard]] bool solve(const SymmetricMatrix<Scalar>& a, const Values<Scalar>& b, Values<Scalar>& x,
                             Scalar tolerance) {
        if (m_factorised && m_max_cg_iterations > 0 &&
            conjugate_gradients(a, b, x, tolerance, m_max_cg_iterations,
                                [&](const Values<Scalar>& r, Values<Scalar>& z) { z = apply_factor(r); }) ==
                CgOutcome::solved) {
            return true;
        }
        m_factorised = false; // too far away by now
        if (m_max_diagonal_iterations > 0) {
            const Values<Scalar> inverse = a.diagonal().unaryExpr([](Scalar d) { return d > 0 ? 1 / d : Scalar(1); });
            const auto outcome =
                conjugate_gradients(a, b, x, tolerance, m_max_diagonal_iterations,
                                    [&](const Values<Scalar>& r, Values<Scalar>& z) { z = inverse.cwiseProduct(r); });
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

    /// Factorises anew. The shift that made the matrix positive definite is `shift()`, 0 where none was needed.
    [[nodiscard]] bool factorise(const SymmetricMatrix<Scalar>& a) {
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

    /// Applies the present factorisation.
    [[nodiscard]] Values<Scalar> apply_factor(const Values<Scalar>& b) const {
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

    [[nodiscard]] Scalar shift() const { return m_shift; }
    [[nodiscard]] int n_factorisations() const { return m_n_factorisations; }

private:
    [[nodiscard]] bool try_factorising(const SymmetricMatrix<Scalar>& a, const SparseMatrix<double>& matrix) {
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

    /// Extends the lower triangle by one more unknown per rank-one term. The pattern depends on that of `a` alone.
    static void extend(const SymmetricMatrix<Scalar>& a, SparseMatrix<double>& matrix) {
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

    /// True where A is positive definite: as many negative pivots as terms of positive weight.
    [[nodiscard]] bool pivots_agree(const SymmetricMatrix<Scalar>& a) const {
        const Values<double> pivots = m_extended_factor.vectorD();
        Index expected = 0;
        for (Index p = 0; p < a.n_terms(); ++p) {
            expected += a.weight(p) < 0 ? 0 : 1;
        }
        return pivots.allFinite() && (pivots.array() < 0).count() == expected;
    }

    SparseCholesky m_factor; ///< of matrices without rank-one terms
    Eigen::SimplicialLDLT<SparseMatrix<double>, Eigen::Lower> m_extended_factor;
    bool m_has_terms = false; ///< the second is in use
    bool m_analysed = false;
    bool m_factorised = false;
    int m_max_cg_iterations = 12;
    int m_max_diagonal_iterations = 0;
    int m_n_factorisations = 0;
    Index m_size = 0;
    Scalar m_shift = 0;
};

} // namespace springfit
