// SPDX-License-Identifier: BSD-3-Clause
#include "threads.hpp"
#include "tolerance.hpp"

#include <springfit/motion/record_static.hpp>
#include <springfit/score/motion_error.hpp>
#include <springfit/simulate/static_solver.hpp>

#include "../body/example.hpp"

using namespace springfit;

namespace {

template <int Dim, class Scalar>
struct Cases {
    std::vector<Scenario<Dim, Scalar>> scenarios;
    std::vector<Motion<Dim, Scalar>> references;
};

/// Three load cases, the last a static one.
template <int Dim, class Scalar>
Cases<Dim, Scalar> cases(const SpringNetwork<Dim, Scalar>& network) {
    Cases<Dim, Scalar> result;
    for (int c = 0; c < 3; ++c) {
        Scenario<Dim, Scalar> scenario;
        scenario.name = text("case ", c);
        scenario.clamps.push_back({{0, 1, 2, 3}, {}});
        scenario.gravity.push_back({Vector<Dim, Scalar>::Unit(1) * Scalar(c == 1 ? 2 : -3), {}});
        result.scenarios.push_back(scenario);
        if (c < 2) {
            result.references.push_back(record(network, scenario, {.dt = Scalar(0.02), .frames = 11}).motion);
        } else {
            Motion<Dim, Scalar> at_rest;
            at_rest.name = scenario.name;
            at_rest.rest_positions = network.rest_positions;
            at_rest.clamped = {0, 1, 2, 3};
            at_rest.times = {Scalar(0)};
            at_rest.positions = {equilibrium(network, scenario).positions};
            result.references.push_back(at_rest);
        }
    }
    return result;
}

} // namespace

TEST_CASE("the error is the root of summed squares over free nodes, frames and cases") {
    Motion<2, double> reference;
    reference.rest_positions.resize(2, 3);
    reference.rest_positions << 0, 1, 2, 0, 0, 0;
    reference.clamped = {1};
    reference.times = {0, 1};
    reference.positions = {reference.rest_positions, reference.rest_positions};
    reference.positions[1](0, 0) += 3;
    reference.positions[1](1, 2) += 4;
    reference.positions[1](1, 1) += 100; // clamped: does not count
    auto motion = reference;
    motion.positions[0](0, 2) += 1;
    motion.positions[1](1, 2) += 2;
    motion.positions[1](1, 1) -= 50;
    const auto one = motion_error<2, double>({motion}, {reference});
    CHECK(test::relative(one.error, std::sqrt(5. / 25), 1.) < 1e-15);
    auto other = reference;
    other.positions[1](0, 0) += 2; // moves by 5 and 4
    const auto two = motion_error<2, double>({motion, reference}, {reference, other});
    CHECK(test::relative(two.error, std::sqrt((5. + 4) / (25 + 41)), 1.) < 1e-15);
    CHECK(test::relative(two.case_errors[0], one.error, 1.) < 1e-15);
    CHECK(test::relative(two.case_errors[1], std::sqrt(4. / 41), 1.) < 1e-15);
    CHECK(two.status == Status::converged);
    CHECK((motion_error<2, double>({reference}, {reference}).error) == 0);

    motion.positions.pop_back();
    const auto cut = motion_error<2, double>({reference, motion}, {reference, reference});
    CHECK(test::relative(cut.error, std::sqrt(1. / 2), 1.) < 1e-15); // as if it had not moved
    CHECK(cut.case_errors[0] == 0);
    CHECK(cut.case_errors[1] == 1);
    CHECK(cut.status == Status::diverged);
    CHECK_THROWS_AS((void)(motion_error<2, double>({motion}, {reference, reference})), InvalidArgument);
}

TEST_CASE_TEMPLATE("a network has no error against itself and a plain one where its stiffness differs", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network<dim, Scalar>(Scalar(0.001));
    const auto set = cases<dim, Scalar>(network);
    const auto same = motion_error(network, set.scenarios, set.references);
    CHECK(same.status == Status::converged);
    CHECK(same.error < static_cast<double>(test::rounding<Scalar>(1000)));
    auto softer = network;
    softer.stiffness *= Scalar(0.8);
    const auto different = motion_error(softer, set.scenarios, set.references);
    CHECK(different.error > 0.02);
    CHECK(different.error < 1);
    // The same by way of the recorded motions.
    const auto dynamic = simulate(softer, set.scenarios[0], set.references[0].times);
    CHECK(dynamic.status == Status::converged);
    CHECK_NOTHROW(validate(dynamic.motion));
    const auto by_motion = motion_error<dim, Scalar>({dynamic.motion}, {set.references[0]});
    CHECK(test::relative(by_motion.error, different.case_errors[0], different.error) < 1e-12);
    // Cases in any order, on any execution.
    const auto again =
        motion_error(softer, set.scenarios, set.references, {}, {.execution = test::backwards_on_threads()});
    CHECK(again.error == different.error);
}

