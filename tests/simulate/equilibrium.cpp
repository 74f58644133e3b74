// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/simulate/static_solver.hpp>

#include "body/example.hpp"

using namespace springfit;

namespace {

/// Largest force out of balance on a free node, N, by the plain forces.
template <int Dim, class Scalar>
Scalar unbalanced(const SpringNetwork<Dim, Scalar>& network, const Scenario<Dim, Scalar>& scenario,
                  const Points<Dim, Scalar>& positions) {
    Points<Dim, Scalar> forces = external_forces<Dim, Scalar>(scenario, network.mass, Scalar(0));
    add_elastic_forces<Dim, Scalar>(network, positions, forces);
    const FreeNodes free(network.n_nodes(), clamped_nodes(scenario, network.n_nodes()));
    return free.template gather<Dim, Scalar>(forces).template lpNorm<Eigen::Infinity>();
}

template <int Dim, class Scalar>
Scenario<Dim, Scalar> hanging(Scalar acceleration, const std::vector<int>& held = {0, 1, 2, 3}) {
    Scenario<Dim, Scalar> scenario;
    scenario.clamps.push_back({held, {}});
    scenario.gravity.push_back({Vector<Dim, Scalar>::Unit(1) * -acceleration, {}});
    return scenario;
}

/// A slender body, clamped at one end, that bends far under its own weight.
SpringNetwork<3, double> slender_body(Scenario<3, double>& scenario) {
    auto mesh = tetrahedron_grid<double>({12, 2, 2}, {1.2, 0.2, 0.2});
    jitter(mesh, 0.2, 1);
    auto network = springs_along_edges(mesh, {.volume = true, .density = 1000});
    network.stiffness = 2000 * network.rest_length;
    network.volume_stiffness.setConstant(2000);
    scenario.clamps.emplace_back();
    for (Index i = 0; i < network.n_nodes(); ++i) {
        if (network.rest_positions(0, i) < 1e-6) {
            scenario.clamps[0].nodes.push_back(static_cast<int>(i));
        }
    }
    scenario.gravity.push_back({{0, 0, -0.7}, {}});
    return network;
}

} // namespace

TEST_CASE_TEMPLATE("tiny loads move the nodes in proportion and take a few iterations", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto network = test::random_network_with_cells<dim, double>(0., 100., 300.);
    const auto small = equilibrium(network, hanging<dim, double>(1e-4));
    REQUIRE(small.status == Status::converged);
    const Points<dim, double> way = (small.positions - network.rest_positions) / 1e-4;
    for (const double size : {1e-6, 1e-8, 1e-10, 1e-12}) {
        CAPTURE(size);
        const auto tiny = equilibrium(network, hanging<dim, double>(size));
        CHECK(tiny.status == Status::converged);
        CHECK(tiny.stable);
        CHECK(tiny.iterations <= 6);
        const Points<dim, double> found = (tiny.positions - network.rest_positions) / size;
        CHECK((found - way).norm() < 1e-4 * way.norm() + 1e-14 / size * network.rest_positions.norm());
    }
    const auto idle = equilibrium(network, hanging<dim, double>(0));
    CHECK(idle.status == Status::converged);
    CHECK((idle.positions - network.rest_positions).norm() < 1e-12);
}

TEST_CASE("a body that turns far comes to rest in a few iterations") {
    Scenario<3, double> scenario;
    const auto network = slender_body(scenario);
    const auto found = equilibrium(network, scenario);
    CHECK(found.status == Status::converged);
    CHECK(found.stable);
    CHECK(found.iterations <= 40);
    CHECK((found.positions - network.rest_positions).cwiseAbs().maxCoeff() > 0.5);
    const double weight = 0.7 * network.mass.maxCoeff();
    CHECK(unbalanced(network, scenario, found.positions) < 1e-5 * weight);
    CHECK(test::relative(unbalanced(network, scenario, found.positions), found.residual, weight) < 1e-9);
    // From there on there is nothing to do.
    const auto again = equilibrium(network, scenario, {.start = found.positions});
    CHECK(again.status == Status::converged);
    CHECK(again.iterations <= 2);
    CHECK((again.positions - found.positions).norm() < 1e-5);
}

TEST_CASE_TEMPLATE("a start where the stiffness is indefinite", T, test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto network = test::random_network_with_cells<dim, double>(0., 100., 300.);
    const auto scenario = hanging<dim, double>(1);
    const auto upright = equilibrium(network, scenario);
    REQUIRE(upright.status == Status::converged);
    for (const double squeezed : {0.5, 0.3}) { // all springs at half their length and less
        EquilibriumOptions<dim, double> options;
        options.start = squeezed * network.rest_positions;
        const auto found = equilibrium(network, scenario, options);
        CHECK(found.status == Status::converged);
        CHECK(found.iterations < 100);
        CHECK(unbalanced(network, scenario, found.positions) < 1e-6 * network.mass.maxCoeff());
    }
    // A chain pressed together in line buckles to one side.
    Points<2, double> rest(2, 3);
    rest << 0, 1, 2, 0, 0, 0;
    NodePairs pairs(2, 2);
    pairs << 0, 1, 1, 2;
    auto chain = springs_from_list<2, double>(rest, pairs);
    chain.stiffness << 100, 100;
    Scenario<2, double> pressed;
    pressed.clamps.push_back({{0}, {}});
    pressed.clamps.push_back({{2}, [](const Vector<2, double>&, double) { return Vector<2, double>(1.6, 0); }});
    pressed.loads.push_back({{1}, Points<2, double>(Vector<2, double>(0, 1e-3)), {}});
    const auto buckled = equilibrium(chain, pressed);
    CHECK(buckled.status == Status::converged);
    CHECK(buckled.stable);
    CHECK(std::abs(buckled.positions(1, 1)) > 0.5);
}

TEST_CASE("networks that hold next to nothing are given up after a few iterations") {
    auto network = test::random_network<3, double>(0, 4);
    for (Index e = 0; e < network.n_springs(); ++e) {
        if (e % 10 != 0) {
            network.stiffness(e) *= 1e-9;
        }
    }
    const auto lost = equilibrium(network, hanging<3, double>(3));
    CHECK(lost.status == Status::diverged);
    CHECK(lost.iterations <= 20);
    CHECK_FALSE(lost.stable);
    const auto falling = equilibrium(test::random_network<3, double>(0), hanging<3, double>(9.81, {}));
    CHECK(falling.status == Status::diverged);
    CHECK(falling.iterations <= 20);
}

TEST_CASE_TEMPLATE("cases that share a solver end where they end alone", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network<dim, Scalar>(0);
    auto statics = make_static_solver(network);
    for (const auto& held : {std::vector<int>{0, 1, 2, 3}, {0, 1, 2, 3}, {4, 5, 6, 7, 8}, {0, 1, 2, 3}}) {
        for (const Scalar size : {Scalar(3), Scalar(-1)}) {
            const auto scenario = hanging<dim, Scalar>(size, held);
            Points<dim, Scalar> shared;
            CHECK(statics.solve_equilibrium(scenario, 0, shared) == Status::converged);
            const auto alone = equilibrium(network, scenario);
            CHECK(alone.status == Status::converged);
            CHECK(shared == alone.positions);
        }
    }
}
