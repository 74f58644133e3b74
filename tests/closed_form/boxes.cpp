// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/closed_form/baudet.hpp>
#include <springfit/closed_form/cubic_cell.hpp>
#include <springfit/mesh/structured.hpp>

using namespace springfit;

namespace {

/// Energy of springs under a small uniform strain: sum 1/2 k (n' eps n l)^2.
template <int Dim, class Scalar>
Scalar spring_energy(const SpringNetwork<Dim, Scalar>& network, const Eigen::Matrix<Scalar, Dim, Dim>& strain) {
    Scalar energy = 0;
    for (Index e = 0; e < network.n_springs(); ++e) {
        const Vector<Dim, Scalar> r =
            network.rest_positions.col(network.springs(1, e)) - network.rest_positions.col(network.springs(0, e));
        const Scalar stretch = r.dot(strain * r) / r.norm();
        energy += network.stiffness(e) * stretch * stretch / 2;
    }
    return energy;
}

/// lambda/2 tr^2 + mu eps : eps per volume.
template <int Dim, class Scalar>
Scalar elastic_density(const Eigen::Matrix<Scalar, Dim, Dim>& strain, Scalar lambda, Scalar mu) {
    return lambda / 2 * strain.trace() * strain.trace() + mu * strain.squaredNorm();
}

template <int Dim, class Scalar>
Eigen::Matrix<Scalar, Dim, Dim> random_strain() {
    const Eigen::Matrix<Scalar, Dim, Dim> any = Eigen::Matrix<Scalar, Dim, Dim>::Random();
    return any + any.transpose();
}

enum class Bracing { faces, bodies, both };

template <class Scalar>
SpringNetwork<3, Scalar> braced(const Mesh<3, Scalar, Hex8>& mesh, Bracing bracing) {
    const Index per_cell[] = {12, 4, 16};
    const Index from[] = {0, 12, 0};
    std::vector<std::array<int, 2>> pairs;
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        for (const auto& edge : Hex8::edges) {
            pairs.push_back({mesh.cells(edge[0], c), mesh.cells(edge[1], c)});
        }
        for (Index d = 0; d < per_cell[static_cast<int>(bracing)]; ++d) {
            const auto& diagonal = Hex8::diagonals[static_cast<std::size_t>(from[static_cast<int>(bracing)] + d)];
            pairs.push_back({mesh.cells(diagonal[0], c), mesh.cells(diagonal[1], c)});
        }
    }
    return springs_from_list<3, Scalar>(mesh.nodes, detail::sorted_unique_pairs(pairs));
}

} // namespace

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
    CHECK_THROWS_AS((void)cubic_cell(boxes, faces.springs, solid), InvalidArgument);
}
