// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

namespace springfit::test::detail {

namespace {

template <class Scalar>
Scalar difference(const DenseMatrix<Scalar>& a, const DenseMatrix<Scalar>& b) {
    return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

} // namespace

float relative_difference(const DenseMatrix<float>& a, const DenseMatrix<float>& b) {
    return difference(a, b);
}

double relative_difference(const DenseMatrix<double>& a, const DenseMatrix<double>& b) {
    return difference(a, b);
}

} // namespace springfit::test::detail
