// SPDX-License-Identifier: BSD-3-Clause
#include "solids.hpp"
#include "tolerance.hpp"

using namespace springfit;
using fem::Dilatation;

TEST_CASE("a membrane pulled at its rim has the stretch of its stress-strain curve") {
    const auto flat = test::grid<Quad4, 2>({6, 3}, {2., 1.});
    const auto mesh = membrane(flat);
    const double young = 3;
    const double thickness = 0.5;
    const fem::Model model{mesh, fem::StVenantKirchhoff{.young = young, .poisson = 0.}, 1., {.thickness = thickness}};
    Scenario<3, double> scenario;
    scenario.clamps = {{test::nodes_where(mesh, [](const auto& x) { return x(0) < 1e-9; }), {}}};
    const double stretch = 1.3;
    const double first_piola = young * stretch * (stretch * stretch - 1) / 2;
    scenario.loads = {fem::surface_traction(mesh,
                                            test::facets_where(mesh, [](const auto& x) { return x(0) > 2 - 1e-9; }),
                                            {first_piola * thickness, 0., 0.})};
    const auto report = fem::equilibrium(model, scenario, 0., {.tolerance = 1e-11});
    CHECK(report.status == Status::converged);
    Points<3, double> expected = mesh.nodes;
    expected.row(0) *= stretch;
    CHECK((report.state.positions - expected).cwiseAbs().maxCoeff() < 1e-8);
}

TEST_CASE("clamps that move far, and a warm start") {
    const auto mesh = test::grid<Tet4, 3>({6, 2, 2}, {3., 1., 1.});
    const fem::Model model{mesh, fem::NeoHookean{.young = 1., .poisson = 0.45}, 1., {.dilatation = Dilatation::mean}};
    const auto at_left = test::nodes_where(mesh, [](const auto& x) { return x(0) < 1e-9; });
    const auto at_right = test::nodes_where(mesh, [](const auto& x) { return x(0) > 3 - 1e-9; });
    const auto pushed = [&](double stretch) {
        Scenario<3, double> scenario;
        scenario.clamps = {{at_left, {}},
                           {at_right, [stretch](const Vector<3, double>& rest, double time) {
                                const double angle = 1.5 * time;
                                const double c = std::cos(angle);
                                const double s = std::sin(angle);
                                return Vector<3, double>(rest(0) + 3 * (stretch - 1) * time,
                                                         0.5 + c * (rest(1) - 0.5) - s * (rest(2) - 0.5),
                                                         0.5 + s * (rest(1) - 0.5) + c * (rest(2) - 0.5));
                            }}};
        return scenario;
    };
    const auto twisted = fem::equilibrium(model, pushed(1.4), 1.);
    CHECK(twisted.status == Status::converged);
    CHECK(twisted.load == 1);
    CHECK(std::isfinite(model.energy(twisted.state.positions)));
    const Points<3, double> forces = model.internal_forces(twisted.state.positions);
    double free_force = 0;
    double reaction = 0;
    for (Index i = 0; i < mesh.n_nodes(); ++i) {
        const bool held = mesh.nodes(0, i) < 1e-9 || mesh.nodes(0, i) > 3 - 1e-9;
        (held ? reaction : free_force) = std::max(held ? reaction : free_force, forces.col(i).norm());
    }
    CHECK(free_force < 1e-5 * reaction);

    const auto again = fem::equilibrium(model, pushed(1.4), 1., {}, twisted.state.positions);
    CHECK(again.status == Status::converged);
    CHECK(again.iterations < twisted.iterations);
    CHECK((again.state.positions - twisted.state.positions).cwiseAbs().maxCoeff() < 1e-5);
}

TEST_CASE("what no body can do ends with a status and the last state in balance") {
    const auto mesh = test::grid<Tet4, 3>({1, 1, 1}, {1., 1., 1.});
    const fem::Model model{mesh, fem::NeoHookean{.young = 1., .poisson = 0.45}, 1.};
    Scenario<3, double> scenario; // every node held: the cube is pushed through itself
    scenario.clamps = {{{0, 1, 2, 3, 4, 5, 6, 7}, [](const Vector<3, double>& rest, double) {
                            return Vector<3, double>(rest(0), rest(1), -0.5 * rest(2));
                        }}};
    const auto report = fem::equilibrium(model, scenario, 0., {.max_halvings = 3});
    CHECK(report.status == Status::diverged);
    CHECK(report.load >= 0.5);
    CHECK(report.load < 1);
    CHECK(std::isfinite(model.energy(report.state.positions)));
}

TEST_CASE("in single precision statics come to the same") {
    Mesh<3, float, Tet4> single;
    const auto mesh = test::grid<Tet4, 3>({6, 2, 2}, {3., 1., 1.});
    single.nodes = mesh.nodes.cast<float>();
    single.cells = mesh.cells;
    const fem::NeoHookean rubber{.young = 1000., .poisson = 0.45};
    const auto solve = [&]<class S>(const Mesh<3, S, Tet4>& body) {
        Scenario<3, S> scenario;
        scenario.clamps = {{test::nodes_where(mesh, [](const auto& x) { return x(0) < 1e-9; }), {}}};
        scenario.gravity = {{Vector<3, S>(0, 0, S(-9.81)), {}}};
        const fem::Model model{body, rubber, 1., {.dilatation = Dilatation::mean}};
        const auto report = fem::equilibrium(model, scenario);
        CHECK(report.status == Status::converged);
        return Points<3, double>((report.state.positions - body.nodes).template cast<double>());
    };
    const Points<3, double> exact = solve(mesh);
    CHECK(exact.norm() > 0.5);
    CHECK((solve(single) - exact).norm() < 2e-3 * exact.norm());
}

TEST_CASE("statics refuse what does not fit") {
    const auto mesh = test::grid<Quad4, 2>({2, 2}, {1., 1.});
    const fem::Model model{mesh, fem::LinearElastic{1., 0.3}, 1.};
    Scenario<2, double> scenario;
    scenario.clamps = {{{99}, {}}};
    CHECK_THROWS_AS((void)fem::equilibrium(model, scenario), InvalidArgument);
    scenario.clamps = {{{0, 1, 2}, {}}};
    CHECK_THROWS_AS((void)fem::equilibrium(model, scenario, 0., {.tolerance = 0.}), InvalidArgument);
    CHECK_THROWS_AS((void)fem::equilibrium(model, scenario, 0., {.max_iterations = 0}), InvalidArgument);
    CHECK_THROWS_AS((void)fem::equilibrium(model, scenario, 0., {}, Points<2, double>::Zero(2, 3)), InvalidArgument);
    CHECK(fem::equilibrium(model, scenario).status == Status::converged); // nothing acts
}
