// SPDX-License-Identifier: BSD-3-Clause
#include "bodies.hpp"
#include "tolerance.hpp"

#include <springfit/fem/loads.hpp>

using namespace springfit;

namespace {

template <int Dim, class Scalar>
Vector<Dim, Scalar> total(const NodalLoad<Dim, Scalar>& load) {
    return load.forces.rowwise().sum();
}

/// Sum of X x f about the origin; in the plane its only component.
template <int Dim, class Scalar>
Scalar moment_z(const Points<Dim, Scalar>& nodes, const NodalLoad<Dim, Scalar>& load) {
    Scalar sum = 0;
    for (std::size_t a = 0; a < load.nodes.size(); ++a) {
        const auto x = nodes.col(load.nodes[a]);
        const auto f = load.forces.col(static_cast<Index>(a));
        sum += x(0) * f(1) - x(1) * f(0);
    }
    return sum;
}

} // namespace

TEST_CASE_TEMPLATE("tractions and pressures add up to force and moment of the rest surface", B,
                   test::Body<2, double, Tri3>, test::Body<2, float, Tri6>, test::Body<2, double, Quad4>,
                   test::Body<3, double, Tet4>, test::Body<3, double, Tet10>, test::Body<3, float, Hex8>) {
    constexpr int dim = B::dimension;
    using Scalar = typename B::Scalar;
    const auto mesh = test::box<dim, Scalar, typename B::Cell>(2);
    const auto lx = static_cast<Scalar>(test::box_size[0]);
    const auto ly = static_cast<Scalar>(test::box_size[1]);
    const Scalar depth = dim == 3 ? static_cast<Scalar>(test::box_size[2]) : Scalar(1);
    auto right = boundary_facets(mesh);
    std::erase_if(right, [&](const auto& facet) {
        return !std::all_of(facet.corners.begin(), facet.corners.end(),
                            [&](int node) { return mesh.nodes(0, node) > lx - Scalar(1e-5); });
    });
    Vector<dim, Scalar> traction = Vector<dim, Scalar>::Constant(2);
    traction(1) = 3;
    const auto load = fem::surface_traction(mesh, right, traction);
    CHECK((total(load) - ly * depth * traction).norm() < test::rounding<Scalar>() * traction.norm());
    const Scalar moment = ly * depth * (lx * traction(1) - ly / 2 * traction(0)); // as acting at the middle
    CHECK(std::abs(moment_z<dim, Scalar>(mesh.nodes, load) - moment) < test::rounding<Scalar>() * traction.norm());

    const auto push = fem::pressure(mesh, right, 4);
    Vector<dim, Scalar> expected = Vector<dim, Scalar>::Zero();
    expected(0) = -4 * ly * depth;
    CHECK((total(push) - expected).norm() < test::rounding<Scalar>() * 4);
    // a closed surface: no net force, virtual work of a uniform swelling = -p dim V
    const auto all_around = fem::pressure(mesh, boundary_facets(mesh), 4);
    CHECK(total(all_around).norm() < test::rounding<Scalar>(300));
    Scalar work = 0;
    for (std::size_t a = 0; a < all_around.nodes.size(); ++a) {
        work += all_around.forces.col(static_cast<Index>(a)).dot(mesh.nodes.col(all_around.nodes[a]));
    }
    const auto volume = static_cast<Scalar>(test::box_volume<typename B::Cell>);
    CHECK(test::relative(work, -4 * dim * volume, volume) < test::rounding<Scalar>(300));
}

TEST_CASE("a quadratic edge takes 1/6, 4/6, 1/6 of its load, a quadratic triangle all on its edges") {
    const auto mesh = quadratic(triangle_grid<double>({1, 1}, {1., 1.}));
    auto bottom = boundary_facets(mesh);
    std::erase_if(bottom, [&](const auto& facet) {
        return mesh.nodes(1, facet.corners[0]) > 0 || mesh.nodes(1, facet.corners[1]) > 0;
    });
    const auto load = fem::surface_traction(mesh, bottom, {0., 6.});
    REQUIRE(load.nodes.size() == 3);
    for (std::size_t a = 0; a < 3; ++a) {
        const double expected = mesh.nodes(0, load.nodes[a]) == 0.5 ? 4. : 1.;
        CHECK(test::relative(load.forces(1, static_cast<Index>(a)), expected, expected) < 1e-13);
    }
    const auto solid = quadratic(tetrahedron_grid<double>({1, 1, 1}, {1., 1., 1.}));
    auto floor = boundary_facets(solid);
    std::erase_if(floor, [&](const auto& facet) {
        return std::any_of(facet.corners.begin(), facet.corners.end(),
                           [&](int node) { return solid.nodes(2, node) > 0; });
    });
    const auto press = fem::pressure(solid, floor, 6.);
    for (std::size_t a = 0; a < press.nodes.size(); ++a) {
        const auto force = press.forces.col(static_cast<Index>(a));
        if (press.nodes[a] < 8) {
            CHECK(force.norm() < 1e-13);
        } else {
            const auto x = solid.nodes.col(press.nodes[a]);
            const bool diagonal = x(0) == 0.5 && x(1) == 0.5; // shared by the two triangles
            CHECK(test::relative(force(2), diagonal ? 2. : 1., 1.) < 1e-13);
        }
    }
}

TEST_CASE("pressure on a membrane acts along its normal, a body force on its volume") {
    const auto mesh = test::box<3, double, Quad4>(3);
    const auto load = fem::pressure(mesh, 5., [](double t) { return 2 * t; });
    const Vector<3, double> expected(0, 0, 5 * test::box_volume<Quad4>);
    CHECK((total(load) - expected).norm() < 1e-13);
    CHECK(load.amplitude(3.) == 6.);
    const fem::Model model{mesh, fem::Corotated{1., 0.3}, 10., {.thickness = 0.25}};
    const auto body =
        fem::body_force(model, [](const Vector<3, double>& x) { return Vector<3, double>(0, 8 * x(0), 0); });
    const double centre = test::box_size[0] / 2;
    CHECK(test::relative(total(body)(1), 8 * centre * 0.25 * test::box_volume<Quad4>, 1.) < 1e-13);
}

TEST_CASE("loads that are not finite are refused") {
    const auto mesh = test::box<2, double, Tri3>(1);
    CHECK_THROWS_AS((void)fem::surface_traction(mesh, boundary_facets(mesh), {std::nan(""), 0.}), InvalidArgument);
    CHECK_THROWS_AS((void)fem::pressure(mesh, boundary_facets(mesh), std::nan("")), InvalidArgument);
}
