// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/motion/state.hpp>

using namespace springfit;
using test::rounding;

TEST_CASE_TEMPLATE("external forces are gravity by mass and nodal loads, each by its amplitude", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    using V = Vector<dim, Scalar>;
    Values<Scalar> masses(3);
    masses << 1, 2, 4;
    const V down = -Scalar(10) * V::Unit(dim - 1);
    const V side = Scalar(3) * V::Unit(0);

    Scenario<dim, Scalar> scenario;
    CHECK(external_forces(scenario, masses, Scalar(1)).norm() == 0);
    scenario.gravity.push_back({down, {}});
    scenario.gravity.push_back({side, [](Scalar time) { return time * time; }});
    NodalLoad<dim, Scalar> load{{2, 0, 2}, Points<dim, Scalar>(dim, 3), [](Scalar time) { return 1 - time; }};
    load.forces << V::Constant(1), V::Constant(2), V::Constant(4); // node 2 is named twice: both act
    scenario.loads.push_back(load);
    for (const Scalar time : {Scalar(0), Scalar(0.5), Scalar(3)}) {
        const auto forces = external_forces(scenario, masses, time);
        Points<dim, Scalar> expected(dim, 3);
        for (Index i = 0; i < 3; ++i) {
            expected.col(i) = masses(i) * (down + time * time * side);
        }
        expected.col(0) += (1 - time) * V::Constant(2);
        expected.col(2) += (1 - time) * V::Constant(5);
        CHECK(test::relative_difference(forces, expected) < rounding<Scalar>());
    }
}

TEST_CASE_TEMPLATE("clamps hold nodes at rest or lead them in time", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    using V = Vector<dim, Scalar>;
    const Points<dim, Scalar> rest = Points<dim, Scalar>::Random(dim, 4);
    Scenario<dim, Scalar> scenario;
    scenario.clamps.push_back({{3, 1}, {}});
    scenario.clamps.push_back({{1, 0}, [](const V& x, Scalar time) -> V { return x + time * V::Unit(1); }});
    CHECK(clamped_nodes(scenario, 4) == std::vector<int>{0, 1, 3});

    Points<dim, Scalar> positions = Points<dim, Scalar>::Constant(dim, 4, 7);
    apply_clamps(scenario, rest, Scalar(2), positions);
    CHECK(positions.col(3) == rest.col(3));
    CHECK(positions.col(2) == V::Constant(7)); // free
    for (const int led : {0, 1}) {             // the later clamp has the last word on node 1
        const V expected = rest.col(led) + 2 * V::Unit(1);
        CHECK(test::relative_difference(positions.col(led), expected) < rounding<Scalar>());
    }
}

TEST_CASE_TEMPLATE("the start is the rest or the scenario's own, with the clamps on", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const Points<dim, Scalar> rest = Points<dim, Scalar>::Random(dim, 3);
    Scenario<dim, Scalar> scenario;
    CHECK(initial_positions(scenario, rest) == rest);
    CHECK(initial_velocities(scenario, rest).norm() == 0);
    scenario.initial_positions = 2 * rest;
    scenario.initial_velocities = Points<dim, Scalar>::Ones(dim, 3);
    scenario.clamps.push_back({{1}, {}});
    const auto positions = initial_positions(scenario, rest);
    CHECK(positions.col(0) == 2 * rest.col(0));
    CHECK(positions.col(1) == rest.col(1));
    const auto velocities = initial_velocities(scenario, rest);
    CHECK(velocities.col(1).norm() == 0);
    CHECK(velocities.col(2) == scenario.initial_velocities.col(2));
}

TEST_CASE("scenarios that do not fit the body are refused by name") {
    using S = Scenario<3, double>;
    CHECK_NOTHROW(validate(S{}, 2));
    S clamp;
    clamp.clamps.push_back({{0, 2}, {}});
    CHECK_NOTHROW(validate(clamp, 3));
    CHECK_THROWS_WITH_AS(validate(clamp, 2), "clamp: expected node numbers below 2, found 2", InvalidArgument);
    clamp.clamps[0].nodes[0] = -1;
    CHECK_THROWS_AS(validate(clamp, 3), InvalidArgument);

    S load;
    load.loads.push_back({{0, 1}, Points<3, double>::Ones(3, 1), {}});
    CHECK_THROWS_WITH_AS(validate(load, 2), "load: expected 2 forces, one per node, found 1", InvalidArgument);
    load.loads[0].forces.setOnes(3, 2);
    CHECK_NOTHROW(validate(load, 2));
    CHECK_THROWS_WITH_AS(validate(load, 1), "load: expected node numbers in [0, 1), found 1", InvalidArgument);
    load.loads[0].forces(1, 1) = std::nan("");
    CHECK_THROWS_AS(validate(load, 2), InvalidArgument);

    S start;
    start.initial_velocities.setZero(3, 4);
    CHECK_NOTHROW(validate(start, 4));
    CHECK_THROWS_WITH_AS(validate(start, 5), "initial state: expected 5 columns, one per node, found 4",
                         InvalidArgument);
    start.initial_velocities(0, 0) = INFINITY;
    CHECK_THROWS_AS(validate(start, 4), InvalidArgument);
}
