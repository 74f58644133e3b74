// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/types.hpp>

namespace springfit {

/// Corners of a simplex `[Dim x Dim + 1]`, m: a triangle in the plane, a tetrahedron in space.
template <int Dim, std::floating_point Scalar>
using SimplexCorners = Eigen::Matrix<Scalar, Dim, Dim + 1>;

/// Volume det(x_1 - x_0, ..., x_Dim - x_0) / Dim!, m^3, in the plane area, m^2; negative where the simplex is inverted.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Scalar signed_volume(const SimplexCorners<Dim, Scalar>& corners) {
    const Vector<Dim, Scalar> a = corners.col(1) - corners.col(0);
    const Vector<Dim, Scalar> b = corners.col(2) - corners.col(0);
    if constexpr (Dim == 2) {
        return (a(0) * b(1) - a(1) * b(0)) / 2;
    } else {
        const Vector<Dim, Scalar> c = corners.col(3) - corners.col(0);
        return a.dot(b.cross(c)) / 6;
    }
}

/// Derivative of the signed volume by each corner `[Dim x Dim + 1]`, m^2, in the plane m.
///
/// A column is the inward normal of the facet opposite to that corner, times the facet's size over Dim; columns add up
/// to 0.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Eigen::Matrix<Scalar, Dim, Dim + 1> volume_gradient(const SimplexCorners<Dim, Scalar>& corners) {
    Eigen::Matrix<Scalar, Dim, Dim + 1> gradient;
    const Vector<Dim, Scalar> a = corners.col(1) - corners.col(0);
    const Vector<Dim, Scalar> b = corners.col(2) - corners.col(0);
    if constexpr (Dim == 2) {
        gradient.col(1) << b(1) / 2, -b(0) / 2;
        gradient.col(2) << -a(1) / 2, a(0) / 2;
        gradient.col(0) = -gradient.col(1) - gradient.col(2);
    } else {
        const Vector<Dim, Scalar> c = corners.col(3) - corners.col(0);
        gradient.col(1) = b.cross(c) / 6;
        gradient.col(2) = c.cross(a) / 6;
        gradient.col(3) = a.cross(b) / 6;
        gradient.col(0) = -gradient.col(1) - gradient.col(2) - gradient.col(3);
    }
    return gradient;
}

namespace detail {

/// The block d^2 V / dx_a dx_b of two different corners of a simplex `[Dim x Dim]`, antisymmetric: in the plane a
/// quarter turn times 1/2, in space the cross product with 1/6 of the opposite edge.
template <int Dim, std::floating_point Scalar>
Eigen::Matrix<Scalar, Dim, Dim> volume_hessian_block(const SimplexCorners<Dim, Scalar>& corners, int a, int b) {
    Eigen::Matrix<Scalar, Dim, Dim> block;
    if constexpr (Dim == 2) {
        const Scalar half = (b - a + 3) % 3 == 1 ? Scalar(0.5) : Scalar(-0.5); // b follows a counter-clockwise, or not
        block << 0, half, -half, 0;
    } else {
        // (c, d) such that (a, b, c, d) is an even permutation of (0, 1, 2, 3).
        constexpr int others[4][4][2] = {{{0, 0}, {2, 3}, {3, 1}, {1, 2}},
                                         {{3, 2}, {0, 0}, {0, 3}, {2, 0}},
                                         {{1, 3}, {3, 0}, {0, 0}, {0, 1}},
                                         {{2, 1}, {0, 2}, {1, 0}, {0, 0}}};
        const Vector<Dim, Scalar> edge = (corners.col(others[a][b][0]) - corners.col(others[a][b][1])) / 6;
        block << 0, -edge(2), edge(1), edge(2), 0, -edge(0), -edge(1), edge(0), 0;
    }
    return block;
}

} // namespace detail

/// Second derivative of the signed volume `[Dim (Dim + 1) x Dim (Dim + 1)]`, corner by corner, m, in the plane without
/// unit; constant in the plane, indefinite, with zero blocks on the diagonal.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Eigen::Matrix<Scalar, Dim*(Dim + 1), Dim*(Dim + 1)>
volume_hessian(const SimplexCorners<Dim, Scalar>& corners) {
    Eigen::Matrix<Scalar, Dim*(Dim + 1), Dim*(Dim + 1)> hessian;
    hessian.setZero();
    for (int b = 0; b <= Dim; ++b) {
        for (int a = 0; a <= Dim; ++a) {
            if (a != b) {
                hessian.template block<Dim, Dim>(Dim * a, Dim * b) =
                    detail::volume_hessian_block<Dim, Scalar>(corners, a, b);
            }
        }
    }
    return hessian;
}

} // namespace springfit
