// SPDX-License-Identifier: BSD-3-Clause
#include "braced.hpp"
#include "tolerance.hpp"

#include <springfit/closed_form/baudet.hpp>
#include <springfit/closed_form/cubic_cell.hpp>

using namespace springfit;
using test::braced;
using test::Bracing;
using test::elastic_density;
using test::random_strain;
using test::spring_energy;

TEST_CASE_TEMPLATE("braced cubes have the energy of the solid in every uniform strain at nu = 1/4, in shear at any nu",
                   Scalar, float, double) {
    const auto cubes = hex_grid<Scalar>({3, 2, 2}, {Scalar(0.6), Scalar(0.4), Scalar(0.4)});
    const auto boxes = hex_grid<Scalar>({2, 2, 2}, {Scalar(0.6), Scalar(0.55), Scalar(0.65)});
    const auto check = [](const Mesh<3, Scalar, Hex8>& mesh, Scalar volume, Bracing bracing) {
        auto network = braced(mesh, bracing);
        const auto quarter = cubic_cell(mesh, network.springs, {.young = 100, .poisson = 0.25});
        CHECK(quarter.n_clamped == 0);
        CHECK(quarter.caveat.empty());
        CHECK(quarter.n_without_cell == 0);
        network.stiffness = quarter.stiffness;
        for (int trial = 0; trial < 5; ++trial) {
            const Eigen::Matrix<Scalar, 3, 3> strain = random_strain<3, Scalar>();
            const Scalar expected = volume * elastic_density<3, Scalar>(strain, 40, 40);
            CHECK(test::relative(spring_energy<3, Scalar>(network, strain), expected, expected) <
                  test::rounding<Scalar>());
        }
        network.stiffness = cubic_cell(mesh, network.springs, {.young = 100, .poisson = 0.4}).stiffness;
        Eigen::Matrix<Scalar, 3, 3> shear = random_strain<3, Scalar>();
        shear.diagonal().setZero();
        const Scalar expected = volume * elastic_density<3, Scalar>(shear, 0, Scalar(100 / 2.8));
        CHECK(test::relative(spring_energy<3, Scalar>(network, shear), expected, expected) < test::rounding<Scalar>());
    };
    const Scalar cubes_volume = Scalar(0.6 * 0.4 * 0.4);
    const Scalar boxes_volume = Scalar(0.6 * 0.55 * 0.65);
    for (const Bracing bracing : {Bracing::faces, Bracing::bodies, Bracing::both}) {
        check(cubes, cubes_volume, bracing);
    }
    check(boxes, boxes_volume, Bracing::faces);
    check(boxes, boxes_volume, Bracing::both);
}

TEST_CASE("one cube has the values in print") {
    const auto cube = hex_grid<double>({1, 1, 1}, {0.5, 0.5, 0.5});
    const double ea = 100 * 0.5;
    const auto value = [&](const SpringNetwork<3, double>& network, double nu, double length) {
        const auto form = cubic_cell(cube, network.springs, {.young = 100, .poisson = nu});
        double found = std::nan("");
        for (Index e = 0; e < network.n_springs(); ++e) {
            if (std::abs(network.rest_length(e) - length) < 1e-12) {
                found = form.stiffness(e);
            }
        }
        return found;
    };
    const auto faces = braced(cube, Bracing::faces);
    CHECK(test::relative(value(faces, 0.25, 0.5), ea / 10, ea) < 1e-14);
    CHECK(test::relative(value(faces, 0.25, 0.5 * std::sqrt(2.)), ea / 5, ea) < 1e-14);
    const auto bodies = braced(cube, Bracing::bodies);
    CHECK(test::relative(value(bodies, 0.3, 0.5), ea / (4 * 1.3), ea) < 1e-14);
    CHECK(test::relative(value(bodies, 0.3, 0.5 * std::sqrt(3.)), 3 * ea / (8 * 1.3), ea) < 1e-14);
}

TEST_CASE_TEMPLATE("Baudet's rectangles are exact at nu = 1/3, and in shear at any nu", Scalar, float, double) {
    const auto mesh = quad_grid<Scalar>({3, 4}, {Scalar(0.9), Scalar(1)}); // cells 0.3 x 0.25
    auto network = springs_along_edges(mesh, {.diagonals = true});
    const double h = 0.01;
    const Scalar volume = Scalar(0.9 * h);
    for (const double nu : {0., 1. / 3, 0.45}) {
        const double young = 1000;
        const auto form = baudet(mesh, network.springs, {.young = young, .poisson = nu, .thickness = h});
        CHECK(form.n_clamped == 0);
        CHECK(form.caveat.empty() == (std::abs(nu - 1. / 3) < 1e-12));
        network.stiffness = form.stiffness;
        const auto mu = Scalar(young / (2 * (1 + nu)));
        const auto lambda = Scalar(young * nu / (1 - nu * nu));
        for (int trial = 0; trial < 5; ++trial) {
            Eigen::Matrix<Scalar, 2, 2> strain = random_strain<2, Scalar>();
            if (std::abs(nu - 1. / 3) > 1e-12) {
                strain.diagonal().setZero();
            }
            const Scalar expected = volume * elastic_density<2, Scalar>(strain, lambda, mu);
            CHECK(test::relative(spring_energy<2, Scalar>(network, strain), expected, expected) <
                  test::rounding<Scalar>());
        }
    }
    // The square at nu = 1/3: 3/8 E h for edges (of one cell) and diagonals.
    const auto square = quad_grid<double>({1, 1}, {1., 1.});
    const auto braced_square = springs_along_edges(square, {.diagonals = true});
    const auto form = baudet(square, braced_square.springs, {.young = 8, .poisson = 1. / 3});
    CHECK((form.stiffness.array() - 3).abs().maxCoeff() < 1e-14);
    const auto cloth = baudet(membrane(square), braced_square.springs, {.young = 8, .poisson = 1. / 3});
    CHECK((cloth.stiffness - form.stiffness).norm() < 1e-14);
}

