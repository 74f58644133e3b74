// SPDX-License-Identifier: BSD-3-Clause
#include "eigenvalues.hpp"

#include <Eigen/Eigenvalues>

namespace springfit::test {

Values<double> eigenvalues(const DenseMatrix<double>& matrix) {
    return Eigen::SelfAdjointEigenSolver<DenseMatrix<double>>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

} // namespace springfit::test
