// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <springfit/mesh/polar_decomposition.hpp>

namespace springfit::fem::detail {

/// A scalar function of F `[Rows x Cols]` with its first and second derivative; the latter over the entries of F
/// column by column.
template <int Rows, int Cols, std::floating_point Scalar>
struct Invariant {
    using Gradient = Eigen::Matrix<Scalar, Rows, Cols>;
    using Hessian = Eigen::Matrix<Scalar, Rows * Cols, Rows * Cols>;
    Scalar value = 0;
    Gradient gradient;
    Hessian hessian;
};

template <std::floating_point Scalar>
Eigen::Matrix<Scalar, 3, 3> cross_matrix(const Vector<3, Scalar>& v) {
    Eigen::Matrix<Scalar, 3, 3> m;
    m << 0, -v(2), v(1), v(2), 0, -v(0), -v(1), v(0), 0;
    return m;
}

/// J = det F; for a membrane (3 x 2) the ratio of areas |F_1 x F_2|. Derivatives up to `Order`.
template <int Order, int Rows, int Cols, std::floating_point Scalar>
void volume_ratio(const Eigen::Matrix<Scalar, Rows, Cols>& f, Invariant<Rows, Cols, Scalar>& j) {
    if constexpr (Rows == Cols) {
        std::array<Vector<Rows, Scalar>, Rows> columns;
        std::array<Vector<Rows, Scalar>, Rows> cofactors;
        for (int k = 0; k < Rows; ++k) {
            columns[k] = f.col(k);
        }
        j.value = springfit::detail::spanned_volume<Rows>(columns, cofactors);
        if constexpr (Order >= 1) {
            for (int k = 0; k < Rows; ++k) {
                j.gradient.col(k) = cofactors[k];
            }
        }
        if constexpr (Order >= 2 && Rows == 2) {
            j.hessian << 0, 0, 0, 1, 0, 0, -1, 0, 0, -1, 0, 0, 1, 0, 0, 0;
        } else if constexpr (Order >= 2) {
            const auto ax = cross_matrix(columns[0]);
            const auto bx = cross_matrix(columns[1]);
            const auto cx = cross_matrix(columns[2]);
            j.hessian.setZero();
            j.hessian.template block<3, 3>(0, 3) = -cx;
            j.hessian.template block<3, 3>(0, 6) = bx;
            j.hessian.template block<3, 3>(3, 0) = cx;
            j.hessian.template block<3, 3>(3, 6) = -ax;
            j.hessian.template block<3, 3>(6, 0) = -bx;
            j.hessian.template block<3, 3>(6, 3) = ax;
        }
    } else {
        const Vector<3, Scalar> a = f.col(0);
        const Vector<3, Scalar> b = f.col(1);
        const Vector<3, Scalar> area = a.cross(b);
        j.value = area.norm();
        const Vector<3, Scalar> n = area / j.value;
        if constexpr (Order >= 1) {
            j.gradient.col(0) = b.cross(n);
            j.gradient.col(1) = n.cross(a);
        }
        if constexpr (Order >= 2) {
            Eigen::Matrix<Scalar, 3, 6> change; // of the area vector: da x b + a x db
            change.template leftCols<3>() = -cross_matrix(b);
            change.template rightCols<3>() = cross_matrix(a);
            const Eigen::Matrix<Scalar, 1, 6> along = n.transpose() * change;
            j.hessian = (change.transpose() * change - along.transpose() * along) / j.value;
            const auto nx = cross_matrix(n);
            j.hessian.template block<3, 3>(0, 3) -= nx;
            j.hessian.template block<3, 3>(3, 0) += nx;
        }
    }
}

/// tr S of the polar decomposition F = R S; its gradient is R. Derivatives up to `Order`.
///
/// In space d(tr S) = R : dF and dR = R [omega]x with (tr S I - S) omega = axial(R'dF - dF'R), so the second derivative
/// is A' (tr S I - S)^-1 A with A dF = axial(R'dF - dF'R).
template <int Order, int Rows, int Cols, std::floating_point Scalar>
void stretch_trace(const Eigen::Matrix<Scalar, Rows, Cols>& f, Invariant<Rows, Cols, Scalar>& t) {
    if constexpr (Rows == 2) {
        const Scalar p = f(0, 0) + f(1, 1);
        const Scalar q = f(1, 0) - f(0, 1);
        t.value = std::hypot(p, q);
        if constexpr (Order >= 1) {
            t.gradient << p / t.value, -q / t.value, q / t.value, p / t.value;
        }
        if constexpr (Order >= 2) {
            const Vector<4, Scalar> turn(-q / t.value, p / t.value, -p / t.value, -q / t.value);
            t.hessian = turn * turn.transpose() / t.value;
        }
    } else if constexpr (Cols == 3) {
        const Eigen::Matrix<Scalar, 3, 3> r = rotation_of(f);
        t.value = r.cwiseProduct(f).sum();
        if constexpr (Order >= 1) {
            t.gradient = r;
        }
        if constexpr (Order >= 2) {
            const Eigen::Matrix<Scalar, 3, 3> s = r.transpose() * f;
            const Eigen::Matrix<Scalar, 3, 3> m =
                t.value * Eigen::Matrix<Scalar, 3, 3>::Identity() - (s + s.transpose()) / 2;
            Eigen::Matrix<Scalar, 9, 3> a = Eigen::Matrix<Scalar, 9, 3>::Zero();
            for (int k = 0; k < 3; ++k) {
                const int i = (k + 1) % 3;
                const int l = (k + 2) % 3;
                a.template block<3, 1>(3 * i, k) = r.col(l);
                a.template block<3, 1>(3 * l, k) = -r.col(i);
            }
            t.hessian.noalias() = a * m.inverse() * a.transpose();
        }
    } else {
        const Eigen::Matrix<Scalar, 2, 2> c = f.transpose() * f;
        const Vector<3, Scalar> area = Vector<3, Scalar>(f.col(0)).cross(Vector<3, Scalar>(f.col(1)));
        const Scalar j = area.norm();
        t.value = std::sqrt(c.trace() + 2 * j);
        if constexpr (Order >= 1) {
            const Eigen::Matrix<Scalar, 2, 2> s = (c + j * Eigen::Matrix<Scalar, 2, 2>::Identity()) / t.value;
            const Eigen::Matrix<Scalar, 2, 2> s_inverse = s.inverse();
            t.gradient = f * s_inverse;
            if constexpr (Order >= 2) {
                Vector<6, Scalar> turn;
                turn << t.gradient.col(1), -t.gradient.col(0);
                const Vector<3, Scalar> n = area / j;
                const Eigen::Matrix<Scalar, 3, 3> nn = n * n.transpose();
                t.hessian = turn * turn.transpose() / t.value;
                for (int k = 0; k < 2; ++k) {
                    for (int l = 0; l < 2; ++l) {
                        t.hessian.template block<3, 3>(3 * k, 3 * l) += s_inverse(k, l) * nn;
                    }
                }
            }
        }
    }
}

} // namespace springfit::fem::detail
