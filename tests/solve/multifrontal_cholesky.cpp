// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <random>

#include <Eigen/SparseCholesky>

#include <springfit/solve/multifrontal_cholesky.hpp>

using namespace springfit;

namespace {

/// A positive definite matrix over a grid of n x n x layers points, each coupled with its neighbours and some with
/// others.
SparseMatrix<double> grid_matrix(int n, int layers, unsigned seed, double far) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> value(-1, 1);
    const int size = n * n * layers;
    std::vector<Eigen::Triplet<double>> entries;
    Values<double> sum = Values<double>::Constant(size, 0.1);
    const auto couple = [&](int a, int b) {
        const double v = value(random);
        entries.emplace_back(std::max(a, b), std::min(a, b), v);
        sum(a) += std::abs(v);
        sum(b) += std::abs(v);
    };
    for (int a = 0; a < size; ++a) {
        for (const int step : {1, n, n * n}) {
            if (a + step < size) {
                couple(a, a + step);
            }
        }
        if (value(random) < far) {
            const int b = static_cast<int>(random() % static_cast<unsigned>(size));
            if (a != b) {
                couple(a, b);
            }
        }
    }
    for (int a = 0; a < size; ++a) {
        entries.emplace_back(a, a, sum(a));
    }
    SparseMatrix<double> lower(size, size);
    lower.setFromTriplets(entries.begin(), entries.end());
    return lower;
}

} // namespace

TEST_CASE("solves what a factorisation entry by entry solves, for one pattern after another") {
    MultifrontalCholesky factor;
    for (const int n : {1, 2, 3, 7, 12}) {
        for (const int layers : {1, 4}) {
            for (const double far : {-2., -0.8}) {
                CAPTURE(n);
                CAPTURE(layers);
                CAPTURE(far);
                SparseMatrix<double> lower = grid_matrix(n, layers, 5, far);
                factor.analyse(lower);
                CHECK(factor.size() == lower.cols());
                CHECK(factor.n_entries() >= double(lower.nonZeros()));
                for (int round = 0; round < 2; ++round) {
                    REQUIRE(factor.factorise(lower));
                    const Values<double> b = Values<double>::LinSpaced(lower.cols(), -1, 2);
                    Values<double> x;
                    factor.solve(b, x);
                    const Eigen::SimplicialLLT<SparseMatrix<double>, Eigen::Lower> reference(lower);
                    CHECK(test::relative_difference(x, reference.solve(b).eval()) < 1e-12);
                    lower *= 3; // other values of the same pattern
                }
            }
        }
    }
}

TEST_CASE("no connections at all, and a matrix that is not positive definite") {
    SparseMatrix<double> diagonal(5, 5);
    diagonal.setIdentity();
    diagonal *= 4;
    MultifrontalCholesky factor;
    factor.analyse(diagonal);
    REQUIRE(factor.factorise(diagonal));
    Values<double> x;
    factor.solve(Values<double>::Ones(5), x);
    CHECK((x.array() == 0.25).all());

    SparseMatrix<double> lower = grid_matrix(6, 2, 7, -0.8);
    factor.analyse(lower);
    CHECK(factor.factorise(lower));
    lower.coeffRef(40, 40) = -1;
    CHECK_FALSE(factor.factorise(lower));
    lower.coeffRef(40, 40) = 10;
    REQUIRE(factor.factorise(lower));
    factor.solve(Values<double>::Ones(lower.cols()), x);
    const Values<double> product = lower.selfadjointView<Eigen::Lower>() * x;
    CHECK((product.array() - 1).abs().maxCoeff() < 1e-12);
}
