// SPDX-License-Identifier: BSD-3-Clause
#include "matrices.hpp"
#include "tolerance.hpp"

#include <springfit/closed_form/projection.hpp>
#include <springfit/closed_form/van_gelder.hpp>
#include <springfit/mesh/structured.hpp>

using namespace springfit;

namespace {

/// Stiffness matrix of linear triangles or tetrahedra, K_ab = V (lambda g_a g_b' + mu g_b g_a' + mu g_a.g_b I), dense.
template <int Dim, class Cell>
DenseMatrix<double> finite_elements(const Mesh<Dim, double, Cell>& mesh, double lambda, double mu, double thickness) {
    DenseMatrix<double> k = DenseMatrix<double>::Zero(Dim * mesh.n_nodes(), Dim * mesh.n_nodes());
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const auto x = mesh.cell_nodes(c);
        Eigen::Matrix<double, Dim + 1, Dim + 1> affine; // rows (1, x): its inverse holds the gradients
        affine.col(0).setOnes();
        affine.template rightCols<Dim>() = x.transpose();
        const Eigen::Matrix<double, Dim, Dim + 1> g = affine.inverse().template bottomRows<Dim>();
        const double volume = thickness * affine.determinant() / (Dim == 2 ? 2 : 6);
        for (int a = 0; a <= Dim; ++a) {
            for (int b = 0; b <= Dim; ++b) {
                k.block<Dim, Dim>(Dim * mesh.cells(a, c), Dim * mesh.cells(b, c)) +=
                    volume * (lambda * g.col(a) * g.col(b).transpose() + mu * g.col(b) * g.col(a).transpose() +
                              mu * g.col(a).dot(g.col(b)) * Eigen::Matrix<double, Dim, Dim>::Identity());
            }
        }
    }
    return k;
}

/// -n' K_ij n of each spring.
template <int Dim>
Values<double> along_edges(const SpringNetwork<Dim, double>& network, const DenseMatrix<double>& k) {
    Values<double> result(network.n_springs());
    for (Index e = 0; e < network.n_springs(); ++e) {
        const int i = network.springs(0, e);
        const int j = network.springs(1, e);
        const Vector<Dim, double> n = (network.rest_positions.col(j) - network.rest_positions.col(i)).normalized();
        result(e) = -n.dot(k.block<Dim, Dim>(Dim * i, Dim * j) * n);
    }
    return result;
}

constexpr double young = 2e5;
constexpr double h = 0.01;

double plane_lambda(double nu) {
    return young * nu / (1 - nu * nu);
}
double solid_lambda(double nu) {
    return young * nu / ((1 + nu) * (1 - 2 * nu));
}
double shear(double nu) {
    return young / (2 * (1 + nu));
}

} // namespace

TEST_CASE("equilateral triangles at nu = 1/3: sqrt(3)/4 E h a side, and the network is the finite element model") {
    const auto mesh = equilateral_triangles<double>(4, 4, 0.3);
    auto network = springs_along_edges(mesh);
    const IsotropicSolid solid{.young = young, .poisson = 1. / 3, .thickness = h};
    const double one = std::sqrt(3.) / 4 * young * h;
    for (const auto& form : {van_gelder(mesh, network.springs, solid), projection(mesh, network.springs, solid),
                             van_gelder_any_poisson(mesh, network.springs, solid)}) {
        CHECK(form.n_clamped == 0);
        CHECK(form.n_without_cell == 0);
        CHECK(form.caveat.empty());
        Index inner = 0;
        for (Index e = 0; e < network.n_springs(); ++e) {
            const bool shared = form.stiffness(e) > 1.5 * one;
            inner += shared ? 1 : 0;
            CHECK(test::relative(form.stiffness(e), shared ? 2 * one : one, one) < 1e-12);
        }
        CHECK(inner == 3 * mesh.n_cells() - network.n_springs());
        network.stiffness = form.stiffness;
        const auto fem = finite_elements(mesh, plane_lambda(1. / 3), shear(1. / 3), h);
        CHECK(test::relative_difference(test::network_stiffness(network), fem) < 1e-12);
        network.stiffness(5) *= 1.01;
        CHECK(test::relative_difference(test::network_stiffness(network), fem) > 1e-3);
    }
}

