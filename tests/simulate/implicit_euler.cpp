// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/motion/record.hpp>
#include <springfit/simulate/equilibrium.hpp>
#include <springfit/simulate/implicit_euler.hpp>
#include <springfit/simulate/symplectic_euler.hpp>

#include "body/example.hpp"

using namespace springfit;

static_assert(Stepper<ImplicitEuler<2, double>>);
static_assert(Stepper<ImplicitEuler<3, float>>);

namespace {

template <class S>
auto run(S& stepper, const Scenario<S::dimension, typename S::Scalar>& scenario, typename S::Scalar dt, int frames) {
    auto state = stepper.start(scenario);
    for (int f = 0; f < frames; ++f) {
        REQUIRE(stepper.advance(state, scenario, dt) == Status::converged);
    }
    return state;
}

template <int Dim, class Scalar>
Scenario<Dim, Scalar> driven(const SpringNetwork<Dim, Scalar>& network) {
    auto scenario = test::thrown<Dim, Scalar>(network, Scalar(0.1));
    scenario.clamps.push_back({{0, 1}, [](const Vector<Dim, Scalar>& rest, Scalar t) {
                                   return Vector<Dim, Scalar>(rest +
                                                              (1 - std::cos(t)) / 5 * Vector<Dim, Scalar>::Ones());
                               }});
    scenario.gravity.push_back({Vector<Dim, Scalar>::Unit(1) * -2, [](Scalar t) { return 1 + t; }});
    return scenario;
}

} // namespace

TEST_CASE_TEMPLATE("implicit Euler is of first order, damped, clamped and loaded", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    for (const double damping : {0., 0.01}) {
        const auto network = test::random_network<dim, double>(damping);
        const auto scenario = driven<dim, double>(network);
        SymplecticEuler<dim, double> fine(network, {.step_fraction = 0.02});
        const auto exact = run(fine, scenario, 0.01, 10);
        double error[2];
        for (int level = 0; level < 2; ++level) {
            ImplicitEuler<dim, double> stepper(network);
            const int steps = 100 << level;
            const auto state = run(stepper, scenario, 0.1 / steps, steps);
            error[level] = (state.positions - exact.positions).norm();
        }
        CHECK(error[0] < 0.02 * exact.positions.norm());
        CHECK(error[0] / error[1] > 1.8);
        CHECK(error[0] / error[1] < 2.2);
    }
}

TEST_CASE_TEMPLATE("an implicit step balances the forces at its end", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network =
        test::random_network<dim, Scalar>(0); // without damping nothing is lagged: (v1 - v0) / h = a(x1)
    const auto scenario = driven<dim, Scalar>(network);
    ImplicitEuler<dim, Scalar> stepper(network);
    auto state = stepper.start(scenario);
    for (int s = 0; s < 5; ++s) {
        const auto before = state;
        REQUIRE(stepper.advance(state, scenario, Scalar(0.05)) == Status::converged);
        const Points<dim, Scalar> rate = (state.velocities - before.velocities) / Scalar(0.05);
        CHECK(
            test::relative_difference(rate.rightCols(rate.cols() - 2), state.accelerations.rightCols(rate.cols() - 2)) <
            std::max(Scalar(1e-6), test::rounding<Scalar>(20000)));
    }
}

TEST_CASE_TEMPLATE("implicit Euler is stable at any step and settles in the equilibrium", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    auto network = test::random_network<dim, Scalar>(Scalar(0.01));
    Scenario<dim, Scalar> scenario;
    scenario.clamps.push_back({{0, 1, 2, 3}, {}});
    scenario.gravity.push_back({Vector<dim, Scalar>::Unit(1) * -5, {}});
    scenario.initial_positions = test::thrown<dim, Scalar>(network).initial_positions;
    ImplicitEuler<dim, Scalar> stepper(network);
    const auto settled = run(stepper, scenario, Scalar(100) * stable_step(network), 200);
    CHECK(settled.velocities.norm() < std::max(Scalar(1e-8), test::rounding<Scalar>(1000)));
    Scenario<dim, Scalar> at_rest = scenario;
    at_rest.initial_positions.resize(dim, 0);
    const auto statics = equilibrium(network, at_rest);
    CHECK(statics.status == Status::converged);
    CHECK(statics.stable);
    CHECK((settled.positions - statics.positions).norm() < std::max(Scalar(1e-6), test::rounding<Scalar>(10000)));
    CHECK((statics.positions - network.rest_positions).norm() > Scalar(1e-3));
}

