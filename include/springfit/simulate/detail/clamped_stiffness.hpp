// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include <springfit/simulate/detail/spring_potential.hpp>
#include <springfit/solve/corotated_solver.hpp>

namespace springfit::detail {

/// Added to the diagonal of the Hessian, relative to its largest entry, where no spring may hold a node.
inline constexpr double statics_floor = 1e-9;

/// Shared by the equilibria of a network under the same clamps: the pattern of the stiffness and its factor at rest.
/// Immutable, so threads may share it. Keeps a reference to the network.
template <int Dim, std::floating_point Scalar>
class ClampedStiffness {
public:
    ClampedStiffness(const SpringNetwork<Dim, Scalar>& network, const std::vector<int>& clamped);

    [[nodiscard]] const SpringNetwork<Dim, Scalar>& network() const { return m_network; }
    [[nodiscard]] const FreeNodes& free_nodes() const { return m_potential.free_nodes(); }
    /// To copy: its pattern is made, its forces are not set.
    [[nodiscard]] const SpringPotential<Dim, Scalar>& potential() const { return m_potential; }
    /// Of the stiffness at rest; not usable where the springs do not hold the rest shape.
    [[nodiscard]] const CorotatedPreconditioner<Dim, Scalar>& factor() const { return m_factor; }

private:
    const SpringNetwork<Dim, Scalar>& m_network;
    SpringPotential<Dim, Scalar> m_potential;
    CorotatedPreconditioner<Dim, Scalar> m_factor;
};

} // namespace springfit::detail

#include <springfit/simulate/detail/clamped_stiffness_impl.hpp>
