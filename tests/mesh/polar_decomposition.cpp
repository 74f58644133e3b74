// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/mesh/polar_decomposition.hpp>

using namespace springfit;

namespace {

template <int Dim, class Scalar>
using Matrix = Eigen::Matrix<Scalar, Dim, Dim>;

template <int Dim, class Scalar>
Matrix<Dim, Scalar> some_rotation() {
    if constexpr (Dim == 2) {
        return Eigen::Rotation2D<Scalar>(Scalar(2.5)).toRotationMatrix();
    } else {
        return Eigen::AngleAxis<Scalar>(Scalar(2.5), Vector<3, Scalar>(3, -1, 2).normalized()).toRotationMatrix();
    }
}

/// Symmetric, positive definite.
template <int Dim, class Scalar>
Matrix<Dim, Scalar> some_stretch() {
    const Matrix<Dim, Scalar> a = Matrix<Dim, Scalar>::Random();
    return a * a.transpose() / 2 + Matrix<Dim, Scalar>::Identity();
}

template <int Dim, class Real, class Scalar>
void set(detail::SquareColumns<Dim, Real>& columns, const Matrix<Dim, Scalar>& matrix, int lane) {
    for (std::size_t c = 0; c < Dim; ++c) {
        for (std::size_t r = 0; r < Dim; ++r) {
            if constexpr (std::is_floating_point_v<Real>) {
                columns[c][r] = matrix(static_cast<Index>(r), static_cast<Index>(c));
            } else {
                columns[c][r](lane) = matrix(static_cast<Index>(r), static_cast<Index>(c));
            }
        }
    }
}

template <class Scalar, int Dim, class Real>
Matrix<Dim, Scalar> get(const detail::SquareColumns<Dim, Real>& columns, int lane) {
    Matrix<Dim, Scalar> matrix;
    for (std::size_t c = 0; c < Dim; ++c) {
        for (std::size_t r = 0; r < Dim; ++r) {
            if constexpr (std::is_floating_point_v<Real>) {
                matrix(static_cast<Index>(r), static_cast<Index>(c)) = columns[c][r];
            } else {
                matrix(static_cast<Index>(r), static_cast<Index>(c)) = columns[c][r](lane);
            }
        }
    }
    return matrix;
}

} // namespace

TEST_CASE_TEMPLATE("a rotation comes back from behind a stretch, alone and in lanes beside others", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    using L = detail::Lanes<Scalar, 4>;
    const Matrix<dim, Scalar> r = some_rotation<dim, Scalar>();
    const Matrix<dim, Scalar> a = Scalar(1e3) * r * some_stretch<dim, Scalar>(); // of any size
    Matrix<dim, Scalar> reflected = a;
    reflected.col(0) = -a.col(0);
    const Matrix<dim, Scalar> expected[4] = {r, Matrix<dim, Scalar>::Identity(), r, Matrix<dim, Scalar>::Identity()};
    const Matrix<dim, Scalar> given[4] = {a, Matrix<dim, Scalar>::Zero(), r, reflected};
    detail::SquareColumns<dim, L> lanes;
    for (int lane = 0; lane < 4; ++lane) {
        set<dim>(lanes, given[lane], lane);
    }
    detail::make_rotation<dim, L>(lanes);
    const int n_checked = dim == 3 ? 4 : 3; // in the plane a reflection has a nearest rotation, too
    for (int lane = 0; lane < n_checked; ++lane) {
        CAPTURE(lane);
        CHECK((get<Scalar, dim>(lanes, lane) - expected[lane]).norm() <
              std::max(Scalar(1e-7), 10 * test::rounding<Scalar>()));
        detail::SquareColumns<dim, Scalar> alone;
        set<dim>(alone, given[lane], 0);
        detail::make_rotation<dim, Scalar>(alone);
        CHECK((get<Scalar, dim>(alone, 0) - expected[lane]).norm() <
              std::max(Scalar(1e-7), 10 * test::rounding<Scalar>()));
    }
}

TEST_CASE_TEMPLATE("to rounding: R is a rotation and R'F symmetric, inside out and flat cells included", Scalar, float,
                   double) {
    using M = Matrix<3, Scalar>;
    const M r = some_rotation<3, Scalar>();
    const M stretch = some_stretch<3, Scalar>();
    const M flat = r * Vector<3, Scalar>(1, Scalar(0.5), 0).asDiagonal();
    const M inside_out = r * Vector<3, Scalar>(1, Scalar(0.5), Scalar(-0.2)).asDiagonal();
    for (const M& f : {M(r * stretch), flat, inside_out, M(Scalar(1e-6) * r)}) {
        const M found = rotation_of<Scalar>(f);
        CHECK((found.transpose() * found - M::Identity()).norm() < test::rounding<Scalar>());
        CHECK(found.determinant() > 0);
        const M s = found.transpose() * f;
        CHECK((s - s.transpose()).norm() < test::rounding<Scalar>() * f.norm());
        CHECK((found - r).norm() < test::rounding<Scalar>(1000));
    }
}
