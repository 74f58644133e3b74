// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/motion/record.hpp>
#include <springfit/motion/user_reference.hpp>

using namespace springfit;
using test::rounding;

namespace {

/// Free fall: exact for any step. Clamped nodes follow their clamps.
template <int Dim, class Scalar>
UserReference<Dim, Scalar> falling(Index n_nodes) {
    const auto accelerations = [](const auto& state, const auto& scenario) {
        Points<Dim, Scalar> a = Points<Dim, Scalar>::Zero(Dim, state.positions.cols());
        for (const auto& gravity : scenario.gravity) {
            a.colwise() += gravity.acceleration;
        }
        for (int node : clamped_nodes(scenario, a.cols())) {
            a.col(node).setZero();
        }
        return a;
    };
    const Points<Dim, Scalar> rest = Points<Dim, Scalar>::Random(Dim, n_nodes);
    return {rest, Values<Scalar>::LinSpaced(n_nodes, 1, 2),
            [=](State<Dim, Scalar>& state, const Scenario<Dim, Scalar>& scenario, Scalar dt) {
                state.accelerations = accelerations(state, scenario);
                state.positions += dt * state.velocities + dt * dt / 2 * state.accelerations;
                state.velocities += dt * state.accelerations;
                apply_clamps(scenario, rest, state.time + dt, state.positions);
                return Status::converged;
            },
            accelerations};
}

template <int Dim, class Scalar>
Scenario<Dim, Scalar> drop() {
    Scenario<Dim, Scalar> scenario;
    scenario.name = "drop";
    scenario.gravity.push_back({-Scalar(10) * Vector<Dim, Scalar>::Unit(Dim - 1), {}});
    scenario.clamps.push_back({{2}, {}});
    scenario.initial_velocities = Points<Dim, Scalar>::Ones(Dim, 4);
    return scenario;
}

} // namespace

TEST_CASE_TEMPLATE("a recording holds the frames of the motion", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    static_assert(Reference<UserReference<dim, Scalar>>);
    const auto reference = falling<dim, Scalar>(4);
    const auto scenario = drop<dim, Scalar>();
    for (const int steps : {1, 4}) {
        const auto [motion, status] =
            record(reference, scenario, {.dt = Scalar(0.125), .frames = 9, .steps_per_frame = steps});
        CHECK(status == Status::converged);
        CHECK(motion.name == "drop");
        CHECK(motion.n_frames() == 9);
        CHECK(motion.rest_positions == reference.rest);
        CHECK(motion.clamped == std::vector<int>{2});
        CHECK_NOTHROW(validate(motion));
        for (std::size_t t = 0; t < 9; ++t) {
            const Scalar time = Scalar(0.125) * static_cast<Scalar>(t);
            CHECK(test::relative(motion.times[t], time, Scalar(1)) < rounding<Scalar>());
            Points<dim, Scalar> expected = motion.rest_positions;
            for (const Index free : {0, 1, 3}) {
                expected.col(free) +=
                    time * Vector<dim, Scalar>::Ones() + time * time / 2 * scenario.gravity[0].acceleration;
            }
            CHECK(test::relative_difference(motion.positions[t], expected) < rounding<Scalar>());
            CHECK(motion.accelerations[t].col(0) == scenario.gravity[0].acceleration);
            CHECK(motion.accelerations[t].col(2).norm() == 0);
            CHECK(motion.velocities[t].col(2).norm() == 0);
            CHECK(test::relative(motion.external_forces[t](dim - 1, 3), Scalar(-20), Scalar(20)) < rounding<Scalar>());
        }
    }
}

TEST_CASE("one frame is the start alone") {
    const auto recording = record(falling<3, double>(4), drop<3, double>(), {.frames = 1});
    CHECK(recording.motion.n_frames() == 1);
    CHECK(recording.motion.times[0] == 0);
    CHECK(recording.status == Status::converged);
}

TEST_CASE("the caller may stop a recording and keeps the frames so far") {
    std::vector<double> fractions;
    const auto recording = record(falling<2, double>(4), drop<2, double>(),
                                  {.dt = 0.1, .frames = 10, .steps_per_frame = 2, .progress = [&](const Progress& p) {
                                       CHECK(p.stage == "record");
                                       fractions.push_back(p.fraction);
                                       return fractions.size() < 3;
                                   }});
    CHECK(recording.status == Status::interrupted);
    CHECK(recording.motion.n_frames() == 2); // it was asked at the first, half-way to the second, and there
    CHECK_NOTHROW(validate(recording.motion));
    CHECK(fractions == std::vector<double>{0.1, 0.15, 0.2});
}

TEST_CASE("a reference that cannot go on ends the recording with its status") {
    auto reference = falling<2, double>(4);
    const auto fall = reference.advance_state;
    for (const Status end : {Status::diverged, Status::failed, Status::iteration_limit}) {
        reference.advance_state = [&](State<2, double>& state, const Scenario<2, double>& scenario, double dt) {
            return state.time > 0.25 ? end : fall(state, scenario, dt);
        };
        const auto recording = record(reference, drop<2, double>(), {.dt = 0.1, .frames = 10});
        CHECK(recording.status == end);
        CHECK(recording.motion.n_frames() == 4); // 0, 0.1, 0.2, 0.3
        CHECK_NOTHROW(validate(recording.motion));
    }
}

