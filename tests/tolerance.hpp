// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <springfit/core/types.hpp>

namespace springfit::test {

/// |a - b| relative to `scale`, the size of the things compared; never an absolute floor.
template <class Scalar>
[[nodiscard]] Scalar relative(Scalar a, Scalar b, Scalar scale) {
    return std::abs(a - b) / scale;
}

namespace detail {
[[nodiscard]] float relative_difference(const DenseMatrix<float>& a, const DenseMatrix<float>& b);
[[nodiscard]] double relative_difference(const DenseMatrix<double>& a, const DenseMatrix<double>& b);
} // namespace detail

/// Largest entry of a - b relative to the largest entry of b. (Compiled once, not for every two expressions.)
template <class A, class B>
[[nodiscard]] typename A::Scalar relative_difference(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
    using Matrix = DenseMatrix<typename A::Scalar>;
    return detail::relative_difference(Matrix(a), Matrix(b));
}

/// Rounding of a chain of about `operations` steps in this scalar.
template <class Scalar>
[[nodiscard]] constexpr Scalar rounding(double operations = 100) {
    return static_cast<Scalar>(operations) * std::numeric_limits<Scalar>::epsilon();
}

/// A dimension and a scalar, for typed tests: TEST_CASE_TEMPLATE("...", T, SPRINGFIT_TEST_SPACES).
template <int D, class S>
struct Space {
    static constexpr int dimension = D;
    using Scalar = S;
};

} // namespace springfit::test

#define SPRINGFIT_TEST_SPACES                                                                                          \
    springfit::test::Space<2, float>, springfit::test::Space<2, double>, springfit::test::Space<3, float>,             \
        springfit::test::Space<3, double>
