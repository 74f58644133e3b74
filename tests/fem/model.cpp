// SPDX-License-Identifier: BSD-3-Clause
#include "bodies.hpp"
#include "tolerance.hpp"

using namespace springfit;

namespace {

/// An affine map near a rotation; in a membrane's plane and out of it.
template <int Dim, class Scalar>
Eigen::Matrix<Scalar, Dim, Dim> stretch_and_turn() {
    Eigen::Matrix<Scalar, Dim, Dim> f = Eigen::Matrix<Scalar, Dim, Dim>::Identity();
    f(0, 0) = Scalar(1.2);
    f(0, 1) = Scalar(0.15);
    f(1, 1) = Scalar(0.9);
    return test::turn<Dim, Scalar>() * f;
}

} // namespace

TEST_CASE_TEMPLATE("an affine map gives the energy of one point and no force inside, in every element", B,
                   SPRINGFIT_TEST_BODIES(double), SPRINGFIT_TEST_SINGLE_BODIES) {
    constexpr int dim = B::dimension;
    using Scalar = typename B::Scalar;
    const auto mesh = test::box<dim, Scalar, typename B::Cell>(3);
    const auto outer = boundary_nodes(mesh);
    for (const auto& options : test::settings<B>()) {
        const fem::Model model{mesh, fem::NeoHookean{.young = 3., .poisson = 0.3}, 1., options};
        const auto f = stretch_and_turn<dim, Scalar>();
        const Points<dim, Scalar> x = f * mesh.nodes;
        const Points<dim, Scalar> forces = model.internal_forces(x);
        Scalar inside = 0;
        for (Index i = 0; i < mesh.n_nodes(); ++i) {
            const bool is_middle = i >= mesh.cells.topRows(B::Cell::n_corners).maxCoeff() + 1; // on an edge
            if (!is_middle && !std::binary_search(outer.begin(), outer.end(), static_cast<int>(i))) {
                inside = std::max(inside, forces.col(i).norm());
            }
        }
        CHECK(inside < test::rounding<Scalar>(300) * forces.norm());
        // the energy does not depend on the mesh: one cell per axis says the same
        const fem::Model coarse{test::box<dim, Scalar, typename B::Cell>(1),
                                fem::NeoHookean{.young = 3., .poisson = 0.3}, 1., options};
        CHECK(test::relative(model.energy(x), coarse.energy(f * coarse.rest_positions()), model.energy(x)) <
              test::rounding<Scalar>(300));
        CHECK(forces.rowwise().sum().norm() < test::rounding<Scalar>(300) * forces.norm());
    }
}

TEST_CASE_TEMPLATE("rigid motions cost nothing", B, SPRINGFIT_TEST_BODIES(double), SPRINGFIT_TEST_SINGLE_BODIES) {
    constexpr int dim = B::dimension;
    using Scalar = typename B::Scalar;
    const auto mesh = test::box<dim, Scalar, typename B::Cell>(2);
    const auto check = [&](const auto& model, const Points<dim, Scalar>& x) {
        const Points<dim, Scalar> scale = model.internal_forces(Scalar(1.5) * mesh.nodes);
        CHECK(model.internal_forces(x).norm() < test::rounding<Scalar>(300) * scale.norm());
        CHECK(std::abs(model.energy(x)) < test::rounding<Scalar>(300) * scale.norm());
    };
    const Points<dim, Scalar> moved =
        (test::turn<dim, Scalar>() * mesh.nodes).colwise() + Vector<dim, Scalar>::Constant(Scalar(0.7));
    for (const auto& options : test::settings<B>()) {
        check(fem::Model{mesh, fem::NeoHookean{2., 0.4}, 1., options}, moved);
        check(fem::Model{mesh, fem::Corotated{2., 0.4}, 1., options}, moved);
    }
    check(fem::Model{mesh, fem::StVenantKirchhoff{2., 0.4}, 1.}, moved);
    // small strains know translations and infinitesimal rotations only
    Eigen::Matrix<Scalar, dim, dim> spin = Eigen::Matrix<Scalar, dim, dim>::Zero();
    spin(0, dim - 1) = Scalar(0.5);
    spin(dim - 1, 0) = Scalar(-0.5);
    check(fem::Model{mesh, fem::LinearElastic{2., 0.4}, 1.},
          (mesh.nodes + spin * mesh.nodes).colwise() + Vector<dim, Scalar>::Constant(Scalar(0.7)));
}

TEST_CASE_TEMPLATE("masses are positive and add up to the body's", B, SPRINGFIT_TEST_BODIES(double),
                   SPRINGFIT_TEST_SINGLE_BODIES) {
    constexpr int dim = B::dimension;
    using Scalar = typename B::Scalar;
    const auto mesh = test::box<dim, Scalar, typename B::Cell>(3);
    const auto options = test::settings<B>().front();
    const fem::Model model{mesh, fem::LinearElastic{1., 0.3}, 1000., options};
    const auto total = static_cast<Scalar>(1000. * test::box_volume<typename B::Cell> * options.thickness);
    CHECK(model.masses().minCoeff() > 0);
    CHECK(test::relative(model.masses().sum(), total, total) < test::rounding<Scalar>());
    const SparseMatrix<Scalar> mass = model.consistent_mass(FreeNodes(mesh.n_nodes(), {}));
    const SparseMatrix<Scalar> full = mass.template selfadjointView<Eigen::Lower>();
    CHECK(test::relative(full.sum(), dim * total, total) < test::rounding<Scalar>(1000));
    if (B::Cell::n_nodes == B::Cell::n_corners) {
        for (Index i = 0; i < mesh.n_nodes(); ++i) {
            CHECK(test::relative(full.col(dim * i).sum(), model.masses()(i), model.masses()(i)) <
                  test::rounding<Scalar>());
        }
    }
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
