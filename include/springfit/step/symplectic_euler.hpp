// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/motion/state.hpp>
#include <springfit/network/forces.hpp>
#include <springfit/step/detail/driven_scenario.hpp>
#include <springfit/step/spring_body.hpp>
#include <springfit/step/stable_step.hpp>

namespace springfit {

template <std::floating_point Scalar>
struct SymplecticEulerOptions {
    Scalar step_fraction = Scalar(0.5); ///< sub-step as a fraction of the stable step, in (0, 1)
    int max_substeps = 2000;            ///< most sub-steps in one call of `advance`; more end it with `iteration_limit`
};

/// Explicit stepper: `advance` takes equal sub-steps of symplectic Euler below the stable step; with cells, whose share
/// in it grows with the deformation, below that of the positions at the start of the call where it is the shorter one.
///
/// Velocities run half a sub-step ahead of positions within a call and are brought back to the same time at its end
/// (the leap-frog form), so positions and velocities of a frame are second order in the sub-step where there is no
/// damping, momentum is kept to rounding, and energy does not drift. Damping acts at the velocity half a sub-step
/// earlier. `state.accelerations` is the network's own at the frame's positions and velocities; at clamped nodes it is
/// the change of their velocity over the call. Clamped nodes go where the scenario says at every sub-step, with
/// velocity by differencing over the sub-step.
///
/// A state that is not finite is undone: `diverged`. Model of `Stepper`.
template <int Dim, std::floating_point ScalarType>
class SymplecticEuler {
public:
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    /// Throws InvalidArgument for a network or an option that cannot be used.
    explicit SymplecticEuler(SpringNetwork<Dim, Scalar> network, const SymplecticEulerOptions<Scalar>& options = {})
        : m_network(std::move(network)), m_options(options), m_body(m_network) {
        require(options.step_fraction > 0 && options.step_fraction < 1, "step_fraction", "a value in (0, 1)",
                options.step_fraction);
        require(options.max_substeps > 0, "max_substeps", "at least one", options.max_substeps);
        m_longest_substep = options.step_fraction * stable_step(m_network);
    }

    [[nodiscard]] const SpringNetwork<Dim, Scalar>& network() const { return m_network; }
    [[nodiscard]] const Points<Dim, Scalar>& rest_positions() const { return m_network.rest_positions; }
    [[nodiscard]] const Values<Scalar>& masses() const { return m_network.mass; }

    /// Sub-steps that `advance` takes for a step of dt about the rest positions; more than an int holds reads as the
    /// largest int.
    [[nodiscard]] int n_substeps(Scalar dt) const { return n_substeps(dt, m_longest_substep); }

    [[nodiscard]] State<Dim, Scalar> start(const Scenario<Dim, Scalar>& scenario) const {
        return detail::start_network<Dim, Scalar>(m_network, scenario);
    }

    [[nodiscard]] Status advance(State<Dim, Scalar>& state, const Scenario<Dim, Scalar>& scenario, Scalar dt) {
        require(dt > 0 && std::isfinite(dt), "dt", "a positive time step", dt);
        Scalar longest = m_longest_substep;
        if (m_network.n_cells() > 0) {
            longest =
                std::min(longest, m_options.step_fraction * stable_step_at<Dim, Scalar>(m_network, state.positions));
        }
        const int substeps = n_substeps(dt, longest);
        if (substeps > m_options.max_substeps) {
            return Status::iteration_limit;
        }
        m_before = state;
        const Scalar h = dt / static_cast<Scalar>(substeps);
        const detail::DrivenScenario<Dim, Scalar> driven(scenario, m_network.rest_positions);
        m_external = external_forces<Dim, Scalar>(scenario, m_network.mass, state.time);

        m_body.set_clamped(driven.clamped());
        m_body.set_external_forces(m_external);
        state.velocities += (h / 2) * state.accelerations;
        m_body.write(state.positions, state.velocities);
        for (int s = 1; s <= substeps; ++s) {
            const Scalar time = state.time + dt * static_cast<Scalar>(s) / static_cast<Scalar>(substeps);
            driven.aim_clamps(
                time, h, [&](int node) { return m_body.position(node); },
                [&](int node, const Vector<Dim, Scalar>& velocity) { m_body.set_velocity(node, velocity); });
            if (s == 1) {
                m_body.drift(h);
            } else {
                m_body.step(h);
            }
            if (driven.loads_vary()) {
                m_external = external_forces<Dim, Scalar>(scenario, m_network.mass, time);
                m_body.set_external_forces(m_external);
            }
        }
        m_body.kick(h / 2);
        m_body.read(state.positions, state.velocities);
        state.time += dt;
        apply_clamps<Dim, Scalar>(scenario, m_network.rest_positions, state.time, state.positions);
        detail::finish_frame<Dim, Scalar>(m_network, m_external, driven.clamped(), m_before, state);
        if (!detail::is_finite<Dim, Scalar>(state)) {
            state = m_before;
            return Status::diverged;
        }
        return Status::converged;
    }

private:
    [[nodiscard]] static int n_substeps(Scalar dt, Scalar longest) {
        const Scalar count = std::ceil(dt / longest);
        constexpr int most = std::numeric_limits<int>::max();
        return count < static_cast<Scalar>(most) ? std::max(1, static_cast<int>(count)) : most;
    }

    SpringNetwork<Dim, Scalar> m_network;
    SymplecticEulerOptions<Scalar> m_options;
    Scalar m_longest_substep;
    SpringBody<Dim, Scalar> m_body;
    Points<Dim, Scalar> m_external;
    State<Dim, Scalar> m_before;
};

/// The stepper with which a network is recorded. Makes `SpringNetwork` a model of `Reference`.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] SymplecticEuler<Dim, Scalar> make_stepper(const SpringNetwork<Dim, Scalar>& network) {
    return SymplecticEuler<Dim, Scalar>(network);
}

} // namespace springfit
