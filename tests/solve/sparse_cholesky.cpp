// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <array>
#include <thread>

#include <springfit/cholmod/supernodal_factor.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/network/builders.hpp>
#include <springfit/network/forces.hpp>
#include <springfit/solve/sparse_cholesky.hpp>
#include <springfit/solve/symmetric_solver.hpp>

using namespace springfit;

namespace {

template <int Dimension, MakeSparseFactor Make>
struct Solver {
    static constexpr int dimension = Dimension;
    struct Cholesky : SparseCholesky {
        Cholesky() : SparseCholesky(Make()) {}
    };
};

/// The stiffness of a held grid of springs, made a little stiffer by a diagonal term.
template <int Dim>
SparseMatrix<double> stiffness(int cells) {
    auto mesh = [&] {
        if constexpr (Dim == 2) {
            return triangle_grid<double>({cells, cells}, {1., 1.});
        } else {
            return tetrahedron_grid<double>({cells, cells, cells}, {1., 1., 1.});
        }
    }();
    jitter(mesh, 0.2, 1);
    auto network = springs_along_edges(mesh, {.density = 1000.});
    network.stiffness = network.rest_length * 100;
    const FreeNodes free(network.n_nodes(), {0, 1, 2, cells});
    auto matrix = network_matrix(network, free);
    add_stiffness<Dim, double>(network, network.rest_positions, HessianForm::exact, matrix);
    for (Index f = 0; f < free.n_free(); ++f) {
        matrix.add_diagonal(f, 0.1);
    }
    return matrix.matrix();
}

#define SPRINGFIT_TEST_SOLVERS                                                                                         \
    Solver<2, simplicial_factor<double>>, Solver<3, simplicial_factor<double>>, Solver<2, cholmod::supernodal_factor>, \
        Solver<3, cholmod::supernodal_factor>

} // namespace

TEST_CASE_TEMPLATE("a sparse factor solves for one and for many right-hand sides", T, SPRINGFIT_TEST_SOLVERS) {
    constexpr int dim = T::dimension;
    typename T::Cholesky factor;
    for (const int group : {1, dim}) {
        for (const int cells : {3, 6}) { // the second has another pattern
            const SparseMatrix<double> lower = stiffness<dim>(cells);
            REQUIRE(factor.factorise(lower, 1e-12, group));
            const DenseMatrix<double> wanted = DenseMatrix<double>::Random(lower.cols(), 16);
            const DenseMatrix<double> right = lower.selfadjointView<Eigen::Lower>() * wanted;
            Values<double> one;
            factor.solve(right.col(3), one);
            CHECK((one - wanted.col(3)).norm() < 1e-10 * one.norm());
            typename T::Cholesky::template Rows<16> rows(lower.cols(), 16);
            for (Index u = 0; u < lower.cols(); ++u) {
                rows.row(factor.place()(u)) = right.row(u);
            }
            factor.template substitute<16>(rows);
            for (Index u = 0; u < lower.cols(); ++u) {
                REQUIRE((rows.row(factor.place()(u)) - wanted.row(u)).norm() < 1e-10);
            }
        }
    }
}

TEST_CASE_TEMPLATE("the columns of a sparse factor multiply to the matrix", T, SPRINGFIT_TEST_SOLVERS) {
    constexpr int dim = T::dimension;
    const SparseMatrix<double> lower = stiffness<dim>(4);
    typename T::Cholesky factor;
    REQUIRE(factor.factorise(lower, 0, dim));
    DenseMatrix<double> l = DenseMatrix<double>::Zero(lower.cols(), lower.cols());
    double n_entries = 0;
    double flops = 0;
    int next = 0;
    factor.for_columns([&](int column, const int* rows, const double* values, int size) {
        CHECK(column == next++);
        REQUIRE(rows[0] == column);
        for (int p = 0; p < size; ++p) {
            l(rows[p], column) = values[p];
        }
        n_entries += size;
        flops += static_cast<double>(size) * size;
    });
    CHECK(next == lower.cols());
    CHECK(factor.n_entries() == n_entries);
    CHECK(factor.flops() == flops);
    const DenseMatrix<double> whole = DenseMatrix<double>(lower).selfadjointView<Eigen::Lower>();
    const DenseMatrix<double> product = (l * l.transpose())(factor.place(), factor.place());
    CHECK(test::relative_difference(product, whole) < 1e-13);
    for (std::size_t p = 0; p < factor.order().size(); ++p) { // the unknowns of a node stay together
        for (int d = 0; d < dim; ++d) {
            REQUIRE(factor.place()(dim * factor.order()[p] + d) == dim * static_cast<int>(p) + d);
        }
    }
}