TEST_CASE_TEMPLATE("with cells of either sign implicit Euler goes where the explicit stepper goes", T,
                   test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    for (const double least : {-3., 100.}) {
        const auto network = test::random_network_with_cells<dim, double>(0.01, least, 300.);
        const auto scenario = driven<dim, double>(network);
        SymplecticEuler<dim, double> fine(network, {.step_fraction = 0.02, .max_substeps = 100000});
        const auto exact = run(fine, scenario, 0.01, 10);
        double error[2];
        for (int level = 0; level < 2; ++level) {
            ImplicitEuler<dim, double> stepper(network);
            const int steps = 200 << level;
            error[level] = (run(stepper, scenario, 0.1 / steps, steps).positions - exact.positions).norm();
        }
        CHECK(error[0] < 0.02 * exact.positions.norm());
        CHECK(error[0] / error[1] > 1.8);
        CHECK(error[0] / error[1] < 2.2);
    }
}

TEST_CASE_TEMPLATE("with stiff cells large steps settle in the equilibrium", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const Scalar kappa = std::same_as<Scalar, float> ? 50 : 1000; // in single precision, as far as its digits go
    const auto network = test::random_network_with_cells<dim, Scalar>(Scalar(0.01), kappa, 2 * kappa);
    Scenario<dim, Scalar> scenario;
    scenario.clamps.push_back({{0, 1, 2, 3}, {}});
    scenario.gravity.push_back({Vector<dim, Scalar>::Unit(1) * -5, {}});
    ImplicitEuler<dim, Scalar> stepper(network);
    const auto settled = run(stepper, scenario, Scalar(0.2), 200);
    const auto statics = equilibrium(network, scenario);
    CHECK(statics.status == Status::converged);
    CHECK(statics.stable);
    CHECK((settled.positions - statics.positions).norm() < std::max(Scalar(1e-6), test::rounding<Scalar>(10000)));
    CHECK((statics.positions - network.rest_positions).norm() > Scalar(1e-3));
    auto springs_alone = network;
    springs_alone.volume_stiffness.setZero();
    const auto softer = equilibrium(springs_alone, scenario);
    CHECK((softer.positions - network.rest_positions).norm() > (statics.positions - network.rest_positions).norm());
}

TEST_CASE("two masses under implicit Euler follow its own recurrence, damping included") {
    const auto network = test::two_masses<2, double>(100, 3);
    Scenario<2, double> scenario;
    scenario.initial_positions = network.rest_positions;
    scenario.initial_positions(0, 1) += 0.3;
    ImplicitEuler<2, double> stepper(network);
    auto state = stepper.start(scenario);
    double stretch = 0.3;
    double rate = 0;
    const double h = 0.02;
    for (int s = 0; s < 50; ++s) {
        REQUIRE(stepper.advance(state, scenario, h) == Status::converged);
        const double w = 4. / 3; // inverse reduced mass
        rate = (rate - h * w * 100 * stretch) / (1 + h * w * 3 + h * h * w * 100);
        stretch += h * rate;
        CHECK(std::abs(state.positions(0, 1) - state.positions(0, 0) - 1 - stretch) < 1e-8);
    }
}

TEST_CASE("a hanging chain stretches by the weight below each spring") {
    Points<2, double> rest(2, 4);
    rest << 0, 0, 0, 0, 0, -1, -2, -3;
    NodePairs pairs(2, 3);
    pairs << 0, 1, 2, 1, 2, 3;
    auto network = springs_from_list<2, double>(rest, pairs, Values<double>::Constant(4, 2.));
    network.stiffness << 100, 50, 25;
    Scenario<2, double> scenario;
    scenario.clamps.push_back(
        {{0}, [](const Vector<2, double>& x, double t) { return Vector<2, double>(x + Vector<2, double>(t, 0)); }});
    scenario.gravity.push_back({{0, -10}, [](double t) { return t; }});
    const auto result = equilibrium(network, scenario, {.time = 1});
    CHECK(result.status == Status::converged);
    CHECK(result.stable);
    CHECK(std::abs(result.positions(1, 1) + 1.6) < 1e-9);       // 60 / 100
    CHECK(std::abs(result.positions(1, 2) + 2.6 + 0.8) < 1e-9); // 40 / 50
    CHECK(std::abs(result.positions(1, 3) + 3.4 + 0.8 + 1) < 1e-9);
    CHECK((result.positions.row(0).array() - 1).abs().maxCoeff() < 1e-7);
}

