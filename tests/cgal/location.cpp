// SPDX-License-Identifier: BSD-3-Clause
#include "random_meshes.hpp"
#include "tolerance.hpp"

#include <springfit/cgal/location.hpp>
#include <springfit/mesh/structured.hpp>

using namespace springfit;
using test::random_points;
using test::relative;
using test::rounding;
using test::shaken;

namespace {

/// Points inside are found, in the cell that holds them, with weights that give the point back.
template <int Dim, class Scalar, class Cell>
void check_inside(Mesh<Dim, Scalar, Cell> mesh) {
    const cgal::Locator locator(mesh);
    const auto points = random_points<Dim, Scalar>(200, Scalar(0.001), Scalar(0.999));
    for (Index p = 0; p < points.cols(); ++p) {
        const auto place = locator.cell_at(points.col(p));
        REQUIRE(place.has_value());
        CHECK(relative(place->weights.sum(), Scalar(1), Scalar(1)) < rounding<Scalar>());
        if (Cell::n_nodes == Cell::n_corners) {
            CHECK(place->weights.minCoeff() > -rounding<Scalar>(2000));
        }
        const Vector<Dim, Scalar> back = mesh.cell_nodes(place->cell) * place->weights;
        CHECK((back - points.col(p)).norm() < rounding<Scalar>());
    }
    for (Index i = 0; i < mesh.n_nodes(); i += 7) { // nodes themselves: all weight on the node
        const auto place = locator.cell_at(mesh.nodes.col(i));
        REQUIRE(place.has_value());
        for (int a = 0; a < Cell::n_nodes; ++a) {
            const Scalar expected = mesh.cells(a, place->cell) == i ? 1 : 0;
            CHECK(std::abs(place->weights(a) - expected) < rounding<Scalar>(1000));
        }
    }
    CHECK_FALSE(locator.cell_at(Vector<Dim, Scalar>::Constant(Scalar(1.01))).has_value());
    CHECK_FALSE(locator.cell_at(Vector<Dim, Scalar>::Constant(Scalar(-7))).has_value());
    CHECK_FALSE(locator.cell_at(Vector<Dim, Scalar>::Constant(std::numeric_limits<Scalar>::quiet_NaN())).has_value());
}

/// Nearest points on the unit square or cube.
template <int Dim, class Scalar, class Cell>
void check_nearest(const Mesh<Dim, Scalar, Cell>& mesh) {
    const cgal::Locator locator(mesh);
    const auto points = random_points<Dim, Scalar>(200, Scalar(-1), Scalar(2));
    for (Index p = 0; p < points.cols(); ++p) {
        const Vector<Dim, Scalar> point = points.col(p);
        Vector<Dim, Scalar> expected = point.cwiseMax(Scalar(0)).cwiseMin(Scalar(1));
        Scalar depth = 0; // inside: the nearest side
        if (expected == point) {
            int axis = 0;
            depth = std::min(point.minCoeff(), 1 - point.maxCoeff());
            while (std::min(point(axis), 1 - point(axis)) != depth) {
                ++axis;
            }
            expected(axis) = point(axis) < Scalar(0.5) ? 0 : 1;
        }
        const auto place = locator.nearest(point);
        CHECK((place.point - expected).norm() < rounding<Scalar>());
        CHECK(relative(place.distance, (expected - point).norm(), Scalar(1)) < rounding<Scalar>());
        CHECK(place.weights.minCoeff() >= 0);
        Vector<Dim, Scalar> back = Vector<Dim, Scalar>::Zero();
        for (Index a = 0; a < place.nodes.size(); ++a) {
            back += place.weights(a) * mesh.nodes.col(place.nodes(a));
            CHECK((mesh.cells.col(place.cell).array() == place.nodes(a)).any());
        }
        CHECK((back - expected).norm() < rounding<Scalar>());
        CHECK(place.facet >= 0);
    }
    CHECK_THROWS_AS((void)locator.nearest(Vector<Dim, Scalar>::Constant(std::numeric_limits<Scalar>::quiet_NaN())),
                    InvalidArgument);
}

} // namespace

TEST_CASE_TEMPLATE("the cell that holds a point is found in every kind of cell", Scalar, float, double) {
    const Vector<2, Scalar> square{1, 1};
    const Vector<3, Scalar> cube{1, 1, 1};
    check_inside(shaken(triangle_grid<Scalar>({5, 4}, square)));
    check_inside(shaken(quad_grid<Scalar>({5, 4}, square)));
    check_inside(quadratic(shaken(triangle_grid<Scalar>({3, 3}, square))));
    check_inside(shaken(tetrahedron_grid<Scalar>({3, 4, 3}, cube)));
    check_inside(shaken(hex_grid<Scalar>({4, 4, 3}, cube)));
    check_inside(quadratic(shaken(tetrahedron_grid<Scalar>({2, 2, 2}, cube))));
}

TEST_CASE_TEMPLATE("the nearest surface point is found from inside and outside", Scalar, float, double) {
    check_nearest(triangle_grid<Scalar>({3, 4}, {1, 1}));
    check_nearest(quad_grid<Scalar>({3, 4}, {1, 1}));
    check_nearest(tetrahedron_grid<Scalar>({3, 2, 2}, {1, 1, 1}));
    check_nearest(hex_grid<Scalar>({3, 2, 2}, {1, 1, 1}));
}

TEST_CASE("a membrane holds the points on it and knows the nearest to others") {
    const auto flat = triangle_grid<double>({4, 4}, {1., 1.});
    Mesh<3, double, Tri3> sheet{Points<3, double>(3, flat.n_nodes()), flat.cells};
    sheet.nodes << flat.nodes, flat.nodes.row(0); // the plane z = x
    const cgal::Locator locator(sheet);
    const auto on = locator.cell_at({0.3, 0.6, 0.3});
    REQUIRE(on.has_value());
    CHECK((sheet.cell_nodes(on->cell) * on->weights - Vector<3, double>{0.3, 0.6, 0.3}).norm() < 1e-14);
    CHECK_FALSE(locator.cell_at({0.3, 0.6, 0.31}).has_value());
    const auto near = locator.nearest({0.3, 0.6, 0.5});
    CHECK((near.point - Vector<3, double>{0.4, 0.6, 0.4}).norm() < 1e-14);
    CHECK(relative(near.distance, std::sqrt(0.02), 1.) < 1e-14);
    CHECK(near.facet == -1);
    CHECK(near.nodes.size() == 3);
}
