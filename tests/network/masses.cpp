// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/mesh/structured.hpp>
#include <springfit/network/masses.hpp>

using namespace springfit;

TEST_CASE_TEMPLATE("the total mass is density times volume on every kind of cell", Scalar, float, double) {
    const Scalar density = 7;
    const auto check = [&](const auto& mesh, Scalar thickness, Scalar volume) {
        const Values<Scalar> masses = node_masses(mesh, density, thickness);
        CHECK(masses.minCoeff() > 0);
        CHECK(test::relative(masses.sum(), density * volume, density * volume) < test::rounding<Scalar>());
        CHECK(test::relative(cell_volumes(mesh, thickness).sum(), volume, volume) < test::rounding<Scalar>());
    };
    const Vector<2, Scalar> plane(3, 2);
    const Vector<3, Scalar> box(3, 2, 1);
    const Scalar thin = Scalar(0.25);
    auto triangles = triangle_grid<Scalar>({4, 3}, plane);
    jitter(triangles, Scalar(0.3), 1);
    check(triangles, thin, 6 * thin);
    check(membrane(triangles), thin, 6 * thin);
    check(quadratic(triangles), thin, 6 * thin);
    auto quads = quad_grid<Scalar>({4, 3}, plane);
    jitter(quads, Scalar(0.3), 2);
    check(quads, thin, 6 * thin);
    check(membrane(quads), thin, 6 * thin);
    auto tets = tetrahedron_grid<Scalar>({3, 3, 3}, box);
    jitter(tets, Scalar(0.1), 3);
    check(tets, thin, 6); // no thickness in a solid
    check(quadratic(tets), thin, 6);
    auto hexes = hex_grid<Scalar>({3, 3, 3}, box);
    jitter(hexes, Scalar(0.2), 4);
    check(hexes, thin, 6);
}

TEST_CASE("corners share a cell by the integrals of their shape functions") {
    // A trapezoid with parallel sides 2 and 1 at height 0 and 1: on [-1, 1]^2, det J = (3 - v) / 8. A bottom corner
    // gets the integral of (1 -/+ u)/2 (1 - v)/2 (3 - v)/8: 1 over u times 10/24 over v; a top corner 8/24.
    Mesh<2, double, Quad4> mesh;
    mesh.nodes.resize(2, 4);
    mesh.nodes << 0, 2, 1.5, 0.5, 0, 0, 1, 1;
    mesh.cells.resize(4, 1);
    mesh.cells << 0, 1, 2, 3;
    const Values<double> masses = node_masses(mesh, 1.);
    CHECK(test::relative(masses(0), 10. / 24, 1.) < 1e-15);
    CHECK(test::relative(masses(1), 10. / 24, 1.) < 1e-15);
    CHECK(test::relative(masses(2), 8. / 24, 1.) < 1e-15);
    CHECK(test::relative(masses(3), 8. / 24, 1.) < 1e-15);
}

TEST_CASE("masses turn and scale with the body") {
    auto tets = tetrahedron_grid<double>({2, 2, 2}, {1., 1., 1.});
    jitter(tets, 0.2, 5);
    const Values<double> masses = node_masses(tets, 1000.);
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    auto moved = tets;
    moved.nodes = ((2 * rotation * tets.nodes).colwise() + Eigen::Vector3d(1, 0, -2)).eval();
    CHECK(test::relative_difference(node_masses(moved, 1000.), 8 * masses) < 1e-13);
}

TEST_CASE("inverted and flat cells, and impossible densities, are refused") {
    auto mesh = triangle_grid<double>({1, 1}, {1., 1.});
    CHECK_THROWS_AS((void)node_masses(mesh, 0.), InvalidArgument);
    CHECK_THROWS_AS((void)node_masses(mesh, std::nan("")), InvalidArgument);
    CHECK_THROWS_AS((void)node_masses(mesh, 1., -1.), InvalidArgument);
    std::swap(mesh.cells(0, 1), mesh.cells(1, 1));
    CHECK_THROWS_WITH_AS((void)node_masses(mesh, 1.),
                         "mesh: expected cells of positive volume, found cell 1, inverted or flat", InvalidArgument);
    auto hexes = hex_grid<double>({1, 1, 1}, {1., 1., 1.});
    hexes.nodes.row(2).setZero();
    CHECK_THROWS_AS((void)node_masses(hexes, 1.), InvalidArgument);
}
