// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <random>

#include <springfit/solve/clique_matrix.hpp>
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
    CliqueMatrix<dim, Scalar> sparse(free, cliques);
    DenseMatrix<Scalar> dense = DenseMatrix<Scalar>::Zero(10 * dim, 10 * dim);
    for (std::size_t c = 0; c < cliques.size(); ++c) {
        DenseMatrix<Scalar> block = DenseMatrix<Scalar>::Random(4 * dim, 4 * dim);
        block = (block + block.transpose()).eval();
        sparse.add(static_cast<Index>(c), block);
        for (int b = 0; b < 4; ++b) {
            for (int a = 0; a < 4; ++a) {
                dense.block(dim * cliques[c][static_cast<std::size_t>(a)], dim * cliques[c][static_cast<std::size_t>(b)],
                            dim, dim) += block.block(dim * a, dim * b, dim, dim);
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
