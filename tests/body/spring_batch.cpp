// SPDX-License-Identifier: BSD-3-Clause
#include "allocations.hpp"

#include "threads.hpp"
#include "tolerance.hpp"

#include <springfit/body/spring_batch.hpp>
#include <springfit/body/spring_body.hpp>
#include <springfit/simulate/stable_step.hpp>

#include "body/example.hpp"

using namespace springfit;

namespace {

/// The start and the load of a body of a batch, other than those of its neighbours.
template <int Dim, class Scalar>
Scenario<Dim, Scalar> start(const SpringNetwork<Dim, Scalar>& network, Index body) {
    return test::thrown<Dim, Scalar>(network, Scalar(0.02) * static_cast<Scalar>(body % 9));
}

template <int Dim, class Scalar>
Points<Dim, Scalar> load(const SpringNetwork<Dim, Scalar>& network, Index body) {
    return Points<Dim, Scalar>::Constant(Dim, network.n_nodes(), static_cast<Scalar>(body) / 10);
}

template <int Dim, class Scalar>
SpringBatch<Dim, Scalar> moved(const SpringNetwork<Dim, Scalar>& network, Index n_bodies, Scalar h, int steps,
                               const Execution& execution = {}) {
    SpringBatch<Dim, Scalar> batch(network, n_bodies, execution);
    for (Index b = 0; b < n_bodies; ++b) {
        const auto scenario = start(network, b);
        batch.write(b, scenario.initial_positions, scenario.initial_velocities);
        batch.set_external_forces(b, load(network, b));
    }
    batch.set_clamped({1, 4});
    for (int s = 0; s < steps; ++s) {
        batch.step(h);
    }
    return batch;
}

} // namespace

TEST_CASE_TEMPLATE("every body of a batch moves as it does alone", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network_with_cells<dim, Scalar>(Scalar(0.01), -10, 100);
    const Scalar h = stable_step(network) / 4;
    constexpr Index n_bodies = 11; // the last group is not full
    const auto batch = moved<dim, Scalar>(network, n_bodies, h, 20);
    Points<dim, Scalar> x, v, alone_x, alone_v;
    for (Index b = 0; b < n_bodies; ++b) {
        const auto scenario = start(network, b);
        SpringBody<dim, Scalar> body(network);
        body.write(scenario.initial_positions, scenario.initial_velocities);
        body.set_external_forces(load(network, b));
        body.set_clamped({1, 4});
        for (int s = 0; s < 20; ++s) {
            body.step(h);
        }
        body.read(alone_x, alone_v);
        batch.read(b, x, v);
        CHECK((x - alone_x).cwiseAbs().maxCoeff() < test::rounding<Scalar>(200));
        CHECK((v - alone_v).cwiseAbs().maxCoeff() < test::rounding<Scalar>(200) / h);
        CHECK((x - scenario.initial_positions).cwiseAbs().maxCoeff() > Scalar(0.01));
    }
}

TEST_CASE_TEMPLATE("a body's bits depend neither on the threads nor on its neighbours", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network_with_cells<dim, Scalar>(Scalar(0.01), -10, 100);
    const Scalar h = stable_step(network) / 4;
    const auto many = moved<dim, Scalar>(network, 20, h, 10);
    const auto again = moved<dim, Scalar>(network, 20, h, 10, test::backwards_on_threads());
    const auto few = moved<dim, Scalar>(network, 3, h, 10);
    Points<dim, Scalar> x, v, y, w;
    many.read(17, x, v);
    again.read(17, y, w);
    CHECK(x == y);
    CHECK(v == w);
    many.read(2, x, v);
    few.read(2, y, w);
    CHECK(x == y);
    CHECK(v == w);
}

TEST_CASE_TEMPLATE("a step of a batch allocates nothing", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network_with_cells<dim, Scalar>(Scalar(0.01), -10, 100);
    auto batch = moved<dim, Scalar>(network, 20, Scalar(0.001), 0);
    const long before = test::n_allocations;
    Eigen::internal::set_is_malloc_allowed(false);
    batch.step(Scalar(0.001));
    batch.step(Scalar(0.001));
    Eigen::internal::set_is_malloc_allowed(true);
    CHECK(test::n_allocations == before);
}

TEST_CASE("wrong sizes and numbers of a batch are refused") {
    const auto network = test::random_network<3, float>(0);
    CHECK_THROWS_AS((SpringBatch<3, float>(network, 0)), InvalidArgument);
    SpringBatch<3, float> batch(network, 2);
    const Points<3, float> few = Points<3, float>::Zero(3, 1);
    Points<3, float> x = network.rest_positions;
    Points<3, float> v = x;
    CHECK_THROWS_AS(batch.write(0, few, few), InvalidArgument);
    CHECK_THROWS_AS(batch.write(2, x, v), InvalidArgument);
    CHECK_THROWS_AS(batch.read(-1, x, v), InvalidArgument);
    CHECK_THROWS_AS(batch.set_external_forces(0, few), InvalidArgument);
    CHECK_THROWS_AS(batch.set_clamped({1000}), InvalidArgument);
}
