// SPDX-License-Identifier: BSD-3-Clause
#include "location_checks.hpp"

using namespace springfit;
using test::check_inside;
using test::check_nearest;
using test::shaken;

TEST_CASE_TEMPLATE("the cell that holds a point is found in every kind of solid cell", Scalar, float, double) {
    const Vector<3, Scalar> cube{1, 1, 1};
    check_inside(shaken(tetrahedron_grid<Scalar>({3, 4, 3}, cube)));
    check_inside(shaken(hex_grid<Scalar>({4, 4, 3}, cube)));
    check_inside(quadratic(shaken(tetrahedron_grid<Scalar>({2, 2, 2}, cube))));
}

TEST_CASE_TEMPLATE("the nearest surface point is found from inside and outside", Scalar, float, double) {
    check_nearest(tetrahedron_grid<Scalar>({3, 2, 2}, {1, 1, 1}));
    check_nearest(hex_grid<Scalar>({3, 2, 2}, {1, 1, 1}));
}
