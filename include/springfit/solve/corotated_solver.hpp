// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/solve/corotated_preconditioner.hpp>
#include <springfit/solve/symmetric_solver.hpp>

namespace springfit {

/// Solves A x = b for the tangent stiffnesses of one body in the states that a minimisation goes through: conjugate
/// gradients with the turned factor of the body at rest. Where they are slow, as far from the rest shape, or where
/// there is no such factor, the linear systems are left to a `SymmetricSolver`.
template <int Dim, std::floating_point Scalar>
class CorotatedSolver {
public:
    /// For another pattern of matrices; forgets all of the one before.
    void set_factor(CorotatedPreconditioner<Dim, Scalar> factor) {
        m_factor = std::move(factor);
        m_fallback.reset();
        m_n_slow = 0;
    }

    /// What solves where the turned factor does not serve.
    [[nodiscard]] SymmetricSolver<Scalar>& fallback() { return m_fallback; }

    /// Gives the turned factor another chance, for a new minimisation.
    void restart() { m_n_slow = 0; }

    /// The shape that the next matrix is of, positions `[Dim x n_nodes]`.
    void turn(const Points<Dim, Scalar>& x) {
        if (m_factor.is_usable()) {
            m_factor.turn(x);
        }
    }

    /// The solution to a relative residual of `tolerance`. For a matrix that is not positive definite, the iterate
    /// before the negative curvature or, from the fallback, the solution of a shifted one: both go downhill for
    /// b = -gradient. False where none could be had.
    [[nodiscard]] bool solve(const SymmetricMatrix<Scalar>& a, const Values<Scalar>& b, Values<Scalar>& x,
                             Scalar tolerance);

    /// The last matrix was not positive definite along a direction that conjugate gradients took.
    [[nodiscard]] bool met_negative_curvature() const { return m_met_negative_curvature; }

private:
    static constexpr int max_iterations = 150; ///< cost less than a factorisation of a solid

    CorotatedPreconditioner<Dim, Scalar> m_factor;
    SymmetricSolver<Scalar> m_fallback;
    int m_n_slow = 0; ///< solves in a row that the turned factor was too slow for
    bool m_met_negative_curvature = false;
};

} // namespace springfit

#include <springfit/solve/detail/corotated_solver_impl.hpp>
