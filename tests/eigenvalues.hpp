// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/types.hpp>

namespace springfit::test {

/// Eigenvalues of a symmetric matrix, the smallest first. (Compiled once: Eigen's solver is a large part of a test.)
[[nodiscard]] Values<double> eigenvalues(const DenseMatrix<double>& matrix);

} // namespace springfit::test
