// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <random>

#include <Eigen/Cholesky>

#include <springfit/solve/block_matrix.hpp>
#include <springfit/solve/newton.hpp>

using namespace springfit;

TEST_CASE_TEMPLATE("a clique matrix adds what dense blocks add", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    std::mt19937 random(3);
    std::uniform_int_distribution<int> pick(0, 9);
    Cliques cliques;
    for (int c = 0; c < 12; ++c) {
        std::vector<int> clique;
        while (clique.size() < 4) {
            const int node = pick(random);
            if (std::find(clique.begin(), clique.end(), node) == clique.end()) {
                clique.push_back(node);
            }
        }
        cliques.push_back(clique);
    }
    const FreeNodes free(10, {2, 5});
    BlockMatrix<dim, Scalar> sparse(free, cliques);
    DenseMatrix<Scalar> dense = DenseMatrix<Scalar>::Zero(10 * dim, 10 * dim);
    for (std::size_t c = 0; c < cliques.size(); ++c) {
        DenseMatrix<Scalar> block = DenseMatrix<Scalar>::Random(4 * dim, 4 * dim);
        block = (block + block.transpose()).eval();
        sparse.add(static_cast<Index>(c), block);
        for (int b = 0; b < 4; ++b) {
            for (int a = 0; a < 4; ++a) {
                dense.block(dim * cliques[c][static_cast<std::size_t>(a)],
                            dim * cliques[c][static_cast<std::size_t>(b)], dim, dim) +=
                    block.block(dim * a, dim * b, dim, dim);
            }
        }
    }
    const DenseMatrix<Scalar> lower = sparse.matrix();
    for (Index f = 0; f < free.n_free(); ++f) {
        for (Index g = 0; g <= f; ++g) {
            const int i = free.nodes()[static_cast<std::size_t>(f)];
            const int j = free.nodes()[static_cast<std::size_t>(g)];
            DenseMatrix<Scalar> expected = dense.block(dim * i, dim * j, dim, dim);
            if (f == g) {
                expected = expected.template triangularView<Eigen::Lower>();
            }
            CHECK((lower.block(dim * f, dim * g, dim, dim) - expected).norm() <= test::rounding<Scalar>());
        }
    }
    CHECK(lower.template triangularView<Eigen::StrictlyUpper>().toDenseMatrix().norm() == 0);
    sparse.set_zero();
    CHECK(sparse.matrix().norm() == 0);
}

namespace {

/// Rosenbrock's valley: not convex, minimum 0 at (1, 1); not allowed where x_0 > 3.
template <class S>
struct Rosenbrock {
    using Scalar = S;
    SparseMatrix<S> m_hessian = DenseMatrix<S>::Ones(2, 2).sparseView();
    S energy(const Values<S>& x) const {
        return x(0) > 3 ? std::numeric_limits<S>::infinity()
                        : 100 * std::pow(x(1) - x(0) * x(0), S(2)) + std::pow(1 - x(0), S(2));
    }
    void gradient(const Values<S>& x, Values<S>& g) const {
        g(0) = -400 * x(0) * (x(1) - x(0) * x(0)) - 2 * (1 - x(0));
        g(1) = 200 * (x(1) - x(0) * x(0));
    }
    const SparseMatrix<S>& hessian(const Values<S>& x) {
        m_hessian.coeffRef(0, 0) = 1200 * x(0) * x(0) - 400 * x(1) + 2;
        m_hessian.coeffRef(1, 0) = -400 * x(0);
        m_hessian.coeffRef(1, 1) = 200;
        return m_hessian;
    }
};

} // namespace

TEST_CASE_TEMPLATE("Newton finds the minimum of a valley from an indefinite start", Scalar, float, double) {
    Rosenbrock<Scalar> problem;
    SymmetricSolver<Scalar> solver;
    Values<Scalar> x(2);
    x << Scalar(-1.2), Scalar(6); // Hessian entry 1200 * 1.44 - 2400 + 2 < 0
    const auto report = minimise(problem, x, solver, {.max_iterations = 100, .gradient_tolerance = Scalar(1e-3)});
    CHECK(report.status == Status::converged);
    CHECK((x - Values<Scalar>::Ones(2)).norm() < Scalar(1e-3));
    x << 4, 4;
    CHECK(minimise(problem, x, solver, {}).status == Status::diverged);
}

