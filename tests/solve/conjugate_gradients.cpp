// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "tolerance.hpp"

#include <springfit/solve/conjugate_gradients.hpp>

using namespace springfit;

namespace {

/// Symmetric, positive definite where all eigenvalues are.
template <class Scalar>
DenseMatrix<Scalar> matrix_of(const Values<Scalar>& eigenvalues) {
    const Index n = eigenvalues.size();
    DenseMatrix<Scalar> any(n, n);
    for (Index i = 0; i < n; ++i) {
        for (Index j = 0; j < n; ++j) {
            any(i, j) = std::sin(static_cast<Scalar>(1 + 3 * i + i * j));
        }
    }
    const DenseMatrix<Scalar> q = Eigen::HouseholderQR<DenseMatrix<Scalar>>(any).householderQ();
    return q * eigenvalues.asDiagonal() * q.transpose();
}

template <class Scalar>
struct Solved {
    CgOutcome outcome;
    Values<Scalar> x;
    int products = 0;
};

/// With the diagonal as preconditioner, or with none.
template <class Scalar>
Solved<Scalar> solve(const DenseMatrix<Scalar>& a, const Values<Scalar>& b, Scalar tolerance, int iterations,
                     bool diagonal = false) {
    Solved<Scalar> solved;
    solved.outcome = conjugate_gradients(
        [&](const Values<Scalar>& p, Values<Scalar>& q) {
            q = a * p;
            ++solved.products;
        },
        [&](const Values<Scalar>& r, Values<Scalar>& z) {
            z = diagonal ? Values<Scalar>(r.cwiseQuotient(a.diagonal())) : r;
        },
        b, solved.x, tolerance, iterations);
    return solved;
}

} // namespace

TEST_CASE_TEMPLATE("as many iterations as the matrix has eigenvalues", Scalar, float, double) {
    const DenseMatrix<Scalar> a = matrix_of<Scalar>(Values<Scalar>{{1, 1, 1, 2, 2, 5, 5, 5}});
    const Values<Scalar> wanted = Values<Scalar>::LinSpaced(8, -1, 2);
    const Values<Scalar> b = a * wanted;
    for (const bool diagonal : {false, true}) {
        const auto solved = solve<Scalar>(a, b, test::rounding<Scalar>(20), 20, diagonal);
        CHECK(solved.outcome == CgOutcome::solved);
        CHECK(test::relative_difference(solved.x, wanted) < test::rounding<Scalar>(500));
        CHECK((diagonal ? solved.products <= 20 : solved.products == 3));
    }
}

TEST_CASE_TEMPLATE("where iterations run out, the best within the span so far: downhill", Scalar, float, double) {
    const DenseMatrix<Scalar> a = matrix_of<Scalar>(Values<Scalar>::LinSpaced(20, 1, 100));
    const Values<Scalar> b = Values<Scalar>::Ones(20);
    Scalar energy = 0;
    for (const int iterations : {1, 3, 6}) {
        const auto solved = solve<Scalar>(a, b, Scalar(1e-6), iterations);
        CHECK(solved.outcome == CgOutcome::slow);
        CHECK(solved.products == iterations);
        CHECK(b.dot(solved.x) > 0);
        const Scalar now = solved.x.dot(a * solved.x) / 2 - b.dot(solved.x);
        CHECK(now < energy);
        energy = now;
    }
}

TEST_CASE_TEMPLATE("nothing to solve takes nothing, a negative direction ends it", Scalar, float, double) {
    const DenseMatrix<Scalar> a = matrix_of<Scalar>(Values<Scalar>{{-1, -1, -1, 2, 2}});
    const Values<Scalar> none = Values<Scalar>::Zero(5);
    CHECK(solve<Scalar>(a, none, Scalar(0.1), 5).outcome == CgOutcome::solved);
    CHECK(solve<Scalar>(a, none, Scalar(0.1), 5).products == 0);

    const DenseMatrix<Scalar> negative = -DenseMatrix<Scalar>::Identity(5, 5);
    const auto at_once = solve<Scalar>(negative, Values<Scalar>::Ones(5), Scalar(1e-3), 5);
    CHECK(at_once.outcome == CgOutcome::indefinite);
    CHECK(at_once.x.isZero(0));

    Values<Scalar> b = a * Values<Scalar>::LinSpaced(5, 1, 2);
    const auto later = solve<Scalar>(a, b, Scalar(1e-3), 5);
    CHECK(later.outcome == CgOutcome::indefinite);
    CHECK(b.dot(later.x) >= 0);

    b(2) = std::numeric_limits<Scalar>::quiet_NaN();
    CHECK(solve<Scalar>(a, b, Scalar(1e-3), 5).outcome == CgOutcome::indefinite);
}
