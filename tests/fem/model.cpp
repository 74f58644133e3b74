// SPDX-License-Identifier: BSD-3-Clause
#include "model_checks.hpp"

using namespace springfit;

TEST_CASE_TEMPLATE("an affine map gives the energy of one point and no force inside, in every element", B,
                   SPRINGFIT_TEST_BODIES(double)) {
    test::check_affine_map<B>();
}

TEST_CASE_TEMPLATE("rigid motions cost nothing", B, SPRINGFIT_TEST_BODIES(double)) {
    test::check_rigid_motions<B>();
}

TEST_CASE_TEMPLATE("masses are positive and add up to the body's", B, SPRINGFIT_TEST_BODIES(double)) {
    test::check_masses<B>();
}

TEST_CASE("what cannot be a body is refused by name") {
    const auto material = fem::NeoHookean{.young = 1., .poisson = 0.3};
    const auto mesh = test::box<3, double, Tet4>(1);
    const auto message = [](const auto& make) -> std::string {
        try {
            make();
        } catch (const InvalidArgument& error) {
            return error.what();
        }
        return "";
    };
    auto inverted = mesh;
    std::swap(inverted.cells(0, 3), inverted.cells(1, 3));
    const std::string found = message([&] { (void)fem::Model{inverted, material, 1.}; });
    CHECK(found.starts_with("mesh: expected cells of positive volume, found tetrahedron 3 inverted"));
    auto flat = mesh;
    flat.nodes.row(2).setZero();
    CHECK(message([&] { (void)fem::Model{flat, material, 1.}; }).find("tetrahedron 0 degenerate") != std::string::npos);
    auto not_a_number = mesh;
    not_a_number.nodes(1, 2) = std::nan("");
    CHECK(message([&] {
              (void)fem::Model{not_a_number, material, 1.};
          }).starts_with("mesh: expected finite coordinates"));
    CHECK(message([&] { (void)fem::Model{mesh, fem::NeoHookean{1., 0.5}, 1.}; }) ==
          "poisson: expected a value in (-1, 0.5), found 0.5");
    CHECK(message([&] { (void)fem::Model{mesh, material, -1.}; }) == "density: expected a positive density, found -1");
    CHECK(message([&] { (void)fem::Model{mesh, material, 1., {.thickness = 2}}; }).starts_with("thickness"));
    CHECK(message([&] { (void)fem::Model{mesh, material, 1., {.plane = fem::Plane::strain}}; }).starts_with("plane"));
    CHECK(message([&] {
              (void)fem::Model{mesh, material, 1., {.mass_damping = std::nan("")}};
          }).starts_with("mass_damping"));
    const auto sheet = test::box<2, double, Tri3>(1);
    CHECK(message([&] {
              (void)fem::Model{sheet, material, 1., {.dilatation = fem::Dilatation::mean}};
          }).starts_with("dilatation"));
    CHECK(message([&] { (void)fem::Model{sheet, material, 1., {.thickness = 0}}; }).starts_with("thickness"));
    CHECK(message([&] { (void)fem::Model{sheet, material, 1.}; }).empty());
}

TEST_CASE("a cell turned inside out has no finite neo-Hookean energy") {
    const auto mesh = test::box<3, double, Tet4>(1);
    for (const auto& options : test::settings<test::Body<3, double, Tet4>>()) {
        const fem::Model model{mesh, fem::NeoHookean{.young = 1., .poisson = 0.3}, 1., options};
        Points<3, double> x = mesh.nodes;
        x.row(2) *= -1;
        CHECK(!std::isfinite(model.energy(x)));
    }
}