TEST_CASE_TEMPLATE("static cases are scored under clamps of their own", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network<dim, Scalar>(Scalar(0));
    std::vector<Scenario<dim, Scalar>> scenarios;
    for (const auto& held : {std::vector<int>{0, 1, 2, 3}, {4, 5, 6, 7, 8}, {9, 2, 5, 7}, {0, 1, 2, 3}}) {
        Scenario<dim, Scalar> scenario;
        scenario.clamps.push_back({held, {}});
        scenario.gravity.push_back({Vector<dim, Scalar>::Unit(1) * Scalar(-3), {}});
        scenarios.push_back(scenario);
    }
    std::vector<Motion<dim, Scalar>> references;
    for (const auto& recording : record_statics(network, scenarios)) {
        CHECK(recording.status == Status::converged);
        references.push_back(recording.motion);
    }
    const auto same = motion_error(network, scenarios, references);
    CHECK(same.status == Status::converged);
    CHECK(same.error < static_cast<double>(test::rounding<Scalar>(1000)));
    // Each case is what it is alone.
    auto softer = network;
    softer.stiffness *= Scalar(0.9);
    const auto all = motion_error(softer, scenarios, references);
    CHECK(all.case_errors[0] == all.case_errors[3]);
    for (std::size_t c = 0; c < 3; ++c) {
        const auto alone = motion_error<dim, Scalar>(softer, {scenarios[c]}, {references[c]});
        CHECK(alone.error == all.case_errors[c]);
        CHECK(alone.error > 0.05);
        CHECK(alone.error < 0.5);
    }
    // From rest one iteration is too few, at the reference's positions none is needed.
    CHECK(equilibrium(network, scenarios[0], {.max_iterations = 1}).status != Status::converged);
    const auto brief = motion_error(network, scenarios, references, {}, {.max_iterations = 1});
    CHECK(brief.status == Status::converged);
    CHECK(brief.error < static_cast<double>(test::rounding<Scalar>(1000)));
    CHECK_THROWS_AS((void)motion_error(network, scenarios, references, {}, {.max_iterations = 0}), InvalidArgument);
}

TEST_CASE("frames may be at any times") {
    const auto network = test::random_network<2, double>(0.001);
    const auto scenario = test::thrown<2, double>(network, 0.05);
    const auto even = simulate(network, scenario, {0., 0.1, 0.2, 0.3}, {}, {.step_fraction = 0.02});
    const auto uneven = simulate(network, scenario, {0.05, 0.3}, {}, {.step_fraction = 0.02});
    CHECK(uneven.motion.times == std::vector<double>{0.05, 0.3});
    CHECK(test::relative_difference(uneven.motion.positions[1], even.motion.positions[3]) < 1e-3);
    CHECK_THROWS_AS((void)simulate(network, scenario, {}), InvalidArgument);
    CHECK_THROWS_AS((void)simulate(network, scenario, {0., 0.}), InvalidArgument);
    CHECK_THROWS_AS((void)simulate(network, scenario, {-1., 0.}), InvalidArgument);
    CHECK_THROWS_AS((void)simulate(network, scenario, {0., std::nan("")}), InvalidArgument);
}

TEST_CASE("a case that cannot be simulated counts as 1 and says why, the others as they are") {
    const auto network = test::random_network<3, double>(0.001);
    auto set = cases<3, double>(network);
    auto wild = set.scenarios;
    wild[1].initial_velocities = Points<3, double>::Random(3, network.n_nodes()) * 1e170;
    const auto diverged = motion_error(network, wild, set.references);
    CHECK(diverged.status == Status::diverged);
    CHECK(diverged.case_statuses[0] == Status::converged);
    CHECK(diverged.case_statuses[1] != Status::converged);
    CHECK(diverged.case_statuses[2] == Status::converged);
    CHECK(diverged.case_errors[0] < 1e-10);
    CHECK(diverged.case_errors[1] == 1);
    CHECK(diverged.error > 0.1);
    CHECK(diverged.error < 1);

    // One mass on a string pulled across it has no equilibrium where the stiffness is 0.
    auto slack = network;
    slack.stiffness.setZero();
    const auto falling = motion_error(slack, set.scenarios, set.references);
    CHECK(falling.case_statuses[0] == Status::converged); // it falls, but it is a motion
    CHECK(falling.case_statuses[2] != Status::converged);
    CHECK(falling.case_errors[2] == 1);
    CHECK(std::isfinite(falling.error));
}

