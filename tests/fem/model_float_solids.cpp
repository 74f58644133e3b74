// SPDX-License-Identifier: BSD-3-Clause
#include "model_checks.hpp"

using namespace springfit;

TEST_CASE_TEMPLATE(
    "an affine map gives the energy of one point and no force inside, in every element, in single precision: solids", B,
    test::Body<3, float, Tet4>) {
    test::check_affine_map<B>();
}

TEST_CASE_TEMPLATE("rigid motions cost nothing, in single precision: solids", B, test::Body<3, float, Tet4>) {
    test::check_rigid_motions<B>();
}

TEST_CASE_TEMPLATE("masses are positive and add up to the body's, in single precision: solids", B,
                   test::Body<3, float, Tet4>) {
    test::check_masses<B>();
}
