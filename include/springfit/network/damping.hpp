// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/network/spring_network.hpp>

namespace springfit {

/// Kelvin-Voigt damping c_e = beta k_e `[n_springs]`, N s/m: the network's share of the reference's D = beta K.
///
/// `beta` in s, >= 0. A mode of angular frequency omega gets the damping ratio beta omega / 2. Throws InvalidArgument.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Values<Scalar> stiffness_proportional_damping(const SpringNetwork<Dim, Scalar>& network, Scalar beta) {
    require(beta >= 0 && std::isfinite(beta), "beta", "a time not below 0", beta);
    return beta * network.stiffness;
}

/// The rule c_e = 2 zeta sqrt(k_e (m_i + m_j)) `[n_springs]`, N s/m (in wide use; its origin is not known to us).
///
/// `zeta` >= 0 is not the damping ratio: a spring alone between two free masses gets the ratio
/// zeta (m_i + m_j) / sqrt(m_i m_j), at least 2 zeta, so equal masses are critically damped at zeta = 1/2.
/// Throws InvalidArgument.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Values<Scalar> mass_stiffness_damping(const SpringNetwork<Dim, Scalar>& network, Scalar zeta) {
    require(zeta >= 0 && std::isfinite(zeta), "zeta", "a value not below 0", zeta);
    Values<Scalar> damping(network.n_springs());
    for (Index e = 0; e < network.n_springs(); ++e) {
        const Scalar masses = network.mass(network.springs(0, e)) + network.mass(network.springs(1, e));
        damping(e) = 2 * zeta * std::sqrt(network.stiffness(e) * masses);
    }
    return damping;
}

} // namespace springfit
