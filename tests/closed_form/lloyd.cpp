// SPDX-License-Identifier: BSD-3-Clause
#include "matrices.hpp"
#include "tolerance.hpp"

#include <springfit/closed_form/lloyd.hpp>
#include <springfit/mesh/structured.hpp>

using namespace springfit;

TEST_CASE("equilateral triangles at nu = 1/3: the network is the finite element model") {
    const auto mesh = equilateral_triangles<double>(3, 3, 0.3);
    auto network = springs_along_edges(mesh);
    const IsotropicSolid solid{.young = 2e5, .poisson = 1. / 3, .thickness = 0.01};
    const auto form = lloyd(mesh, network.springs, solid);
    CHECK(form.caveat.empty());
    CHECK(form.rest_length.size() == 0);
    apply(form, network);
    CHECK(test::relative_difference(test::network_stiffness(network), test::element_stiffness(mesh, solid)) < 1e-12);
    const auto cloth = lloyd(membrane(mesh), network.springs, solid);
    CHECK(test::relative_difference(cloth.stiffness, form.stiffness) < 1e-14);
    CHECK(test::relative_difference(lloyd(quadratic(mesh), network.springs, solid).stiffness, form.stiffness) < 1e-12);
}

TEST_CASE("squares at nu = 1/3 with their preload: the network is at rest and is the bilinear finite element model") {
    const auto mesh = quad_grid<double>({3, 2}, {0.6, 0.4});
    auto network = springs_along_edges(mesh, {.diagonals = true});
    const IsotropicSolid solid{.young = 2e5, .poisson = 1. / 3, .thickness = 0.01};
    const auto form = lloyd(mesh, network.springs, solid);
    CHECK(form.caveat.empty());
    CHECK(form.n_clamped == 0);
    apply(form, network);
    validate(network);
    Points<2, double> forces = Points<2, double>::Zero(2, network.n_nodes());
    add_elastic_forces<2, double>(network, network.rest_positions, forces);
    CHECK(forces.cwiseAbs().maxCoeff() < 1e-13 * 2e5 * 0.01 * 0.2);
    const auto fem = test::element_stiffness(mesh, solid);
    CHECK(test::relative_difference(test::network_stiffness(network), fem) < 1e-12);

    // Plane strain at nu = 1/4 feels like plane stress at nu = 1/3.
    const IsotropicSolid strain{.young = 2e5, .poisson = 0.25, .thickness = 0.01, .plane_strain = true};
    const auto same = lloyd(mesh, network.springs, strain);
    CHECK(same.caveat.empty());
    apply(same, network);
    CHECK(test::relative_difference(test::network_stiffness(network), test::element_stiffness(mesh, strain)) < 1e-12);
}

TEST_CASE("a regular tetrahedron at nu = 1/4: nearest in the Frobenius norm, a fifth of the matrix away") {
    const auto mesh = test::regular_tetrahedron(0.3);
    auto network = springs_along_edges(mesh);
    const IsotropicSolid solid{.young = 2e5, .poisson = 0.25};
    const auto form = lloyd(mesh, network.springs, solid);
    const double expected = 2 * std::sqrt(2.) / 25 * 0.3 * 2e5;
    CHECK((form.stiffness.array() - expected).abs().maxCoeff() < 1e-12 * expected);
    apply(form, network);
    const auto springs = test::network_stiffness(network);
    const DenseMatrix<double> missed = test::element_stiffness(mesh, solid) - springs;
    CHECK(std::abs(missed.cwiseProduct(springs).sum()) < 1e-12 * springs.squaredNorm());
    CHECK(test::relative(missed.norm() / (missed + springs).norm(), 0.2, 0.2) < 1e-12);
    CHECK(form.caveat == "exact for no tetrahedra; the nearest value for regular ones with Poisson's ratio 1/4");
}

TEST_CASE("what the formulas do not hold for") {
    const auto caveat = [](const auto& mesh, double nu) {
        return lloyd(mesh, springs_along_edges(mesh, {.diagonals = true}).springs, {.young = 1, .poisson = nu}).caveat;
    };
    const std::string triangles = "exact for equilateral triangles with Poisson's ratio 1/3 alone";
    CHECK(caveat(equilateral_triangles<double>(1, 1, 1.), 0.3) == triangles);
    CHECK(caveat(triangle_grid<double>({1, 1}, {1., 1.}), 1. / 3) == triangles);
    CHECK(caveat(quad_grid<double>({1, 1}, {1., 1.}), 0.3) == "exact for Poisson's ratio 1/3 alone");
    CHECK(caveat(quad_grid<float>({1, 1}, {1.F, 1.F}), 1. / 3).empty());

    const IsotropicSolid solid{.young = 1, .poisson = 1. / 3};
    const auto oblong = quad_grid<double>({1, 1}, {2., 1.});
    const auto springs = springs_along_edges(oblong, {.diagonals = true}).springs;
    CHECK_THROWS_WITH_AS((void)lloyd(oblong, springs, solid),
                         "mesh: expected square cells (baudet takes rectangles), found cell 0 with sides 2 1",
                         InvalidArgument);
    const auto square = quad_grid<double>({1, 1}, {1., 1.});
    CHECK_THROWS_AS((void)lloyd(square, edges(square), solid), InvalidArgument);
    auto network = springs_along_edges(square, {.diagonals = true});
    auto form = lloyd(square, network.springs, solid);
    form.stiffness.conservativeResize(3);
    CHECK_THROWS_AS(apply(form, network), InvalidArgument);
}
