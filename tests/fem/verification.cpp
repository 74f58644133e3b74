// SPDX-License-Identifier: BSD-3-Clause
#include "solids.hpp"
#include "tolerance.hpp"

#include <numbers>

using namespace springfit;
using fem::Dilatation;
using fem::Plane;

namespace {

constexpr double pi = std::numbers::pi;

/// L2 error of the displacement u_i = prod_d sin(pi x_d) of the unit square (plane strain) or cube, held at its
/// boundary, under the body force that belongs to it.
template <class Cell>
double manufactured_error(int n, Dilatation dilatation, double poisson) {
    constexpr int dim = Cell::dimension;
    GridSize<dim> cells;
    cells.fill(n);
    const auto mesh = test::grid<Cell, dim>(cells, Vector<dim, double>::Ones());
    fem::ModelOptions<double> options{.dilatation = dilatation};
    options.plane = dim == 2 ? Plane::strain : Plane::stress;
    const fem::LinearElastic material{.young = 1., .poisson = poisson};
    const fem::Model model{mesh, material, 1., options};
    const double mu = fem::shear_modulus(material);
    const double lambda = fem::lame_lambda(material);
    using Point = Vector<dim, double>;
    const auto exact = [](const Point& x) { return Point(Point::Constant((pi * x.array()).sin().prod())); };
    const auto load = [&](const Point& x) {
        const Point s = (pi * x.array()).sin();
        const Point c = (pi * x.array()).cos();
        Point b;
        for (int i = 0; i < dim; ++i) {
            double gradient_of_divergence = 0;
            for (int d = 0; d < dim; ++d) {
                double term = d == i ? -1. : c(i) * c(d);
                for (int k = 0; k < dim; ++k) {
                    term *= (d == i || (k != i && k != d)) ? s(k) : 1.;
                }
                gradient_of_divergence += pi * pi * term;
            }
            b(i) = -(lambda + mu) * gradient_of_divergence + mu * dim * pi * pi * s.prod();
        }
        return b;
    };
    Scenario<dim, double> scenario;
    scenario.clamps = {
        {test::nodes_where(mesh, [](const Point& x) { return x.minCoeff() < 1e-9 || x.maxCoeff() > 1 - 1e-9; }), {}}};
    scenario.loads = {fem::body_force(model, load)};
    const auto report = fem::equilibrium(model, scenario, 0., {.tolerance = 1e-9});
    REQUIRE(report.status == Status::converged);
    double error = 0;
    model.for_mass_points([&](Index cell, const auto& shape, double volume) {
        Point at = Point::Zero();
        Point u = Point::Zero();
        for (int a = 0; a < Cell::n_nodes; ++a) {
            const int node = mesh.cells(a, cell);
            at += shape(a) * mesh.nodes.col(node);
            u += shape(a) * (report.state.positions.col(node) - mesh.nodes.col(node));
        }
        error += volume * (u - exact(at)).squaredNorm();
    });
    return std::sqrt(error);
}

template <class Cell>
void check_order(int coarse, double expected) {
    for (const auto dilatation : {Dilatation::pointwise, Dilatation::mean}) {
        const double first = manufactured_error<Cell>(coarse, dilatation, 0.3);
        const double second = manufactured_error<Cell>(2 * coarse, dilatation, 0.3);
        const double order = std::log2(first / second);
        CAPTURE(Cell::name);
        CAPTURE(order);
        // the mean over the cell costs quadratic cells up to one order, less in the plane
        const bool quadratic_mean = Cell::n_nodes > Cell::n_corners && dilatation == Dilatation::mean;
        CHECK(order > (quadratic_mean ? 1.35 : expected - 0.35));
        CHECK(order < expected + 0.5);
    }
}

const fem::ModelOptions<double> plain{};
const fem::ModelOptions<double> mean{.dilatation = Dilatation::mean};
const fem::ModelOptions<double> strain{.plane = Plane::strain};
const fem::ModelOptions<double> strain_mean{.plane = Plane::strain, .dilatation = Dilatation::mean};

} // namespace

TEST_CASE("displacements converge with order 2 in linear and 3 in quadratic cells") {
    check_order<Tri3>(8, 2);
    check_order<Quad4>(8, 2);
    check_order<Tri6>(6, 3);
    check_order<Tet4>(6, 2);
    check_order<Hex8>(4, 2);
    check_order<Tet10>(3, 3);
}

TEST_CASE("Cook's membrane in plane stress comes to 23.96") {
    CHECK(test::relative(test::cook_tip<Tri3>(32, 1. / 3, plain), 23.96, 23.96) < 0.012);
    CHECK(test::relative(test::cook_tip<Quad4>(32, 1. / 3, plain), 23.96, 23.96) < 0.01);
    CHECK(test::relative(test::cook_tip<Tri6>(16, 1. / 3, plain), 23.96, 23.96) < 0.002);
}

TEST_CASE("Cook's membrane in plane strain near incompressibility: the mean dilatation does not lock") {
    // 18.74 and 18.52: quadratic triangles with a mean dilatation, 32 cells along each side
    CHECK(test::relative(test::cook_tip<Quad4>(16, 0.49, strain_mean), 18.74, 18.74) < 0.03);
    CHECK(test::relative(test::cook_tip<Quad4>(16, 0.4999, strain_mean), 18.52, 18.52) < 0.03);
    CHECK(test::relative(test::cook_tip<Tri6>(16, 0.4999, strain_mean), 18.52, 18.52) < 0.01);
    CHECK(test::relative(test::cook_tip<Tri3>(16, 0.4999, strain_mean, 0.2), 18.52, 18.52) < 0.08);
    // while the plain ones do
    CHECK(test::cook_tip<Quad4>(16, 0.49, strain) < 0.85 * 18.74);
    CHECK(test::cook_tip<Quad4>(16, 0.4999, strain) < 0.4 * 18.52);
    CHECK(test::cook_tip<Tri3>(16, 0.4999, strain, 0.2) < 0.7 * 18.52);
}

TEST_CASE("a cantilever deflects as Timoshenko says") {
    CHECK(std::abs(test::beam_tip<Tet10>(2, 0., plain, 10) - 1) < 0.005);
    CHECK(std::abs(test::beam_tip<Tet10>(2, 0.3, plain, 16) - 1) < 0.02);
    CHECK(std::abs(test::beam_tip<Tri6>(4, 0., plain, 16) - 1) < 0.005);
    CHECK(std::abs(test::beam_tip<Hex8>(4, 0., plain, 64) - 1) < 0.03);
}

TEST_CASE("a cantilever near incompressibility: the mean dilatation does not lock") {
    for (const double poisson : {0.49, 0.4999}) {
        // nearly as soft as the same mesh is at 0.3
        CHECK(test::beam_tip<Tet4>(4, poisson, mean, 32) > 0.85 * test::beam_tip<Tet4>(4, 0.3, mean, 32));
        CHECK(test::beam_tip<Hex8>(2, poisson, mean, 16) > 0.97 * test::beam_tip<Hex8>(2, 0.3, mean, 16));
        CHECK(std::abs(test::beam_tip<Tet10>(2, poisson, mean, 16) - 1) < 0.02);
        CHECK(test::beam_tip<Tet4>(4, poisson, plain, 32) < 0.4);
    }
    CHECK(test::beam_tip<Tet4>(4, 0.4999, plain, 32) < 0.05);
    CHECK(test::beam_tip<Hex8>(2, 0.4999, plain, 16) < 0.2);
}