TEST_CASE("a reference that comes to what is not finite ends the recording with the frames before") {
    const auto good = falling<2, double>(4);
    for (Points<2, double> State<2, double>::* array :
         {&State<2, double>::positions, &State<2, double>::velocities, &State<2, double>::accelerations}) {
        for (const double wrong : {std::nan(""), double(INFINITY)}) {
            auto reference = good;
            reference.advance_state = [&](State<2, double>& state, const Scenario<2, double>& scenario, double dt) {
                const Status status = good.advance_state(state, scenario, dt);
                if (state.time > 0.25) {
                    (state.*array)(1, 3) = wrong;
                }
                return status;
            };
            for (const int steps : {1, 3}) {
                const auto recording =
                    record(reference, drop<2, double>(), {.dt = 0.1, .frames = 10, .steps_per_frame = steps});
                CHECK(recording.status == Status::diverged);
                CHECK(recording.motion.n_frames() == (steps == 1 ? 4 : 3)); // up to 0.3, or to 0.2
                CHECK_NOTHROW(validate(recording.motion));
            }
        }
    }
    auto reference = good;
    reference.initial_accelerations = [](const auto& state, const auto&) {
        return Points<2, double>::Constant(2, state.positions.cols(), std::nan("")).eval();
    };
    const auto recording = record(reference, drop<2, double>(), {});
    CHECK(recording.status == Status::diverged);
    CHECK(recording.motion.n_frames() == 0);
    reference = good;
    reference.node_masses(3) = std::nan(""); // and with it a node's weight
    CHECK(record(reference, drop<2, double>(), {}).status == Status::diverged);
}

TEST_CASE("a reference that gives arrays of another size is refused by name") {
    const auto good = falling<3, double>(4);
    const auto refused = [](const UserReference<3, double>& reference, const char* message) {
        CHECK_THROWS_WITH_AS((void)record(reference, drop<3, double>(), {}), message, InvalidArgument);
    };
    auto reference = good;
    reference.advance_state = [&](State<3, double>& state, const Scenario<3, double>& scenario, double dt) {
        const Status status = good.advance_state(state, scenario, dt);
        state.positions.conservativeResize(3, state.time > 0.025 ? 5 : 4);
        return status;
    };
    refused(reference, "reference: expected positions [3 x 4], found [3 x 5]");
    reference.advance_state = [](State<3, double>& state, const Scenario<3, double>&, double) {
        state.velocities.resize(3, 0);
        return Status::converged;
    };
    refused(reference, "reference: expected velocities [3 x 4], found [3 x 0]");
    reference = good;
    reference.initial_accelerations = [](const auto&, const auto&) { return Points<3, double>::Zero(3, 3).eval(); };
    refused(reference, "reference: expected accelerations [3 x 4], found [3 x 3]");
    reference = good;
    reference.node_masses.conservativeResize(3);
    refused(reference, "reference: expected 4 masses, one per node, found 3");
}

TEST_CASE("options and scenarios that do not fit are refused by name") {
    const auto reference = falling<3, double>(4);
    const auto scenario = drop<3, double>();
    for (const double dt : {0., -1., std::nan(""), double(INFINITY)}) {
        CHECK_THROWS_AS((void)record(reference, scenario, {.dt = dt}), InvalidArgument);
    }
    CHECK_THROWS_WITH_AS((void)record(reference, scenario, {.frames = 0}),
                         "frames: expected at least one frame, found 0", InvalidArgument);
    CHECK_THROWS_WITH_AS((void)record(reference, scenario, {.steps_per_frame = 0}),
                         "steps_per_frame: expected at least one step, found 0", InvalidArgument);
    auto wrong = scenario;
    wrong.clamps[0].nodes = {4};
    CHECK_THROWS_AS((void)record(reference, wrong, {}), InvalidArgument);
    wrong = scenario;
    wrong.initial_velocities.setZero(3, 5);
    CHECK_THROWS_AS((void)record(reference, wrong, {}), InvalidArgument);
}

TEST_CASE("a motion with a hole in it is refused") {
    auto motion = record(falling<2, double>(4), drop<2, double>(), {.frames = 3}).motion;
    auto broken = motion;
    broken.velocities.pop_back();
    CHECK_THROWS_WITH_AS(validate(broken), "velocities: expected 3 frames, found 2", InvalidArgument);
    broken = motion;
    broken.positions[1](0, 2) = std::nan("");
    CHECK_THROWS_AS(validate(broken), InvalidArgument);
    broken = motion;
    broken.times[2] = broken.times[1];
    CHECK_THROWS_AS(validate(broken), InvalidArgument);
    broken = motion;
    broken.external_forces[2].conservativeResize(2, 3);
    CHECK_THROWS_WITH_AS(validate(broken), "external_forces: expected 4 nodes, found 3 in frame 2", InvalidArgument);
}
