// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/solve/symmetric_matrix.hpp>

namespace springfit {

enum class CgOutcome {
    solved,    ///< to the tolerance
    slow,      ///< the iterations ran out
    indefinite ///< a direction of negative curvature was met; the solution is the iterate before, 0 at the first
};

/// Solves A x = b by preconditioned conjugate gradients from x = 0 until |b - A x| <= tolerance |b|. Whatever the
/// outcome, b . x >= 0: for b = -gradient, x leads downhill.
///
/// `precondition(r, z)` writes z = B r with B symmetric positive definite.
template <std::floating_point Scalar, class Preconditioner>
[[nodiscard]] CgOutcome conjugate_gradients(const SymmetricMatrix<Scalar>& a, const Values<Scalar>& b,
                                            Values<Scalar>& x, Scalar tolerance, int max_iterations,
                                            const Preconditioner& precondition) {
    const Scalar goal = tolerance * b.norm();
    x = Values<Scalar>::Zero(b.size());
    Values<Scalar> residual = b;
    Values<Scalar> z(b.size());
    Values<Scalar> product(b.size());
    precondition(residual, z);
    Values<Scalar> direction = z;
    Scalar rz = residual.dot(z);
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
        if (residual.norm() <= goal) {
            return CgOutcome::solved;
        }
        a.multiply(direction, product);
        const Scalar curvature = direction.dot(product);
        if (!(curvature > 0)) { // not positive definite (or not finite)
            return CgOutcome::indefinite;
        }
        const Scalar alpha = rz / curvature;
        x += alpha * direction;
        residual -= alpha * product;
        precondition(residual, z);
        const Scalar rz_next = residual.dot(z);
        direction = z + (rz_next / rz) * direction;
        rz = rz_next;
    }
    return residual.norm() <= goal ? CgOutcome::solved : CgOutcome::slow;
}

} // namespace springfit
