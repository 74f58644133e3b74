// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include <springfit/motion/state.hpp>

namespace springfit {

/// Any program as a reference: a callable that moves a state on by one step.
///
///     UserReference<3, double> reference{rest, masses, [&](auto& state, const auto& scenario, double dt) {
///         ...                       // set state.positions, .velocities, .accelerations at state.time + dt
///         return Status::converged;
///     }};
///
/// It is its own stepper: time is advanced for the callable, and the start is the scenario's, with zero acceleration
/// unless `initial_accelerations` gives one.
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
struct UserReference {
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;
    using Advance = std::function<Status(State<Dim, Scalar>&, const Scenario<Dim, Scalar>&, Scalar dt)>;

    Points<Dim, Scalar> rest;   ///< [Dim x n_nodes], m
    Values<Scalar> node_masses; ///< [n_nodes], kg
    Advance advance_state;
    std::function<Points<Dim, Scalar>(const State<Dim, Scalar>&, const Scenario<Dim, Scalar>&)> initial_accelerations{};

    [[nodiscard]] const Points<Dim, Scalar>& rest_positions() const { return rest; }
    [[nodiscard]] const Values<Scalar>& masses() const { return node_masses; }

    [[nodiscard]] State<Dim, Scalar> start(const Scenario<Dim, Scalar>& scenario) const {
        State<Dim, Scalar> state;
        state.positions = initial_positions(scenario, rest);
        state.velocities = initial_velocities(scenario, rest);
        state.accelerations.setZero(Dim, rest.cols());
        if (initial_accelerations) {
            state.accelerations = initial_accelerations(state, scenario);
        }
        return state;
    }

    Status advance(State<Dim, Scalar>& state, const Scenario<Dim, Scalar>& scenario, Scalar dt) {
        const Status status = advance_state(state, scenario, dt);
        if (status == Status::converged) {
            state.time += dt;
        }
        return status;
    }
};

template <int Dim, std::floating_point Scalar>
[[nodiscard]] UserReference<Dim, Scalar> make_stepper(const UserReference<Dim, Scalar>& reference) {
    return reference;
}

} // namespace springfit
