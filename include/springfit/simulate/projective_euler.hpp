// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/body/projective_body.hpp>
#include <springfit/motion/state.hpp>
#include <springfit/simulate/detail/driven_scenario.hpp>

namespace springfit {

/// Implicit Euler by the local-global scheme, as a stepper: a frame is one step of `ProjectiveBody`, external forces
/// and clamps taken at its end, and good however many iterations it has had. `state.accelerations` is the network's own
/// at the frame's positions and velocities. A state that is not finite is undone: `diverged`. Model of `Stepper`.
template <int Dim, std::floating_point ScalarType>
class ProjectiveEuler {
public:
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    /// Throws InvalidArgument for a network or an option that cannot be used.
    explicit ProjectiveEuler(SpringNetwork<Dim, Scalar> network, const ProjectiveBodyOptions<Scalar>& options = {},
                             const Execution& execution = {})
        : m_network(std::move(network)), m_body(m_network, options, execution) {}

    [[nodiscard]] const SpringNetwork<Dim, Scalar>& network() const { return m_network; }
    [[nodiscard]] const Points<Dim, Scalar>& rest_positions() const { return m_network.rest_positions; }
    [[nodiscard]] const Values<Scalar>& masses() const { return m_network.mass; }

    [[nodiscard]] State<Dim, Scalar> start(const Scenario<Dim, Scalar>& scenario) const {
        return detail::start_network<Dim, Scalar>(m_network, scenario);
    }

    [[nodiscard]] Status advance(State<Dim, Scalar>& state, const Scenario<Dim, Scalar>& scenario, Scalar dt);

private:
    SpringNetwork<Dim, Scalar> m_network;
    ProjectiveBody<Dim, Scalar> m_body;
};

} // namespace springfit

#include <springfit/simulate/detail/projective_euler_impl.hpp>
