// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <springfit/core/error.hpp>
#include <springfit/core/types.hpp>

namespace springfit {

/// Point masses joined by springs with axial damping.
///
/// With r = x_j - x_i, L = |r|, n = r / L, spring e = (i, j) pulls node i with
///     k_e (L - l_e) n + c_e ((v_j - v_i) . n) n
/// and node j with the opposite. In the plane, k is the stiffness of the whole thickness.
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
struct SpringNetwork {
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    Points<Dim, Scalar> rest_positions; ///< [Dim x n_nodes], m
    NodePairs springs;                  ///< the two ends of each spring [2 x n_springs]
    Values<Scalar> stiffness;           ///< k_e >= 0 [n_springs], N/m
    Values<Scalar> rest_length;         ///< l_e > 0 [n_springs], m
    Values<Scalar> damping;             ///< c_e >= 0 [n_springs], N s/m
    Values<Scalar> mass;                ///< m_i > 0 [n_nodes], kg

    [[nodiscard]] Index n_nodes() const { return rest_positions.cols(); }
    [[nodiscard]] Index n_springs() const { return springs.cols(); }
};

/// Throws InvalidArgument unless all sizes agree, the ends are two different nodes, and values are finite and in range.
template <int Dim, std::floating_point Scalar>
void validate(const SpringNetwork<Dim, Scalar>& network) {
    const Index nodes = network.n_nodes();
    const Index springs = network.n_springs();
    require(network.mass.size() == nodes, "mass", text(nodes, " values, one per node"), network.mass.size());
    const auto check_springs = [&](const Values<Scalar>& values, std::string_view name, bool positive) {
        require(values.size() == springs, name, text(springs, " values, one per spring"), values.size());
        for (Index e = 0; e < springs; ++e) {
            const bool accepted = positive ? values(e) > 0 : values(e) >= 0;
            if (!(accepted && std::isfinite(values(e)))) {
                throw InvalidArgument(name, positive ? "positive values" : "values not below 0",
                                      text(values(e), " at spring ", e));
            }
        }
    };
    check_springs(network.stiffness, "stiffness", false);
    check_springs(network.rest_length, "rest_length", true);
    check_springs(network.damping, "damping", false);
    for (Index i = 0; i < nodes; ++i) {
        if (!(network.mass(i) > 0 && std::isfinite(network.mass(i)))) {
            throw InvalidArgument("mass", "positive values", text(network.mass(i), " at node ", i));
        }
        if (!network.rest_positions.col(i).allFinite()) {
            throw InvalidArgument("rest_positions", "finite coordinates", text("node ", i));
        }
    }
    for (Index e = 0; e < springs; ++e) {
        const int i = network.springs(0, e);
        const int j = network.springs(1, e);
        if (!(i >= 0 && j >= 0 && i < nodes && j < nodes)) {
            throw InvalidArgument("springs", text("node numbers in [0, ", nodes, ")"),
                                  text("spring ", e, " from ", i, " to ", j));
        }
        if (i == j) {
            throw InvalidArgument("springs", "two different ends", text("spring ", e, " from ", i, " to ", j));
        }
    }
}

} // namespace springfit