TEST_CASE("equilibria that springs cannot hold are reported") {
    // Two springs in line, pushed sideways: no linear stiffness, but it stiffens: f = 2 k (L - l) w / L.
    Points<2, double> rest(2, 3);
    rest << 0, 1, 2, 0, 0, 0;
    NodePairs pairs(2, 2);
    pairs << 0, 1, 1, 2;
    auto network = springs_from_list<2, double>(rest, pairs);
    network.stiffness << 100, 100;
    Scenario<2, double> scenario;
    scenario.clamps.push_back({{0, 2}, {}});
    scenario.loads.push_back({{1}, Points<2, double>(Vector<2, double>(0, 1)), {}});
    const auto pushed = equilibrium(network, scenario);
    CHECK(pushed.status == Status::converged);
    CHECK(pushed.stable);
    const double w = pushed.positions(1, 1);
    const double length = std::hypot(1, w);
    CHECK(test::relative(200 * (length - 1) * w / length, 1., 1.) < 1e-7);

    scenario.loads.clear();
    const auto idle = equilibrium(network, scenario);
    CHECK(idle.status == Status::converged);
    CHECK_FALSE(idle.stable); // free to move sideways

    const auto body = test::random_network<3, double>(0);
    const auto floating = equilibrium(body, {});
    CHECK(floating.status == Status::converged);
    CHECK_FALSE(floating.stable);
    Scenario<3, double> falling;
    falling.gravity.push_back({{0, 0, -9.81}, {}});
    CHECK(equilibrium(body, falling, {.max_iterations = 20}).status != Status::converged);

    const auto quads = quad_grid<double>({3, 3}, {1., 1.});
    auto mechanism = springs_along_edges(quads);
    mechanism.stiffness.setConstant(10);
    Scenario<2, double> held;
    held.clamps.push_back({{0, 1, 2, 3}, {}});
    CHECK_FALSE(equilibrium(mechanism, held).stable);
    auto braced = springs_along_edges(quads, {.diagonals = true});
    braced.stiffness.setConstant(10);
    CHECK(equilibrium(braced, held).stable);
}

TEST_CASE("options and steps out of range are refused") {
    const auto network = test::two_masses<2, double>(1, 0);
    CHECK_THROWS_AS((ImplicitEuler<2, double>(network, {.tolerance = 0})), InvalidArgument);
    CHECK_THROWS_AS((ImplicitEuler<2, double>(network, {.max_iterations = 0})), InvalidArgument);
    ImplicitEuler<2, double> stepper(network);
    auto state = stepper.start({});
    CHECK_THROWS_AS((void)stepper.advance(state, {}, -1.), InvalidArgument);
    CHECK_THROWS_AS((void)equilibrium(network, {}, {.start = Points<2, double>::Zero(2, 5)}), InvalidArgument);
    Scenario<2, double> scenario;
    scenario.clamps.push_back({{7}, {}});
    CHECK_THROWS_AS((void)stepper.start(scenario), InvalidArgument);
    CHECK_THROWS_AS((void)equilibrium(network, scenario), InvalidArgument);
}

TEST_CASE_TEMPLATE("large implicit steps and equilibria of a body that bends under its own weight", Scalar, float,
                   double) {
    auto mesh = tetrahedron_grid<Scalar>({8, 3, 3}, {Scalar(0.8), Scalar(0.3), Scalar(0.3)});
    jitter(mesh, Scalar(0.2), 1);
    auto network = springs_along_edges(mesh, {.density = 1000});
    network.stiffness = 2000 * network.rest_length; // N/m: about 5 kPa
    Scenario<3, Scalar> scenario;
    scenario.clamps.emplace_back();
    for (Index i = 0; i < network.n_nodes(); ++i) {
        if (network.rest_positions(0, i) < Scalar(1e-6)) {
            scenario.clamps[0].nodes.push_back(static_cast<int>(i));
        }
    }
    scenario.gravity.push_back({{0, 0, Scalar(-9.81)}, {}});
    ImplicitEuler<3, Scalar> stepper(network);
    const auto bent = run(stepper, scenario, Scalar(0.02), 100);
    CHECK((bent.positions - network.rest_positions).cwiseAbs().maxCoeff() > Scalar(0.1));
    scenario.gravity[0].acceleration *= Scalar(0.2);
    const auto sagging = equilibrium(network, scenario);
    CHECK(sagging.status == Status::converged);
    CHECK(sagging.stable);
    CHECK(sagging.iterations < 200);
}