TEST_CASE("scoring that stops at a failure counts what comes after it as 1, in whatever order cases run") {
    const auto network = test::random_network<3, double>(0.001);
    auto set = cases<3, double>(network);
    set.scenarios[0].initial_velocities = Points<3, double>::Random(3, network.n_nodes()) * 1e170;
    const auto in_order = [](bool forwards) {
        return Execution([forwards](Index n, const Execution::Chunk& body) {
            for (Index c = 0; c < n; ++c) {
                body(forwards ? c : n - 1 - c);
            }
        });
    };
    for (const bool forwards : {true, false}) {
        const auto stopped = motion_error(network, set.scenarios, set.references, {},
                                          {.stop_at_failure = true, .execution = in_order(forwards)});
        CHECK(stopped.status == Status::diverged);
        CHECK(stopped.case_statuses == std::vector<Status>{Status::diverged, Status::interrupted, Status::converged});
        CHECK(stopped.case_errors[0] == 1);
        CHECK(stopped.case_errors[1] == 1);
        CHECK(stopped.case_errors[2] < 1e-10); // the equilibrium comes first
    }
    const auto fine = cases<3, double>(network);
    const auto full = motion_error(network, fine.scenarios, fine.references, {}, {.stop_at_failure = true});
    CHECK(full.status == Status::converged);
}

TEST_CASE("a motion too stiff for explicit steps is stepped implicitly, to nearly the same error") {
    const auto network = test::random_network<3, double>(0.001);
    const auto set = cases<3, double>(network);
    auto softer = network;
    softer.stiffness *= 0.9;
    const auto exact = motion_error(softer, set.scenarios, set.references);
    const auto implicit = motion_error(softer, set.scenarios, set.references, {},
                                       {.most_explicit_work = 0, .implicit_steps_per_frame = 40});
    CHECK(implicit.status == Status::converged);
    CHECK(test::relative(implicit.error, exact.error, exact.error) < 0.02);
    CHECK(implicit.error != exact.error);
    // Of second order in the step.
    const auto small_steps =
        simulate(network, set.scenarios[0], set.references[0].times, {}, {.step_fraction = 0.005}).motion;
    const auto error_of = [&](int steps) {
        return motion_error<3, double>(network, {set.scenarios[0]}, {small_steps}, {},
                                       {.most_explicit_work = 0, .implicit_steps_per_frame = steps})
            .error;
    };
    const double coarse = error_of(10);
    const double fine = error_of(20);
    CHECK(coarse / fine > 3);
    CHECK(coarse / fine < 5);
    auto stiff = network;
    stiff.stiffness *= 1e14; // hardly moves, and is scored
    CHECK(motion_error(stiff, set.scenarios, set.references).status == Status::converged);
    CHECK_THROWS_AS((void)motion_error(network, set.scenarios, set.references, {}, {.implicit_steps_per_frame = 0}),
                    InvalidArgument);
}

TEST_CASE("progress is told, and stops the scoring") {
    const auto network = test::random_network<2, double>(0.001);
    const auto set = cases<2, double>(network);
    double last = 0;
    int calls = 0;
    const auto full = motion_error(network, set.scenarios, set.references, [&](const Progress& progress) {
        CHECK(progress.fraction > last);
        last = progress.fraction;
        ++calls;
        return true;
    });
    CHECK(full.status == Status::converged);
    CHECK(last == 1);
    CHECK(calls == 23);
    int left = 5;
    const auto stopped =
        motion_error(network, set.scenarios, set.references, [&](const Progress&) { return --left > 0; });
    CHECK(stopped.status == Status::interrupted);
    CHECK(std::isfinite(stopped.error));
    CHECK(stopped.case_statuses[2] == Status::interrupted);
    left = 3;
    const auto cut =
        simulate(network, set.scenarios[0], set.references[0].times, [&](const Progress&) { return --left > 0; });
    CHECK(cut.status == Status::interrupted);
    CHECK(cut.motion.n_frames() == 3);
}

TEST_CASE("sets that do not fit together are refused") {
    const auto network = test::random_network<2, double>(0);
    auto set = cases<2, double>(network);
    auto fewer = set.scenarios;
    fewer.pop_back();
    CHECK_THROWS_AS((void)motion_error(network, fewer, set.references), InvalidArgument);
    set.references[0].rest_positions.conservativeResize(2, 3);
    CHECK_THROWS_AS((void)motion_error(network, set.scenarios, set.references), InvalidArgument);
}