TEST_CASE("the projection is the finite element stiffness along each edge, at any nu, on any simplices") {
    auto triangles = triangle_grid<double>({4, 3}, {0.4, 0.3});
    jitter(triangles, 0.25, 3);
    const auto plane = springs_along_edges(triangles);
    auto tets = tetrahedron_grid<double>({2, 2, 2}, {0.4, 0.3, 0.3});
    jitter(tets, 0.15, 3);
    const auto space = springs_along_edges(tets);
    for (const double nu : {-0.3, 0., 0.25, 1. / 3, 0.45}) {
        const auto check = [&](const ClosedForm<double>& form, const Values<double>& expected) {
            CHECK(test::relative_difference(form.stiffness, expected.cwiseMax(0)) < 1e-12);
            // Right angles give exact zeros up to rounding, of either sign.
            const double small = 1e-12 * expected.maxCoeff();
            CHECK(form.n_clamped >= (expected.array() < -small).count());
            CHECK(form.n_clamped <= (expected.array() < small).count());
        };
        IsotropicSolid solid{.young = young, .poisson = nu, .thickness = h};
        check(projection(triangles, plane.springs, solid),
              along_edges(plane, finite_elements(triangles, plane_lambda(nu), shear(nu), h)));
        check(projection(tets, space.springs, solid),
              along_edges(space, finite_elements(tets, solid_lambda(nu), shear(nu), 1)));
        solid.plane_strain = true;
        check(projection(triangles, plane.springs, solid),
              along_edges(plane, finite_elements(triangles, solid_lambda(nu), shear(nu), h)));
    }
}

TEST_CASE_TEMPLATE("Van Gelder's formulas by hand on a right triangle and a corner tetrahedron", Scalar, float,
                   double) {
    Mesh<2, Scalar, Tri3> triangle;
    triangle.nodes.resize(2, 3);
    triangle.nodes << 0, 2, 0, 0, 0, 1;
    triangle.cells.resize(3, 1);
    triangle.cells << 0, 1, 2;
    const IsotropicSolid solid{.young = 10, .poisson = 0.2, .thickness = 0.5};
    const auto network = springs_along_edges(triangle); // edges 0-1, 0-2, 1-2
    const auto close = [](Scalar a, double b) {
        return test::relative(a, Scalar(b), Scalar(b)) < test::rounding<Scalar>();
    };
    const auto simple = van_gelder(triangle, network.springs, solid);
    CHECK(close(simple.stiffness(0), 10 * 0.5 / 4));
    CHECK(close(simple.stiffness(1), 10 * 0.5 / 1));
    CHECK(close(simple.stiffness(2), 10 * 0.5 / 5));
    // Opposite 0-1: angle at 2, tan = 2; opposite 0-2: angle at 1, tan = 1/2; opposite 1-2: a right angle.
    const auto any = van_gelder_any_poisson(triangle, network.springs, solid);
    const double e = 5 / 1.2;
    const double c = 5 * 0.2 / (1 - 0.04) / 2;
    CHECK(close(any.stiffness(0), e / 4 + c / 2));
    CHECK(close(any.stiffness(1), e / 1 + c * 2));
    CHECK(close(any.stiffness(2), e / 5));

    Mesh<3, Scalar, Tet4> tet;
    tet.nodes.resize(3, 4);
    tet.nodes << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2;
    tet.cells.resize(4, 1);
    tet.cells << 0, 1, 2, 3;
    const auto space = springs_along_edges(tet);
    const auto in_space = van_gelder(tet, space.springs, solid); // the thickness does not count
    for (Index s = 0; s < 6; ++s) {
        const Scalar length = space.rest_length(s);
        CHECK(test::relative(in_space.stiffness(s), 10 / (3 * length * length), Scalar(1)) < test::rounding<Scalar>());
    }
}

