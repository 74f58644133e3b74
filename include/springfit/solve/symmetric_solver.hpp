// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>

#include <Eigen/SparseCholesky>

#include <springfit/solve/conjugate_gradients.hpp>
#include <springfit/solve/sparse_cholesky.hpp>
#include <springfit/solve/symmetric_matrix.hpp>

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
                             Scalar tolerance);

    /// Factorises anew. The shift that made the matrix positive definite is `shift()`, 0 where none was needed.
    [[nodiscard]] bool factorise(const SymmetricMatrix<Scalar>& a);

    /// Applies the present factorisation.
    [[nodiscard]] Values<Scalar> apply_factor(const Values<Scalar>& b) const;

    [[nodiscard]] Scalar shift() const { return m_shift; }
    [[nodiscard]] int n_factorisations() const { return m_n_factorisations; }

private:
    [[nodiscard]] bool try_factorising(const SymmetricMatrix<Scalar>& a, const SparseMatrix<double>& matrix);

    /// Extends the lower triangle by one more unknown per rank-one term. The pattern depends on that of `a` alone.
    static void extend(const SymmetricMatrix<Scalar>& a, SparseMatrix<double>& matrix);

    /// True where A is positive definite: as many negative pivots as terms of positive weight.
    [[nodiscard]] bool pivots_agree(const SymmetricMatrix<Scalar>& a) const;

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

#include <springfit/solve/detail/symmetric_solver_impl.hpp>
