// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/types.hpp>

namespace springfit {

enum class CgOutcome {
    solved,    ///< to the tolerance
    slow,      ///< the iterations ran out
    indefinite ///< a direction of negative curvature was met; the solution is the iterate before, 0 at the first
};

namespace detail {

[[nodiscard]] inline bool all_positive(double value) {
    return value > 0;
}
[[nodiscard]] inline bool all_positive(const Eigen::ArrayXd& values) {
    return (values > 0).all();
}

/// One iteration of preconditioned conjugate gradients for A x = b, with r = b - A x, z = B r and the direction p:
///
///     alpha = r . z / p . A p ,   x += alpha p ,   r -= alpha A p ,   beta = r . z / (r . z before) ,   p = z + beta p
///     .
///
/// The one place of this recurrence. How vectors lie in memory and which passes over them are joined is up to `System`:
///
///     multiply()      makes A p, returns p . A p
///     move(alpha)     moves x and r
///     is_solved()     true where r is small enough; then the iteration ends
///     precondition()  makes z, returns r . z
///     turn(beta)      makes the next p
///
/// `rz` is r . z before, and afterwards. It is a number, or an array of as many systems that go side by side. False,
/// with nothing moved, where p . A p is not positive: A is not positive definite, or something is not finite.
template <class System, class Number>
[[nodiscard]] bool cg_iteration(System& system, Number& rz) {
    const Number curvature = system.multiply();
    if (!all_positive(curvature)) {
        return false;
    }
    system.move(rz / curvature);
    if (!system.is_solved()) {
        const Number next = system.precondition();
        system.turn(next / rz);
        rz = next;
    }
    return true;
}

/// The system of `conjugate_gradients`.
template <std::floating_point Scalar, class Multiply, class Preconditioner>
struct VectorCg {
    const Multiply& product_of;
    const Preconditioner& preconditioned;
    Values<Scalar>& x;
    Scalar goal;
    Values<Scalar> r, z, p, q;

    double multiply() {
        product_of(p, q);
        return static_cast<double>(p.dot(q));
    }
    void move(double alpha) {
        x += static_cast<Scalar>(alpha) * p;
        r -= static_cast<Scalar>(alpha) * q;
    }
    [[nodiscard]] bool is_solved() const { return r.norm() <= goal; }
    double precondition() {
        preconditioned(r, z);
        return static_cast<double>(r.dot(z));
    }
    void turn(double beta) { p = z + static_cast<Scalar>(beta) * p; }
};

} // namespace detail

/// Solves A x = b by preconditioned conjugate gradients from x = 0 until |b - A x| <= tolerance |b|. Whatever the
/// outcome, b . x >= 0: for b = -gradient, x leads downhill.
///
/// `multiply(p, q)` writes q = A p, `precondition(r, z)` writes z = B r; B is symmetric positive definite.
template <std::floating_point Scalar, class Multiply, class Preconditioner>
[[nodiscard]] CgOutcome conjugate_gradients(const Multiply& multiply, const Preconditioner& precondition,
                                            const Values<Scalar>& b, Values<Scalar>& x,
                                            std::type_identity_t<Scalar> tolerance, int max_iterations) {
    x = Values<Scalar>::Zero(b.size());
    const Values<Scalar> none = x;
    detail::VectorCg<Scalar, Multiply, Preconditioner> system{multiply, precondition, x,    tolerance * b.norm(),
                                                              b,        none,         none, none};
    if (system.is_solved()) {
        return CgOutcome::solved;
    }
    double rz = system.precondition();
    system.turn(0);
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
        if (!detail::cg_iteration(system, rz)) {
            return CgOutcome::indefinite;
        }
        if (system.is_solved()) {
            return CgOutcome::solved;
        }
    }
    return CgOutcome::slow;
}

} // namespace springfit