TEST_CASE_TEMPLATE("a matrix that is not clearly positive definite is refused, the next one is not", T,
                   SPRINGFIT_TEST_SOLVERS) {
    constexpr int dim = T::dimension;
    const SparseMatrix<double> lower = stiffness<dim>(4);
    typename T::Cholesky factor;
    SparseMatrix<double> indefinite = lower;
    indefinite.coeffRef(7, 7) = -1;
    CHECK_FALSE(factor.factorise(indefinite));
    REQUIRE(factor.factorise(lower));
    CHECK_FALSE(factor.factorise(lower, 1)); // a pivot of an entry that others are coupled to is below it
    REQUIRE(factor.factorise(lower));
    Values<double> x;
    factor.solve(lower.selfadjointView<Eigen::Lower>() * Values<double>::Ones(lower.cols()), x);
    CHECK((x.array() - 1).abs().maxCoeff() < 1e-10);
}

TEST_CASE_TEMPLATE("factors are found from several threads at once, with the same bits", T, SPRINGFIT_TEST_SOLVERS) {
    constexpr int dim = T::dimension;
    const SparseMatrix<double> lower = stiffness<dim>(6);
    const Values<double> right = Values<double>::Random(lower.cols());
    std::array<Values<double>, 4> found;
    std::vector<std::thread> threads;
    for (auto& x : found) {
        threads.emplace_back([&] {
            typename T::Cholesky factor;
            if (factor.factorise(lower)) {
                factor.solve(right, x);
            }
        });
    }
    for (auto& thread : threads) {
        thread.join();
    }
    REQUIRE(found[0].size() == lower.cols());
    for (const auto& x : found) {
        CHECK(x == found[0]);
    }
}

TEST_CASE("a program chooses its factors while it runs, and those that are there stay what they are") {
    const SparseMatrix<double> lower = stiffness<3>(4);
    const Values<double> right = Values<double>::Random(lower.cols());
    const auto solution = [&](SparseCholesky factor) {
        Values<double> x;
        REQUIRE(factor.factorise(lower));
        factor.solve(right, x);
        return x;
    };
    const Values<double> of_eigen = solution(SparseCholesky(simplicial_factor()));
    const Values<double> of_cholmod = solution(SparseCholesky(cholmod::supernodal_factor()));
    CHECK(of_eigen != of_cholmod); // to the last bit
    SparseCholesky before;
    CHECK(before.relative_speed() == 1);
    cholmod::use_supernodal_factors();
    SparseCholesky after;
    CHECK(after.relative_speed() > 1);
    CHECK(solution(std::move(after)) == of_cholmod);
    SymmetricSolver<double> solver; // compiled in a unit that knows nothing of CHOLMOD
    REQUIRE(solver.factorise(lower));
    CHECK(solver.apply_factor(right) == of_cholmod);
    set_default_sparse_factor(nullptr);
    CHECK(solution({}) == of_eigen);
    CHECK(solution(std::move(before)) == of_eigen);
    CHECK_THROWS_AS(SparseCholesky(nullptr), InvalidArgument);
}

TEST_CASE_TEMPLATE("a sparse factor that was not analysed holds nothing", T, SPRINGFIT_TEST_SOLVERS) {
    const typename T::Cholesky factor;
    CHECK(factor.n_entries() == 0);
    CHECK(factor.flops() == 0);
}
