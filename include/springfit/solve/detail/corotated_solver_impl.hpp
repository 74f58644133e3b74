// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/solve/corotated_solver.hpp>

namespace springfit {

template <int Dim, std::floating_point Scalar>
bool CorotatedSolver<Dim, Scalar>::solve(const SymmetricMatrix<Scalar>& a, const Values<Scalar>& b, Values<Scalar>& x,
                                         Scalar tolerance) {
    m_met_negative_curvature = false;
    if (m_factor.is_usable() && m_n_slow < 2) {
        const auto outcome = conjugate_gradients(
            [&](const Values<Scalar>& p, Values<Scalar>& q) { a.multiply(p, q); },
            [&](const Values<Scalar>& r, Values<Scalar>& z) { m_factor.apply(r, z); }, b, x, tolerance, max_iterations);
        if (outcome == CgOutcome::solved) {
            m_n_slow = 0;
            return true;
        }
        if (outcome == CgOutcome::indefinite) {
            m_met_negative_curvature = true;
            if (!(b.dot(x) > 0)) { // at the first iteration
                m_factor.apply(b, x);
            }
            if (x.allFinite()) {
                return true;
            }
        }
        ++m_n_slow;
    }
    return m_fallback.solve(a, b, x, tolerance);
}

} // namespace springfit
