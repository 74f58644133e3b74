// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/body/spring_body.hpp>
#include <springfit/motion/state.hpp>
#include <springfit/network/forces.hpp>
#include <springfit/simulate/detail/driven_scenario.hpp>
#include <springfit/simulate/stable_step.hpp>

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
    explicit SymplecticEuler(SpringNetwork<Dim, Scalar> network, const SymplecticEulerOptions<Scalar>& options = {});

    [[nodiscard]] const SpringNetwork<Dim, Scalar>& network() const { return m_network; }
    [[nodiscard]] const Points<Dim, Scalar>& rest_positions() const { return m_network.rest_positions; }
    [[nodiscard]] const Values<Scalar>& masses() const { return m_network.mass; }

    /// Sub-steps that `advance` takes for a step of dt about the rest positions; more than an int holds reads as the
    /// largest int.
    [[nodiscard]] int n_substeps(Scalar dt) const { return n_substeps(dt, m_longest_substep); }

    [[nodiscard]] State<Dim, Scalar> start(const Scenario<Dim, Scalar>& scenario) const {
        return detail::start_network<Dim, Scalar>(m_network, scenario);
    }

    [[nodiscard]] Status advance(State<Dim, Scalar>& state, const Scenario<Dim, Scalar>& scenario, Scalar dt);

private:
    [[nodiscard]] static int n_substeps(Scalar dt, Scalar longest);

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

#include <springfit/simulate/detail/symplectic_euler_impl.hpp>
