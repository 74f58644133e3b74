// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/small_vectors.hpp>

namespace springfit {

/// Corners of a simplex `[Dim x Dim + 1]`, m: a triangle in the plane, a tetrahedron in space.
template <int Dim, std::floating_point Scalar>
using SimplexCorners = Eigen::Matrix<Scalar, Dim, Dim + 1>;

namespace detail {

/// 1 / Dim!, the part of a simplex in the volume that its sides span.
template <int Dim, std::floating_point Scalar>
inline constexpr Scalar simplex_share = Scalar(1) / (Dim == 2 ? 2 : 6);

/// Returns the volume that `Dim` sides from one corner span, det(s_1, ..., s_Dim), and writes its derivative by each of
/// them, the cofactors of the matrix of the sides. Of a simplex they are Dim! times as much.
///
/// The one place of this formula, for vectors of numbers and of lanes alike.
template <int Dim, class Vec>
auto spanned_volume(const std::array<Vec, Dim>& sides, std::array<Vec, Dim>& gradient) {
    if constexpr (Dim == 2) {
        gradient[0] = clockwise(sides[1]);
        gradient[1] = counter_clockwise(sides[0]);
    } else {
        gradient[0] = cross(sides[1], sides[2]);
        gradient[1] = cross(sides[2], sides[0]);
        gradient[2] = cross(sides[0], sides[1]);
    }
    return dot<Dim>(sides[0], gradient[0]);
}

/// How that derivative changes where the sides change by `moved`: the second derivative times `moved`.
template <int Dim, class Vec>
std::array<Vec, Dim> spanned_gradient_along(const std::array<Vec, Dim>& sides, const std::array<Vec, Dim>& moved) {
    std::array<Vec, Dim> change;
    if constexpr (Dim == 2) {
        (void)spanned_volume<2>(moved, change); // linear
    } else {
        for (int a = 0; a < 3; ++a) {
            const int b = (a + 1) % 3, c = (a + 2) % 3;
            const Vec first = cross(moved[b], sides[c]);
            const Vec second = cross(sides[b], moved[c]);
            for (int d = 0; d < 3; ++d) {
                change[a][d] = first[d] + second[d];
            }
        }
    }
    return change;
}

/// The sides of a simplex from its first corner.
template <int Dim, std::floating_point Scalar>
std::array<Vector<Dim, Scalar>, Dim> sides_of(const SimplexCorners<Dim, Scalar>& corners) {
    std::array<Vector<Dim, Scalar>, Dim> sides;
    for (int a = 0; a < Dim; ++a) {
        sides[a] = corners.col(a + 1) - corners.col(0);
    }
    return sides;
}

} // namespace detail

/// Volume det(x_1 - x_0, ..., x_Dim - x_0) / Dim!, m^3, in the plane area, m^2; negative where the simplex is inverted.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Scalar signed_volume(const SimplexCorners<Dim, Scalar>& corners) {
    std::array<Vector<Dim, Scalar>, Dim> gradient;
    return detail::simplex_share<Dim, Scalar> *
           detail::spanned_volume<Dim>(detail::sides_of<Dim, Scalar>(corners), gradient);
}

/// Derivative of the signed volume by each corner `[Dim x Dim + 1]`, m^2, in the plane m.
///
/// A column is the inward normal of the facet opposite to that corner, times the facet's size over Dim; columns add up
/// to 0.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Eigen::Matrix<Scalar, Dim, Dim + 1> volume_gradient(const SimplexCorners<Dim, Scalar>& corners) {
    std::array<Vector<Dim, Scalar>, Dim> by_side;
    (void)detail::spanned_volume<Dim>(detail::sides_of<Dim, Scalar>(corners), by_side);
    Eigen::Matrix<Scalar, Dim, Dim + 1> gradient;
    gradient.col(0).setZero();
    for (int a = 0; a < Dim; ++a) {
        gradient.col(a + 1) = detail::simplex_share<Dim, Scalar> * by_side[a];
        gradient.col(0) -= gradient.col(a + 1);
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
