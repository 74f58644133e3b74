// SPDX-License-Identifier: BSD-3-Clause
#include <springfit/solve/sparse_cholesky.hpp>

using namespace springfit;

std::size_t size_elsewhere() {
    return sizeof(SparseCholesky);
}

SparseCholesky made_elsewhere() {
    return {};
}

bool solves_elsewhere(SparseCholesky& factor) {
    SparseMatrix<double> lower(2, 2);
    lower.insert(0, 0) = 2;
    lower.insert(1, 0) = 1;
    lower.insert(1, 1) = 2;
    Values<double> x;
    if (!factor.factorise(lower)) {
        return false;
    }
    factor.solve(Values<double>::Constant(2, 3), x);
    return (x.array() - 1).abs().maxCoeff() < 1e-12;
}