TEST_CASE("at nu = 1/3 Van Gelder's general form is the projection; plane strain swaps the constants") {
    auto mesh = triangle_grid<double>({5, 4}, {1., 1.});
    jitter(mesh, 0.3, 8);
    const auto springs = edges(mesh);
    const IsotropicSolid third{.young = young, .poisson = 1. / 3, .thickness = h};
    CHECK(test::relative_difference(van_gelder_any_poisson(mesh, springs, third).stiffness,
                                    projection(mesh, springs, third).stiffness) < 1e-12);
    const double nu = 0.2;
    const IsotropicSolid strain{.young = young, .poisson = nu, .thickness = h, .plane_strain = true};
    const IsotropicSolid same{.young = young / (1 - nu * nu), .poisson = nu / (1 - nu), .thickness = h};
    CHECK(test::relative_difference(van_gelder(mesh, springs, strain).stiffness,
                                    van_gelder(mesh, springs, same).stiffness) < 1e-12);
    CHECK(test::relative_difference(van_gelder_any_poisson(mesh, springs, strain).stiffness,
                                    van_gelder_any_poisson(mesh, springs, same).stiffness) < 1e-12);
    CHECK(test::relative_difference(projection(mesh, springs, strain).stiffness,
                                    projection(mesh, springs, same).stiffness) < 1e-12);
}

TEST_CASE("closed forms turn with the body, scale with the units, and know membranes and quadratic meshes") {
    auto mesh = triangle_grid<double>({3, 3}, {1., 1.});
    jitter(mesh, 0.3, 8);
    const auto springs = edges(mesh);
    const IsotropicSolid solid{.young = young, .poisson = 0.4, .thickness = h};
    const auto flat = projection(mesh, springs, solid);
    auto cloth = membrane(mesh);
    cloth.nodes = (Eigen::AngleAxisd(1, Eigen::Vector3d(3, 2, 1).normalized()).toRotationMatrix() * cloth.nodes).eval();
    CHECK(test::relative_difference(projection(cloth, springs, solid).stiffness, flat.stiffness) < 1e-12);
    CHECK(test::relative_difference(projection(quadratic(mesh), springs, solid).stiffness, flat.stiffness) < 1e-12);
    auto large = mesh;
    large.nodes *= 1000; // in the plane k does not depend on size
    CHECK(test::relative_difference(van_gelder(large, springs, solid).stiffness,
                                    van_gelder(mesh, springs, solid).stiffness) < 1e-12);
    const auto tets = tetrahedron_grid<double>({2, 2, 2}, {1., 1., 1.});
    auto scaled = tets;
    scaled.nodes *= 1000;
    CHECK(test::relative_difference(projection(scaled, edges(tets), solid).stiffness,
                                    1000 * projection(tets, edges(tets), solid).stiffness) < 1e-12);
}

TEST_CASE("springs of no cell are counted, edges without a spring and impossible materials refused") {
    const auto mesh = triangle_grid<double>({3, 3}, {1., 1.});
    const auto network = springs_along_edges(mesh, {.second_ring = true});
    const IsotropicSolid solid{.young = 1, .poisson = 0.3};
    const auto form = van_gelder(mesh, network.springs, solid);
    CHECK(form.n_without_cell == second_ring(mesh).cols());
    CHECK(form.caveat == "exact for equilateral triangles with Poisson's ratio 1/3 alone");
    CHECK(form.stiffness.tail(form.n_without_cell).norm() == 0);
    CHECK(form.stiffness.head(network.n_springs() - form.n_without_cell).minCoeff() > 0);
    const NodePairs fewer = network.springs.rightCols(network.n_springs() - 1);
    CHECK_THROWS_WITH_AS((void)van_gelder(mesh, fewer, solid),
                         "springs: expected a spring on every edge of the mesh, found none from 0 to 1",
                         InvalidArgument);
    const auto refused = [&](const IsotropicSolid& material) {
        CHECK_THROWS_AS((void)projection(mesh, network.springs, material), InvalidArgument);
    };
    refused({.young = 0, .poisson = 0.3});
    refused({.young = 1, .poisson = 0.5});
    refused({.young = 1, .poisson = -1});
    refused({.young = std::nan(""), .poisson = 0.3});
    refused({.young = 1, .poisson = 0.3, .thickness = 0});
    CHECK_THROWS_AS(
        (void)projection(membrane(mesh), network.springs, {.young = 1, .poisson = 0.3, .plane_strain = true}),
        InvalidArgument);
    const auto tets = tetrahedron_grid<double>({1, 1, 1}, {1., 1., 1.});
    CHECK(van_gelder(tets, edges(tets), solid).caveat == "exact for no tetrahedra; nearest at Poisson's ratio 1/4");
    CHECK_THROWS_AS((void)projection(tets, edges(tets), {.young = 1, .poisson = 0.3, .plane_strain = true}),
                    InvalidArgument);
}
