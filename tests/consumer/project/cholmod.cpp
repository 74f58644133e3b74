// SPDX-License-Identifier: BSD-3-Clause
// Solves with CHOLMOD's factor, as all of the library does once the component is linked.
#include <type_traits>

#include <springfit/solve/sparse_cholesky.hpp>

int main() {
    using namespace springfit;
    static_assert(std::is_same_v<SparseCholesky, BasicSparseCholesky<detail::SupernodalFactor>>);
    SparseMatrix<double> lower(2, 2);
    lower.insert(0, 0) = 2;
    lower.insert(1, 0) = 1;
    lower.insert(1, 1) = 2;
    SparseCholesky factor;
    Values<double> x;
    if (!factor.factorise(lower)) {
        return 1;
    }
    factor.solve(Values<double>::Constant(2, 3), x);
    return (x.array() - 1).abs().maxCoeff() < 1e-12 ? 0 : 1;
}
