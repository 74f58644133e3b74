// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/motion/scenario.hpp>
#include <springfit/network/forces.hpp>
#include <springfit/solve/corotated_solver.hpp>

#include "../body/example.hpp"

using namespace springfit;

namespace {

template <int Dim, class Scalar>
Eigen::Matrix<Scalar, Dim, Dim> rotation() {
    if constexpr (Dim == 2) {
        return Eigen::Rotation2D<Scalar>(Scalar(2)).toRotationMatrix();
    } else {
        return Eigen::AngleAxis<Scalar>(Scalar(2), Vector<3, Scalar>(1, 2, -1).normalized()).toRotationMatrix();
    }
}

/// The stiffness of a network at positions x, made positive definite by a term on the diagonal.
template <int Dim, class Scalar>
SparseMatrix<Scalar> stiffness(const SpringNetwork<Dim, Scalar>& network, const FreeNodes& free,
                               const Points<Dim, Scalar>& x, Scalar diagonal = 0) {
    auto matrix = network_matrix(network, free);
    add_stiffness<Dim, Scalar>(network, x, HessianForm::exact, matrix);
    for (Index f = 0; f < free.n_free(); ++f) {
        matrix.add_diagonal(f, diagonal);
    }
    return matrix.matrix();
}

} // namespace

TEST_CASE_TEMPLATE("the factor of a turned body is that of its stiffness", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network_with_cells<dim, Scalar>(Scalar(0), Scalar(10), Scalar(30), 3);
    const FreeNodes free(network.n_nodes(), {0, 1, 2, 5});
    CorotatedPreconditioner<dim, Scalar> at_rest(stiffness<dim, Scalar>(network, free, network.rest_positions), free,
                                                 network.springs, network.rest_positions);
    REQUIRE(at_rest.is_usable());
    auto turned = at_rest; // shares the factor, not the rotations
    const Points<dim, Scalar> x = rotation<dim, Scalar>() * network.rest_positions;
    turned.turn(x);
    const Values<Scalar> wanted = Values<Scalar>::Random(dim * free.n_free());
    for (const auto& [factor, positions] : {std::pair{&at_rest, network.rest_positions}, std::pair{&turned, x}}) {
        const SparseMatrix<Scalar> matrix = stiffness<dim, Scalar>(network, free, positions);
        const Values<Scalar> right = matrix.template selfadjointView<Eigen::Lower>() * wanted;
        Values<Scalar> found;
        factor->apply(right, found);
        CHECK((found - wanted).norm() < Scalar(2e-4) * wanted.norm()); // kept in single precision
    }
    Values<Scalar> one;
    Values<Scalar> other;
    const Values<Scalar> probe = Values<Scalar>::Random(wanted.size());
    turned.apply(probe, one);
    turned.apply(wanted, other);
    CHECK(test::relative(one.dot(wanted), other.dot(probe), one.norm() * wanted.norm()) < test::rounding<Scalar>(1000));
    CHECK(probe.dot(one) > 0);
}

TEST_CASE_TEMPLATE("a body that nothing holds, and one turned inside out", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto network = test::random_network<dim, double>(0);
    const FreeNodes all(network.n_nodes(), {});
    const auto& rest = network.rest_positions;
    CHECK_FALSE(
        CorotatedPreconditioner<dim, double>(stiffness<dim, double>(network, all, rest), all, network.springs, rest)
            .is_usable());
    CHECK_FALSE((CorotatedPreconditioner<dim, double>{}.is_usable()));
    const FreeNodes none(network.n_nodes(), [&] {
        std::vector<int> nodes(static_cast<std::size_t>(network.n_nodes()));
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            nodes[i] = static_cast<int>(i);
        }
        return nodes;
    }());
    CHECK_FALSE(
        CorotatedPreconditioner<dim, double>(stiffness<dim, double>(network, none, rest), none, network.springs, rest)
            .is_usable());
    const FreeNodes free(network.n_nodes(), {0, 1, 2, 5});
    CorotatedPreconditioner<dim, double> factor(stiffness<dim, double>(network, free, rest), free, network.springs,
                                                rest);
    Points<dim, double> strange = rest;
    strange.row(0) *= dim == 3 ? -1 : 0; // no rotation, or nothing but a line
    factor.turn(strange);
    Values<double> found;
    factor.apply(Values<double>::Random(dim * free.n_free()), found);
    CHECK(found.allFinite());
    factor.turn(Points<dim, double>::Zero(dim, network.n_nodes()));
    factor.apply(Values<double>::Random(dim * free.n_free()), found);
    CHECK(found.allFinite());
}

TEST_CASE_TEMPLATE("the solver of turned bodies", T, test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto network = test::random_network<dim, double>(0);
    const auto& rest = network.rest_positions;
    const FreeNodes free(network.n_nodes(), {0, 1, 2, 5});
    const Points<dim, double> bent = rotation<dim, double>() * (1.2 * rest);
    const SparseMatrix<double> matrix = stiffness<dim, double>(network, free, bent);
    const Values<double> right = Values<double>::Random(dim * free.n_free());
    CorotatedSolver<dim, double> solver;
    Values<double> found;
    const auto residual = [&](const SparseMatrix<double>& a) {
        return (a.template selfadjointView<Eigen::Lower>() * found - right).norm() / right.norm();
    };
    CHECK(solver.solve(matrix, right, found, 1e-8)); // without a factor
    CHECK(residual(matrix) < 1e-8);
    CHECK(solver.fallback().n_factorisations() == 1);
    solver.set_factor({stiffness<dim, double>(network, free, rest), free, network.springs, rest});
    solver.turn(bent);
    CHECK(solver.solve(matrix, right, found, 1e-8));
    CHECK(residual(matrix) < 1e-8);
    CHECK_FALSE(solver.met_negative_curvature());
    CHECK(solver.fallback().n_factorisations() == 1);

    // Squeezed and not positive definite: still downhill.
    const SparseMatrix<double> indefinite = stiffness<dim, double>(network, free, 0.3 * rest);
    solver.turn(rest);
    CHECK(solver.solve(indefinite, right, found, 1e-8));
    CHECK(solver.met_negative_curvature());
    CHECK(right.dot(found) > 0);
    CHECK(solver.solve(matrix, right, found, 1e-8));
    CHECK_FALSE(solver.met_negative_curvature());
}