TEST_CASE("Baudet's cells: the stress of tension is right where the contraction is the material's") {
    const double e = 1e-6;
    const auto rectangles = quad_grid<double>({2, 3}, {0.9, 1.});
    auto sheet = springs_along_edges(rectangles, {.diagonals = true});
    const auto boxes = hex_grid<double>({2, 2, 1}, {0.62, 0.58, 0.3});
    for (const double nu : {0.1, 0.25, 0.45}) {
        const auto stress = [&]<int Dim>(const SpringNetwork<Dim, double>& network, int axis, double volume) {
            // The energy is 1/2 eps'C eps: its slope along the axis, at the material's contraction.
            Eigen::Matrix<double, Dim, Dim> strain = -nu * Eigen::Matrix<double, Dim, Dim>::Identity();
            strain(axis, axis) = 1;
            auto more = strain;
            auto less = strain;
            more(axis, axis) += e;
            less(axis, axis) -= e;
            return (spring_energy<Dim, double>(network, more) - spring_energy<Dim, double>(network, less)) /
                   (2 * e * volume);
        };
        const IsotropicSolid solid{.young = 100, .poisson = nu, .thickness = 0.1};
        apply(baudet(rectangles, sheet.springs, solid), sheet);
        for (int axis = 0; axis < 2; ++axis) {
            CHECK(test::relative(stress(sheet, axis, 0.9 * 0.1), 100., 100.) < 1e-9);
        }
        for (const Bracing bracing : {Bracing::faces, Bracing::both}) {
            auto network = braced(boxes, bracing);
            const auto form = baudet(boxes, network.springs, solid);
            CHECK(form.n_clamped == 0);
            apply(form, network);
            for (int axis = 0; axis < 3; ++axis) {
                CHECK(test::relative(stress(network, axis, 0.62 * 0.58 * 0.3), 100., 100.) < 1e-9);
            }
            Eigen::Matrix3d shear = random_strain<3, double>();
            shear.diagonal().setZero();
            const double expected = 0.62 * 0.58 * 0.3 * elastic_density<3, double>(shear, 0, 100 / (2 * (1 + nu)));
            CHECK(test::relative(spring_energy<3, double>(network, shear), expected, expected) < 1e-12);
        }
    }
    // At nu = 1/4 the exact case is that of cubic_cell.
    const auto springs = braced(boxes, Bracing::both).springs;
    const IsotropicSolid quarter{.young = 100, .poisson = 0.25};
    const auto form = baudet(boxes, springs, quarter);
    CHECK(form.caveat.empty());
    CHECK(test::relative_difference(form.stiffness, cubic_cell(boxes, springs, quarter).stiffness) < 1e-13);
    CHECK(baudet(boxes, springs, {.young = 100, .poisson = 0.3}).caveat ==
          "exact for Poisson's ratio 1/4 alone; in shear for any");
}

TEST_CASE("cells that are no boxes, missing braces and long cells") {
    const IsotropicSolid solid{.young = 1, .poisson = 0.25};
    auto quads = quad_grid<double>({2, 2}, {1., 1.});
    const auto network = springs_along_edges(quads, {.diagonals = true});
    CHECK_THROWS_WITH_AS((void)baudet(quads, edges(quads), solid),
                         "springs: expected a spring on every edge of the mesh, found none from 0 to 4",
                         InvalidArgument);
    quads.nodes(0, 4) += 0.1;
    CHECK_THROWS_AS((void)baudet(quads, network.springs, solid), InvalidArgument);
    const auto long_cells = quad_grid<double>({1, 2}, {8., 1.});
    const auto long_network = springs_along_edges(long_cells, {.diagonals = true});
    CHECK(baudet(long_cells, long_network.springs, solid).n_clamped == 3);

    auto boxes = hex_grid<double>({1, 1, 1}, {1., 1., 2.});
    CHECK_THROWS_WITH_AS((void)cubic_cell(boxes, edges(boxes), solid),
                         "springs: expected face or body diagonals, found neither", InvalidArgument);
    CHECK_THROWS_AS((void)cubic_cell(boxes, braced(boxes, Bracing::bodies).springs, solid), InvalidArgument);
    const auto faces = braced(boxes, Bracing::faces);
    CHECK(cubic_cell(boxes, faces.springs, solid).n_clamped == 4);
    CHECK(cubic_cell(boxes, faces.springs, solid).caveat == "not exact where a negative value was set to 0");
    CHECK(cubic_cell(boxes, faces.springs, {.young = 1, .poisson = 0.3}).caveat ==
          "exact for Poisson's ratio 1/4 alone; in shear for any");
    boxes.nodes(0, 7) += 0.1;
    CHECK_THROWS_WITH_AS(
        (void)cubic_cell(boxes, faces.springs, solid),
        "mesh: expected box-shaped cells (natsupakpong takes any hexahedra), found hexahedron 0 of another shape",
        InvalidArgument);
    CHECK_THROWS_AS((void)baudet(boxes, faces.springs, solid), InvalidArgument);
}
