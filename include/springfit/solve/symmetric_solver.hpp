// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>

#include <Eigen/SparseCholesky>

#include <springfit/core/types.hpp>

namespace springfit {

/// Solves A x = b for a sequence of symmetric matrices of one sparsity pattern (lower triangles).
///
/// The symbolic analysis is done once. A numeric factorisation is kept as the preconditioner of conjugate gradients for
/// the matrices that follow, and is renewed when they take more than `max_cg_iterations`: near each other, as from one
/// Newton or time step to the next, a few cheap iterations replace an expensive factorisation.
///
/// A matrix that is not positive definite is shifted, A + s diag(|A|), until it is: the Newton direction then points
/// downhill.
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

    /// The solution to a relative residual of `tolerance`; false where no factorisation could be had.
    [[nodiscard]] bool solve(const SparseMatrix<Scalar>& lower, const Values<Scalar>& b, Values<Scalar>& x,
                             Scalar tolerance) {
        if (m_factorised && m_max_cg_iterations > 0 && conjugate_gradients(lower, b, x, tolerance)) {
            return true;
        }
        if (!factorise(lower)) {
            return false;
        }
        x = m_factor.solve(b);
        return x.allFinite();
    }

    /// Factorises anew. The shift that made the matrix positive definite is `shift()`, 0 where none was needed.
    [[nodiscard]] bool factorise(const SparseMatrix<Scalar>& lower) {
        if (!m_analysed) {
            m_factor.analyzePattern(lower);
            m_analysed = true;
        }
        m_shift = 0;
        m_factorised = false;
        for (int attempt = 0; attempt < 20; ++attempt) {
            if (attempt == 0) {
                m_factor.factorize(lower);
            } else {
                m_shift = (m_shift > 0) ? 10 * m_shift : std::sqrt(std::numeric_limits<Scalar>::epsilon());
                SparseMatrix<Scalar> shifted = lower;
                for (Index i = 0; i < shifted.cols(); ++i) {
                    Scalar& diagonal = shifted.valuePtr()[shifted.outerIndexPtr()[i]];
                    diagonal += m_shift * std::max(std::abs(diagonal), std::numeric_limits<Scalar>::min());
                }
                m_factor.factorize(shifted);
            }
            if (m_factor.info() == Eigen::Success) {
                m_factorised = true;
                ++m_n_factorisations;
                return true;
            }
        }
        return false;
    }

    /// Applies the present factorisation.
    [[nodiscard]] Values<Scalar> apply_factor(const Values<Scalar>& b) const { return m_factor.solve(b); }

    [[nodiscard]] Scalar shift() const { return m_shift; }
    [[nodiscard]] int n_factorisations() const { return m_n_factorisations; }

private:
    bool conjugate_gradients(const SparseMatrix<Scalar>& lower, const Values<Scalar>& b, Values<Scalar>& x,
                             Scalar tolerance) {
        const auto matrix = lower.template selfadjointView<Eigen::Lower>();
        const Scalar goal = tolerance * b.norm();
        x = Values<Scalar>::Zero(b.size());
        Values<Scalar> residual = b;
        Values<Scalar> z = m_factor.solve(residual);
        Values<Scalar> direction = z;
        Scalar rz = residual.dot(z);
        for (int iteration = 0; iteration < m_max_cg_iterations; ++iteration) {
            if (residual.norm() <= goal) {
                return true;
            }
            const Values<Scalar> product = matrix * direction;
            const Scalar curvature = direction.dot(product);
            if (!(curvature > 0)) {
                return false; // not positive definite (or not finite): leave it to the factorisation
            }
            const Scalar alpha = rz / curvature;
            x += alpha * direction;
            residual -= alpha * product;
            z = m_factor.solve(residual);
            const Scalar rz_next = residual.dot(z);
            direction = z + (rz_next / rz) * direction;
            rz = rz_next;
        }
        return residual.norm() <= goal;
    }

    Eigen::SimplicialLLT<SparseMatrix<Scalar>, Eigen::Lower> m_factor;
    bool m_analysed = false;
    bool m_factorised = false;
    int m_max_cg_iterations = 12;
    int m_n_factorisations = 0;
    Scalar m_shift = 0;
};

} // namespace springfit