TEST_CASE("an old factorisation serves as preconditioner until it no longer pays") {
    const Index n = 200;
    SparseMatrix<double> a(n, n);
    for (Index i = 0; i < n; ++i) {
        a.insert(i, i) = 2.1;
        if (i + 1 < n) {
            a.insert(i + 1, i) = -1;
        }
    }
    a.makeCompressed();
    SymmetricSolver<double> solver;
    const Values<double> b = Values<double>::Ones(n);
    Values<double> x;
    CHECK(solver.solve(a, b, x, 1e-10));
    CHECK(solver.n_factorisations() == 1);
    SparseMatrix<double> near = a;
    near.coeffs() *= 1.5;
    CHECK(solver.solve(near, b, x, 1e-10));
    CHECK(solver.n_factorisations() == 1);
    CHECK((near.selfadjointView<Eigen::Lower>() * x - b).norm() <= 1e-9 * b.norm());
    SparseMatrix<double> far = a;
    for (Index i = 0; i < n; ++i) {
        far.coeffRef(i, i) = 2.001 + (i % 7 == 0 ? 1e4 : 0.) + static_cast<double>(i);
    }
    CHECK(solver.solve(far, b, x, 1e-10));
    CHECK(solver.n_factorisations() == 2);
    CHECK((far.selfadjointView<Eigen::Lower>() * x - b).norm() <= 1e-9 * b.norm());
}

TEST_CASE("rank-one terms: product, diagonal, assembled matrix, factorisation and both preconditioners agree") {
    const Index n = 120;
    const Index terms = 30;
    SparseMatrix<double> lower(n, n);
    for (Index i = 0; i < n; ++i) {
        lower.insert(i, i) = 2.2;
        if (i + 1 < n) {
            lower.insert(i + 1, i) = -1;
        }
    }
    lower.makeCompressed();
    SparseMatrix<double> columns(n, terms);
    Values<double> weights(terms);
    for (Index p = 0; p < terms; ++p) {
        for (Index i = 0; i < 6; ++i) {
            columns.insert((7 * p + 5 * i) % n, p) = std::sin(1. + static_cast<double>(p * i));
        }
        weights(p) = p == 3 ? 0. : (p == 7 ? -0.01 : 50. + static_cast<double>(p));
    }
    columns.makeCompressed();
    const SymmetricMatrix<double> matrix(lower, columns, weights);
    const auto full = [](const SparseMatrix<double>& triangle) {
        const SparseMatrix<double> both = triangle.selfadjointView<Eigen::Lower>();
        return DenseMatrix<double>(both);
    };
    const DenseMatrix<double> spread = columns;
    const DenseMatrix<double> dense = full(lower) + spread * weights.asDiagonal() * spread.transpose();
    const Values<double> b = Values<double>::LinSpaced(n, -1, 2);
    const Values<double> exact = dense.ldlt().solve(b);
    Values<double> product;
    matrix.multiply(b, product);
    CHECK((product - dense * b).norm() < 1e-13 * product.norm());
    CHECK((matrix.diagonal() - dense.diagonal()).norm() < 1e-13 * dense.diagonal().norm());
    CHECK((full(matrix.assembled()) - dense).norm() < 1e-13 * dense.norm());

    SymmetricSolver<double> solver;
    Values<double> x;
    CHECK(solver.solve(matrix, b, x, 1e-12));
    CHECK(solver.shift() == 0);
    CHECK((x - exact).norm() < 1e-10 * exact.norm());
    weights *= 1.2;
    CHECK(solver.solve(matrix, b, x, 1e-10)); // the old factorisation preconditions the new matrix
    CHECK(solver.n_factorisations() == 1);
    matrix.multiply(x, product);
    CHECK((product - b).norm() < 2e-10 * b.norm());

    SymmetricSolver<double> diagonal;
    diagonal.set_max_diagonal_iterations(1000);
    CHECK(diagonal.solve(matrix, b, x, 1e-10));
    CHECK(diagonal.n_factorisations() == 0);
    matrix.multiply(x, product);
    CHECK((product - b).norm() < 2e-10 * b.norm());
    diagonal.reset();
    diagonal.set_max_diagonal_iterations(2);
    CHECK(diagonal.solve(matrix, b, x, 1e-10)); // too few: factorised instead
    CHECK(diagonal.n_factorisations() == 1);

    weights(7) = -1000; // not positive definite any more: the pivots tell, the shift makes the direction point downhill
    CHECK(solver.factorise(matrix));
    CHECK(solver.shift() > 0);
    CHECK(solver.apply_factor(b).dot(b) > 0);
}
