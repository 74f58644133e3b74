// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/body/implicit_body.hpp>
#include <springfit/motion/state.hpp>
#include <springfit/network/forces.hpp>
#include <springfit/simulate/detail/driven_scenario.hpp>

namespace springfit {

template <std::floating_point Scalar>
struct ImplicitEulerOptions {
    Scalar tolerance = Scalar(1e-8); ///< largest unbalanced force relative to the largest force that moves a node, > 0;
                                     ///< rounding of the positions is the floor
    int max_iterations = 50;         ///< Newton iterations in a step, >= 1
};

/// Implicit Euler as a stepper: each step of h is the minimum of the incremental potential that `ImplicitBody`
/// describes, external forces and clamps taken at the end of the step. First order in h, stable at any h, and it damps
/// what it does not resolve. Linear solves are of the network's own precision. `state.accelerations` is the network's
/// own at the frame's positions and velocities.
///
/// `advance` returns Newton's status where it is not `converged`, with the state as it was. Model of `Stepper`.
template <int Dim, std::floating_point ScalarType>
class ImplicitEuler {
public:
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    /// Throws InvalidArgument for a network or an option that cannot be used.
    explicit ImplicitEuler(SpringNetwork<Dim, Scalar> network, const ImplicitEulerOptions<Scalar>& options = {},
                           const Execution& execution = {})
        : m_network(std::move(network)),
          m_body(m_network, {.max_iterations = options.max_iterations, .tolerance = options.tolerance}, execution) {}

    [[nodiscard]] const SpringNetwork<Dim, Scalar>& network() const { return m_network; }
    [[nodiscard]] const Points<Dim, Scalar>& rest_positions() const { return m_network.rest_positions; }
    [[nodiscard]] const Values<Scalar>& masses() const { return m_network.mass; }

    [[nodiscard]] State<Dim, Scalar> start(const Scenario<Dim, Scalar>& scenario) const {
        return detail::start_network<Dim, Scalar>(m_network, scenario);
    }

    [[nodiscard]] Status advance(State<Dim, Scalar>& state, const Scenario<Dim, Scalar>& scenario, Scalar dt);

private:
    SpringNetwork<Dim, Scalar> m_network;
    ImplicitBody<Dim, Scalar, Scalar> m_body;
};

} // namespace springfit

#include <springfit/simulate/detail/implicit_euler_impl.hpp>
