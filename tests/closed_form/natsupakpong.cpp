// SPDX-License-Identifier: BSD-3-Clause
#include "matrices.hpp"
#include "tolerance.hpp"

#include <springfit/closed_form/lloyd.hpp>
#include <springfit/closed_form/natsupakpong.hpp>
#include <springfit/mesh/structured.hpp>

using namespace springfit;

TEST_CASE("equilateral triangles at nu = 1/3 are exact") {
    const auto mesh = equilateral_triangles<double>(2, 2, 0.3);
    auto network = springs_along_edges(mesh);
    const IsotropicSolid solid{.young = 2e5, .poisson = 1. / 3, .thickness = 0.01};
    const auto form = natsupakpong(mesh, network.springs, solid);
    CHECK(form.caveat.empty());
    CHECK(form.n_clamped == 0);
    apply(form, network);
    CHECK(test::relative_difference(test::network_stiffness(network), test::element_stiffness(mesh, solid)) < 1e-12);
    CHECK(test::relative_difference(natsupakpong(quadratic(mesh), network.springs, solid).stiffness, form.stiffness) <
          1e-12);
}

TEST_CASE("a square at nu = 1/3: 17/56 and 23/56; a regular tetrahedron at nu = 1/4: Lloyd's value") {
    const auto square = quad_grid<double>({1, 1}, {0.5, 0.5});
    const auto springs = springs_along_edges(square, {.diagonals = true}).springs;
    const IsotropicSolid plane{.young = 3e4, .poisson = 1. / 3, .thickness = 0.2};
    Values<double> expected(6);
    expected << 17, 17, 17, 17, 23, 23;
    expected *= 3e4 * 0.2 / 56;
    CHECK(test::relative_difference(natsupakpong(square, springs, plane).stiffness, expected) < 1e-12);
    auto cloth = membrane(square);
    cloth.nodes = (Eigen::AngleAxisd(1, Eigen::Vector3d(3, 2, 1).normalized()).toRotationMatrix() * cloth.nodes).eval();
    CHECK(test::relative_difference(natsupakpong(cloth, springs, plane).stiffness, expected) < 1e-12);

    const auto regular = test::regular_tetrahedron(0.3);
    const IsotropicSolid solid{.young = 2e5, .poisson = 0.25};
    const auto form = natsupakpong(regular, edges(regular), solid);
    CHECK(test::relative_difference(form.stiffness, lloyd(regular, edges(regular), solid).stiffness) < 1e-12);
    CHECK(form.caveat == "nearest in the Frobenius norm; misses up to 20 % of a cell's finite element stiffness");
}

TEST_CASE_TEMPLATE("cells of any shape: the finite element's matrix, and the optimum over k >= 0", Cell, Tri3, Quad4,
                   Tet4, Hex8) {
    constexpr int dim = Cell::dimension;
    Mesh<dim, double, Cell> mesh;
    if constexpr (std::same_as<Cell, Tri3>) {
        mesh = triangle_grid<double>({1, 1}, {1., 1.});
    } else if constexpr (std::same_as<Cell, Quad4>) {
        mesh = quad_grid<double>({1, 1}, {1., 2.});
    } else if constexpr (std::same_as<Cell, Tet4>) {
        mesh = test::regular_tetrahedron(1);
    } else {
        mesh = hex_grid<double>({1, 1, 1}, {1., 1.2, 0.8});
    }
    mesh.cells = mesh.cells.leftCols(1).eval();
    mesh.nodes.col(0) -= Vector<dim, double>::LinSpaced(0.1, 0.25);
    mesh = corner_mesh(mesh);
    if (mesh.nodes.cols() > Cell::n_corners) { // the node that the other triangle had to itself
        mesh.nodes = mesh.nodes(Eigen::all, std::vector<int>{0, 1, 3}).eval();
        mesh.cells << 0, 1, 2;
    }
    auto network = springs_along_edges(mesh, {.diagonals = true});
    for (const double nu : {-0.3, 0.2, 0.45}) {
        const IsotropicSolid solid{.young = 10, .poisson = nu, .thickness = 0.7, .plane_strain = dim == 2};
        const auto fem = test::element_stiffness(mesh, solid);
        const auto constants = detail::constants<dim, Cell, double>(solid);
        const auto local = detail::element_stiffness(mesh, 0, constants);
        DenseMatrix<double> own(fem.rows(), fem.cols());
        for (int a = 0; a < Cell::n_corners; ++a) {
            for (int b = 0; b < Cell::n_corners; ++b) {
                own.block<dim, dim>(dim * mesh.cells(a, 0), dim * mesh.cells(b, 0)) =
                    local.template block<dim, dim>(dim * a, dim * b);
            }
        }
        CHECK(test::relative_difference(own, fem) < 1e-12);
        const auto form = natsupakpong(mesh, network.springs, solid);
        CHECK(form.n_clamped == (form.stiffness.array() == 0).count());
        apply(form, network);
        const DenseMatrix<double> missed = fem - test::network_stiffness(network);
        for (Index e = 0; e < network.n_springs(); ++e) {
            const int i = network.springs(0, e);
            const int j = network.springs(1, e);
            Values<double> b = Values<double>::Zero(fem.cols());
            b.segment<dim>(dim * j) = (mesh.nodes.col(j) - mesh.nodes.col(i)).normalized();
            b.segment<dim>(dim * i) = -b.segment<dim>(dim * j);
            const double descent = b.dot(missed * b);
            CHECK((form.stiffness(e) > 0 ? std::abs(descent) : descent) < 1e-11 * fem.norm());
        }
    }
}

TEST_CASE("cells share springs; missing diagonals and inverted cells are refused") {
    auto mesh = hex_grid<double>({2, 2, 1}, {1., 1., 1.});
    jitter(mesh, 0.1, 4);
    const auto springs = springs_along_edges(mesh, {.diagonals = true}).springs;
    const IsotropicSolid solid{.young = 10, .poisson = 0.25};
    const auto all = natsupakpong(mesh, springs, solid);
    Values<double> sum = Values<double>::Zero(springs.cols());
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        auto one = mesh;
        one.cells = mesh.cells.col(c);
        sum += natsupakpong(one, springs, solid).stiffness;
    }
    CHECK(test::relative_difference(all.stiffness, sum) < 1e-12);
    CHECK_THROWS_AS((void)natsupakpong(mesh, edges(mesh), solid), InvalidArgument);
    mesh.cells.col(0).swap(mesh.cells.col(1));
    std::swap(mesh.cells(0, 0), mesh.cells(6, 0));
    CHECK_THROWS_WITH_AS((void)natsupakpong(mesh, springs, solid),
                         "mesh: expected cells of positive volume, found cell 0, inverted or flat", InvalidArgument);
}

TEST_CASE("single precision") {
    auto mesh = tetrahedron_grid<float>({1, 1, 1}, {1.F, 1.F, 1.F});
    const auto form = natsupakpong(mesh, edges(mesh), {.young = 1e6, .poisson = 0.3});
    auto same = Mesh<3, double, Tet4>{mesh.nodes.cast<double>(), mesh.cells};
    const auto exact = natsupakpong(same, edges(same), {.young = 1e6, .poisson = 0.3});
    CHECK(test::relative_difference(form.stiffness.cast<double>().eval(), exact.stiffness) <
          static_cast<double>(test::rounding<float>()));
}
