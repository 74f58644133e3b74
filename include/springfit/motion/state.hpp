// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/status.hpp>
#include <springfit/motion/scenario.hpp>

namespace springfit {

/// The state of a body at one time.
template <int Dim, std::floating_point Scalar>
struct State {
    Scalar time = 0;                   ///< s
    Points<Dim, Scalar> positions;     ///< [Dim x n_nodes], m
    Points<Dim, Scalar> velocities;    ///< [Dim x n_nodes], m/s
    Points<Dim, Scalar> accelerations; ///< [Dim x n_nodes], m/s^2, at this very position and velocity
};

/// Positions at time 0: the scenario's or the rest positions, with the clamps applied `[Dim x n_nodes]`, m.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Points<Dim, Scalar> initial_positions(const Scenario<Dim, Scalar>& scenario,
                                                    const Points<Dim, Scalar>& rest_positions) {
    Points<Dim, Scalar> positions = scenario.initial_positions.size() > 0 ? scenario.initial_positions : rest_positions;
    apply_clamps(scenario, rest_positions, Scalar(0), positions);
    return positions;
}

/// Velocities at time 0: the scenario's or zero, and zero at clamped nodes `[Dim x n_nodes]`, m/s.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Points<Dim, Scalar> initial_velocities(const Scenario<Dim, Scalar>& scenario,
                                                     const Points<Dim, Scalar>& rest_positions) {
    Points<Dim, Scalar> velocities = Points<Dim, Scalar>::Zero(Dim, rest_positions.cols());
    if (scenario.initial_velocities.size() > 0) {
        velocities = scenario.initial_velocities;
    }
    for (int node : clamped_nodes(scenario, rest_positions.cols())) {
        velocities.col(node).setZero();
    }
    return velocities;
}

/// Carries a body through time under a scenario: an FEM integrator, a step of a spring network, a recorded program.
///
/// `start` returns the state at time 0 with its acceleration; `advance` moves it on by `dt` and returns `converged`, or
/// says why it could not (the state is then the last good one).
template <class S>
concept Stepper = requires(S stepper, const Scenario<S::dimension, typename S::Scalar>& scenario,
                           State<S::dimension, typename S::Scalar>& state, typename S::Scalar dt) {
    { stepper.rest_positions() } -> std::convertible_to<Points<S::dimension, typename S::Scalar>>;
    { stepper.masses() } -> std::convertible_to<Values<typename S::Scalar>>;
    { stepper.start(scenario) } -> std::same_as<State<S::dimension, typename S::Scalar>>;
    { stepper.advance(state, scenario, dt) } -> std::same_as<Status>;
};

/// A model whose motion can be recorded: `make_stepper(model)` gives the stepper that moves it.
///
/// Models of the concept: `fem::Model`, `SpringNetwork`, `BiquadraticNetwork`, and `UserReference` for any callable.
template <class R>
concept Reference = requires(const R& reference) {
    { make_stepper(reference) } -> Stepper;
};

} // namespace springfit
