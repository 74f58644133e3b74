// SPDX-License-Identifier: BSD-3-Clause
// Two units of one program, of which this one alone knows CHOLMOD, share their factors.
#include <springfit/cholmod/supernodal_factor.hpp>
#include <springfit/solve/sparse_cholesky.hpp>

using namespace springfit;

// without_cholmod.cpp
std::size_t size_elsewhere();
SparseCholesky made_elsewhere();
bool solves_elsewhere(SparseCholesky& factor);

int main() {
    if (size_elsewhere() != sizeof(SparseCholesky)) {
        return 1;
    }
    SparseCholesky of_eigen;
    cholmod::use_supernodal_factors();
    SparseCholesky of_cholmod;
    SparseCholesky theirs = made_elsewhere();
    if (of_eigen.relative_speed() != 1 || of_cholmod.relative_speed() == 1 || theirs.relative_speed() == 1) {
        return 2;
    }
    return solves_elsewhere(of_eigen) && solves_elsewhere(of_cholmod) && solves_elsewhere(theirs) ? 0 : 3;
}
