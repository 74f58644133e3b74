// SPDX-License-Identifier: BSD-3-Clause
#include "allocations.hpp"

#include "threads.hpp"
#include "tolerance.hpp"

#include <springfit/motion/record.hpp>
#include <springfit/simulate/equilibrium.hpp>
#include <springfit/simulate/implicit_euler.hpp>
#include <springfit/simulate/projective_euler.hpp>
#include <springfit/simulate/stable_step.hpp>

#include "body/example.hpp"
#include "body/node_access.hpp"

using namespace springfit;

static_assert(Stepper<ProjectiveEuler<2, double>>);
static_assert(Stepper<ProjectiveEuler<3, float>>);

namespace {

template <class S>
auto run(S&& stepper,
         const Scenario<std::remove_cvref_t<S>::dimension, typename std::remove_cvref_t<S>::Scalar>& scenario,
         typename std::remove_cvref_t<S>::Scalar dt, int frames) {
    auto state = stepper.start(scenario);
    for (int f = 0; f < frames; ++f) {
        REQUIRE(stepper.advance(state, scenario, dt) == Status::converged);
    }
    return state;
}

} // namespace

TEST_CASE_TEMPLATE("with iterations the projective step goes to the implicit one, clamps and damping included", T,
                   test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    for (const double damping : {0., 0.01}) {
        const auto network = test::random_network<dim, double>(damping);
        auto scenario = test::thrown<dim, double>(network, 0.1);
        scenario.clamps.push_back({{0, 1}, [](const Vector<dim, double>& rest, double t) {
                                       return Vector<dim, double>(rest +
                                                                  (1 - std::cos(t)) * Vector<dim, double>::Ones());
                                   }});
        scenario.gravity.push_back({Vector<dim, double>::Unit(1) * -2, {}});
        const auto exact = run(ImplicitEuler<dim, double>(network), scenario, 0.05, 5);
        double before = exact.positions.norm();
        for (const int iterations : {1, 4, 16, 64}) {
            const auto state =
                run(ProjectiveEuler<dim, double>(network, {.max_iterations = iterations, .tolerance = 1e-12}), scenario,
                    0.05, 5);
            const double error = (state.positions - exact.positions).norm();
            CHECK(error < before);
            before = 0.7 * error;
        }
        const auto whole =
            run(ProjectiveEuler<dim, double>(network, {.max_iterations = 5000, .tolerance = 1e-9}), scenario, 0.05, 5);
        CHECK((whole.positions - exact.positions).norm() < 1e-6);
        CHECK((whole.positions - network.rest_positions).norm() > 0.1);
    }
}

TEST_CASE_TEMPLATE("few iterations keep momentum", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network<dim, Scalar>(Scalar(0.01));
    const auto thrown = test::thrown<dim, Scalar>(network);
    ProjectiveBody<dim, Scalar> body(network, {.max_iterations = 3});
    body.write(thrown.initial_positions, thrown.initial_velocities);
    for (int s = 0; s < 20; ++s) {
        CHECK(usable(body.step(Scalar(0.1)).status));
    }
    Points<dim, Scalar> x, v;
    body.read(x, v);
    const Vector<dim, Scalar> momentum = thrown.initial_velocities * network.mass;
    const Vector<dim, Scalar> now = v * network.mass;
    CHECK((now - momentum).norm() < Scalar(2e-4) * momentum.norm()); // solves in single precision
}

