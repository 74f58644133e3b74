// SPDX-License-Identifier: BSD-3-Clause
#include "location_checks.hpp"

using namespace springfit;
using test::check_inside;
using test::check_nearest;
using test::relative;
using test::shaken;

TEST_CASE_TEMPLATE("the cell that holds a point is found in every kind of plane cell", Scalar, float, double) {
    const Vector<2, Scalar> square{1, 1};
    check_inside(shaken(triangle_grid<Scalar>({5, 4}, square)));
    check_inside(shaken(quad_grid<Scalar>({5, 4}, square)));
    check_inside(quadratic(shaken(triangle_grid<Scalar>({3, 3}, square))));
}

TEST_CASE_TEMPLATE("the nearest point of an outline is found from inside and outside", Scalar, float, double) {
    check_nearest(triangle_grid<Scalar>({3, 4}, {1, 1}));
    check_nearest(quad_grid<Scalar>({3, 4}, {1, 1}));
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
