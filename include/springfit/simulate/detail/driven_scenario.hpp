// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/motion/state.hpp>
#include <springfit/network/forces.hpp>

namespace springfit::detail {

/// The part of a scenario that changes in time; the rest is looked up once per frame.
template <int Dim, std::floating_point Scalar>
class DrivenScenario {
public:
    DrivenScenario(const Scenario<Dim, Scalar>& scenario, const Points<Dim, Scalar>& rest_positions)
        : m_scenario(scenario), m_rest_positions(rest_positions),
          m_clamped(clamped_nodes(scenario, rest_positions.cols())) {
        for (const auto& clamp : scenario.clamps) {
            m_clamps_move = m_clamps_move || static_cast<bool>(clamp.position);
        }
        for (const auto& gravity : scenario.gravity) {
            m_loads_vary = m_loads_vary || static_cast<bool>(gravity.amplitude);
        }
        for (const auto& load : scenario.loads) {
            m_loads_vary = m_loads_vary || static_cast<bool>(load.amplitude);
        }
    }

    [[nodiscard]] const std::vector<int>& clamped() const { return m_clamped; }
    [[nodiscard]] bool loads_vary() const { return m_loads_vary; }

    /// Gives the clamped nodes the velocity that takes them to where they must be at `time`, h from now:
    /// `set_velocity(node, v)`, where `position(node)` tells where they are.
    template <class Position, class SetVelocity>
    void aim_clamps(Scalar time, Scalar h, const Position& position, const SetVelocity& set_velocity) const {
        if (!m_clamps_move) {
            for (int node : m_clamped) {
                set_velocity(node, Vector<Dim, Scalar>(Vector<Dim, Scalar>::Zero()));
            }
            return;
        }
        for (const auto& clamp : m_scenario.clamps) {
            for (int node : clamp.nodes) {
                const Vector<Dim, Scalar> rest = m_rest_positions.col(node);
                const Vector<Dim, Scalar> goal = clamp.position ? clamp.position(rest, time) : rest;
                set_velocity(node, Vector<Dim, Scalar>((goal - position(node)) / h));
            }
        }
    }

private:
    const Scenario<Dim, Scalar>& m_scenario;
    const Points<Dim, Scalar>& m_rest_positions;
    std::vector<int> m_clamped;
    bool m_clamps_move = false;
    bool m_loads_vary = false;
};

template <int Dim, std::floating_point Scalar>
bool is_finite(const State<Dim, Scalar>& state) {
    return state.positions.allFinite() && state.velocities.allFinite() && state.accelerations.allFinite();
}

/// The state of a network (springs or others that `compute_accelerations` knows) at time 0; clamped nodes start without
/// acceleration.
template <int Dim, std::floating_point Scalar, class Network>
State<Dim, Scalar> start_network(const Network& network, const Scenario<Dim, Scalar>& scenario) {
    validate(scenario, network.n_nodes());
    State<Dim, Scalar> state;
    state.positions = initial_positions(scenario, network.rest_positions);
    state.velocities = initial_velocities(scenario, network.rest_positions);
    const Points<Dim, Scalar> external = external_forces<Dim, Scalar>(scenario, network.mass, Scalar(0));
    compute_accelerations<Dim, Scalar>(network, state.positions, state.velocities, external, state.accelerations);
    for (int node : clamped_nodes(scenario, network.n_nodes())) {
        state.accelerations.col(node).setZero();
    }
    return state;
}

/// Sets the accelerations of a state from its positions and velocities; clamped nodes: change of velocity over time.
template <int Dim, std::floating_point Scalar, class Network>
void finish_frame(const Network& network, const Points<Dim, Scalar>& external, const std::vector<int>& clamped,
                  const State<Dim, Scalar>& before, State<Dim, Scalar>& state) {
    compute_accelerations<Dim, Scalar>(network, state.positions, state.velocities, external, state.accelerations);
    for (int node : clamped) {
        state.accelerations.col(node) =
            (state.velocities.col(node) - before.velocities.col(node)) / (state.time - before.time);
    }
}

/// A frame of one implicit step of a body, external forces and clamps taken at its end. Returns the step's status, with
/// the state as it was where `accepts(status)` is false or the state is not finite.
template <int Dim, std::floating_point Scalar, class Body, class Accepts>
[[nodiscard]] Status advance_body(const SpringNetwork<Dim, Scalar>& network, Body& body, State<Dim, Scalar>& state,
                                  const Scenario<Dim, Scalar>& scenario, Scalar dt, const Accepts& accepts) {
    const DrivenScenario<Dim, Scalar> driven(scenario, network.rest_positions);
    State<Dim, Scalar> next;
    next.time = state.time + dt;
    const Points<Dim, Scalar> external = external_forces<Dim, Scalar>(scenario, network.mass, next.time);
    body.write(state.positions, state.velocities);
    body.set_clamped(driven.clamped());
    body.set_external_forces(external);
    driven.aim_clamps(
        next.time, dt, [&](int node) { return body.position(node); },
        [&](int node, const Vector<Dim, Scalar>& velocity) { body.set_velocity(node, velocity); });
    const Status status = body.step(dt).status;
    if (!accepts(status)) {
        return status;
    }
    body.read(next.positions, next.velocities);
    apply_clamps<Dim, Scalar>(scenario, network.rest_positions, next.time, next.positions);
    finish_frame<Dim, Scalar>(network, external, driven.clamped(), state, next);
    if (!is_finite<Dim, Scalar>(next)) {
        return Status::diverged;
    }
    state = std::move(next);
    return status;
}

} // namespace springfit::detail
