// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include <Eigen/SVD>

#include <springfit/mesh/simplex.hpp>

/// The rotation R of the polar decomposition A = R S, S symmetric: the rotation that is nearest to A.
namespace springfit::detail {

/// A square matrix by its columns, of numbers or of lanes.
template <int Dim, class Real>
using SquareColumns = std::array<std::array<Real, Dim>, Dim>;

/// Newton's iteration X <- (X + X^-T) / 2 for the rotation of X, until no lane changes by more than `tolerance`.
/// Returns the determinant of the last X but one: 1 where it has come to a rotation, -1 where to a reflection.
template <class Real>
Real iterate_to_rotation(SquareColumns<3, Real>& x, double tolerance, int max_iterations) {
    Real determinant(0);
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
        SquareColumns<3, Real> cofactors; // X^-T times the determinant
        determinant = spanned_volume<3>(x, cofactors);
        Real change(0);
        for (int a = 0; a < 3; ++a) {
            for (int d = 0; d < 3; ++d) {
                const Real next = (x[a][d] + cofactors[a][d] / determinant) / Real(2);
                const Real moved = next - x[a][d];
                change += moved * moved;
                x[a][d] = next;
            }
        }
        if (!any_less(Real(tolerance * tolerance), change)) {
            break;
        }
    }
    return determinant;
}

/// Replaces A by its rotation, to about 1e-8, and by the identity where it is no deformation of positive volume.
template <int Dim, class Real>
void make_rotation(SquareColumns<Dim, Real>& a) {
    Real is_rotation(0); // then 1
    if constexpr (Dim == 2) {
        const Real c = a[0][0] + a[1][1];
        const Real s = a[0][1] - a[1][0];
        const Real size = sqrt(c * c + s * s);
        is_rotation = where_less(Real(0), size, Real(1), Real(0));
        a[0] = {c / size, s / size};
        a[1] = {-s / size, c / size};
    } else {
        const Real squares = dot<3>(a[0], a[0]) + dot<3>(a[1], a[1]) + dot<3>(a[2], a[2]);
        const Real scale = sqrt(Real(3) / squares); // the norm of a rotation
        for (auto& column : a) {
            column = scaled<3>(scale, column);
        }
        const Real away = iterate_to_rotation(a, 1e-4, 20) - Real(1); // the iterate after the last change is at 1e-8
        is_rotation = where_less(away, Real(1e-3), where_less(Real(-1e-3), away, Real(1), Real(0)), Real(0));
    }
    for (int column = 0; column < Dim; ++column) {
        for (int row = 0; row < Dim; ++row) {
            a[column][row] = where_less(Real(0), is_rotation, a[column][row], Real(row == column ? 1 : 0));
        }
    }
}

} // namespace springfit::detail

namespace springfit {

/// The rotation R of the polar decomposition F = R S `[3 x 3]`, det R = 1, to rounding; S is positive definite where
/// det F > 0, else its smallest eigenvalue is negative.
///
/// Newton's iteration where F is well conditioned, else a singular value decomposition.
template <std::floating_point Scalar>
[[nodiscard]] Eigen::Matrix<Scalar, 3, 3> rotation_of(const Eigen::Matrix<Scalar, 3, 3>& f) {
    using Matrix = Eigen::Matrix<Scalar, 3, 3>;
    const Scalar size = f.norm();
    if (f.determinant() > Scalar(1e-3) * size * size * size) {
        detail::SquareColumns<3, Scalar> columns;
        Eigen::Map<Matrix> x(columns.front().data());
        x = f * (std::sqrt(Scalar(3)) / size); // the norm of a rotation
        (void)detail::iterate_to_rotation(columns, 8. * std::numeric_limits<Scalar>::epsilon(), 20);
        return x;
    }
    const Eigen::JacobiSVD<Matrix> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Matrix u = svd.matrixU();
    if (u.determinant() * svd.matrixV().determinant() < 0) {
        u.col(2) = -u.col(2);
    }
    return u * svd.matrixV().transpose();
}

} // namespace springfit