TEST_CASE_TEMPLATE("the projective step settles in the equilibrium, on one factorisation", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network<dim, Scalar>(Scalar(0.01));
    Points<dim, Scalar> loads = Points<dim, Scalar>::Zero(dim, network.n_nodes());
    loads.row(1) = -5 * network.mass.transpose();
    ProjectiveBody<dim, Scalar> body(network);
    body.set_clamped({0, 1, 2, 3});
    body.set_external_forces(loads);
    const Scalar h = 30 * stable_step(network);
    for (int s = 0; s < 800; ++s) { // until the swing has died down
        CHECK(usable(body.step(h).status));
    }
    CHECK(body.n_factorisations() == 1);
    Scenario<dim, Scalar> scenario;
    scenario.clamps.push_back({{0, 1, 2, 3}, {}});
    scenario.gravity.push_back({Vector<dim, Scalar>::Unit(1) * -5, {}});
    const auto statics = equilibrium(network, scenario);
    REQUIRE(statics.status == Status::converged);
    Points<dim, Scalar> x, v;
    body.read(x, v);
    CHECK((x - statics.positions).norm() < Scalar(1e-3) * (statics.positions - network.rest_positions).norm());
    body.set_clamped({0, 1, 2, 3});
    (void)body.step(h);
    CHECK(body.n_factorisations() == 1);
    body.set_clamped({0, 1, 2});
    (void)body.step(h);
    (void)body.step(h / 2);
    CHECK(body.n_factorisations() == 3);
}

TEST_CASE_TEMPLATE("domains change neither the projective step nor its bits, and it allocates nothing", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network<dim, Scalar>(Scalar(0.01), dim == 2 ? 150 : 26);
    const auto thrown = test::thrown<dim, Scalar>(network, Scalar(0.01));
    const Scalar h = 5 * stable_step(network);
    Points<dim, Scalar> x[2], v[2];
    for (int run = 0; run < 2; ++run) {
        ProjectiveBody<dim, Scalar> body(network, {.max_iterations = 3},
                                         run == 0 ? Execution() : test::backwards_on_threads());
        body.set_clamped({5});
        body.write(thrown.initial_positions, thrown.initial_velocities);
        (void)body.step(h);
        const long before = test::n_allocations;
        Eigen::internal::set_is_malloc_allowed(false);
        (void)body.step(h);
        Eigen::internal::set_is_malloc_allowed(true);
        CHECK((run == 1 || test::n_allocations == before)); // an execution of one's own may
        body.read(x[run], v[run]);
    }
    CHECK(x[0] == x[1]);
    CHECK(v[0] == v[1]);
    ImplicitBody<dim, Scalar> exact(network, {.max_iterations = 30, .tolerance = Scalar(1e-6)});
    exact.set_clamped({5});
    exact.write(thrown.initial_positions, thrown.initial_velocities);
    ProjectiveBody<dim, Scalar> whole(network, {.max_iterations = 300, .tolerance = Scalar(1e-6)});
    whole.set_clamped({5});
    whole.write(thrown.initial_positions, thrown.initial_velocities);
    (void)exact.step(h);
    (void)whole.step(h);
    exact.read(x[0], v[0]);
    whole.read(x[1], v[1]);
    CHECK((x[0] - x[1]).norm() < Scalar(2e-3) * (x[0] - thrown.initial_positions).norm());
}

TEST_CASE_TEMPLATE("nodes are set and read one by one", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network<dim, Scalar>(Scalar(0.01));
    const ProjectiveBody<dim, Scalar> body(network);
    test::check_node_access(body, body, {0, 3}, stable_step(network) / 4);
}

TEST_CASE("what the projective step cannot do is refused") {
    const auto network = test::random_network<2, double>(0);
    CHECK_THROWS_AS((ProjectiveBody<2, double>(network, {.max_iterations = 0})), InvalidArgument);
    CHECK_THROWS_AS((ProjectiveBody<2, double>(network, {.tolerance = 0})), InvalidArgument);
    CHECK_THROWS_AS((ProjectiveBody<2, double>(test::random_network_with_cells<2, double>(0, 1, 2))), InvalidArgument);
    ProjectiveBody<2, double> body(network);
    CHECK_THROWS_AS((void)body.step(-1), InvalidArgument);
    CHECK_THROWS_AS(body.set_clamped({1000}), InvalidArgument);
}
