// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include <springfit/simulate/detail/network_potential.hpp>
#include <springfit/solve/corotated_solver.hpp>

namespace springfit::detail {

/// Added to the diagonal of the Hessian, relative to its largest entry, where nothing may hold a node.
inline constexpr double statics_floor = 1e-9;

/// Shared by the equilibria of a network under the same clamps: the pattern of the stiffness and its factor at rest.
/// Immutable, so threads may share it. Keeps a reference to the network.
template <class Network>
class ClampedStiffness {
public:
    static constexpr int dimension = Network::dimension;
    using Scalar = typename Network::Scalar;

    ClampedStiffness(const Network& network, const std::vector<int>& clamped);

    [[nodiscard]] const Network& network() const { return m_network; }
    [[nodiscard]] const FreeNodes& free_nodes() const { return m_potential.free_nodes(); }
    /// To copy: its pattern is made, its forces are not set.
    [[nodiscard]] const NetworkPotential<Network>& potential() const { return m_potential; }
    /// Of the stiffness at rest; not usable where the network does not hold its rest shape.
    [[nodiscard]] const CorotatedPreconditioner<dimension, Scalar>& factor() const { return m_factor; }

private:
    const Network& m_network;
    NetworkPotential<Network> m_potential;
    CorotatedPreconditioner<dimension, Scalar> m_factor;
};

} // namespace springfit::detail

#include <springfit/simulate/detail/clamped_stiffness_impl.hpp>
