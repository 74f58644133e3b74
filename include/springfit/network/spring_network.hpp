// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <springfit/core/error.hpp>
#include <springfit/core/types.hpp>
#include <springfit/mesh/simplex.hpp>

namespace springfit {

/// Corners of simplices `[Dim + 1 x n_cells]`: triangles in the plane, tetrahedra in space, positively oriented.
template <int Dim>
using SimplexNodes = Eigen::Matrix<int, Dim + 1, Eigen::Dynamic>;

/// Point masses joined by springs with axial damping and, optionally, cells that resist a change of their volume.
///
/// With r = x_j - x_i, L = |r|, n = r / L, spring e = (i, j) pulls node i with
///     k_e (L - l_e) n + c_e ((v_j - v_i) . n) n
/// and node j with the opposite. Cell c has the energy 1/2 kappa_c (V - V_c)^2 / V_c, V its volume, in the plane its
/// area; a network without cells is one of springs alone. In the plane, k and kappa are of the whole thickness.
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

    SimplexNodes<Dim> cells;         ///< corners of the cells that hold their volume [Dim + 1 x n_cells]
    Values<Scalar> rest_volume;      ///< V_c > 0 [n_cells], m^3; in the plane m^2
    Values<Scalar> volume_stiffness; ///< kappa_c, of either sign [n_cells], Pa; in the plane N/m

    [[nodiscard]] Index n_nodes() const { return rest_positions.cols(); }
    [[nodiscard]] Index n_springs() const { return springs.cols(); }
    [[nodiscard]] Index n_cells() const { return cells.cols(); }
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
    const Index cells = network.n_cells();
    require(network.rest_volume.size() == cells, "rest_volume", text(cells, " values, one per cell"),
            network.rest_volume.size());
    require(network.volume_stiffness.size() == cells, "volume_stiffness", text(cells, " values, one per cell"),
            network.volume_stiffness.size());
    for (Index c = 0; c < cells; ++c) {
        if (!(network.rest_volume(c) > 0 && std::isfinite(network.rest_volume(c)))) {
            throw InvalidArgument("rest_volume", "positive values", text(network.rest_volume(c), " at cell ", c));
        }
        if (!std::isfinite(network.volume_stiffness(c))) {
            throw InvalidArgument("volume_stiffness", "finite values",
                                  text(network.volume_stiffness(c), " at cell ", c));
        }
        SimplexCorners<Dim, Scalar> corners;
        for (int a = 0; a <= Dim; ++a) {
            const int node = network.cells(a, c);
            require(node >= 0 && node < nodes, "cells", text("node numbers in [0, ", nodes, ")"),
                    text(node, " in cell ", c));
            for (int b = 0; b < a; ++b) {
                require(network.cells(b, c) != node, "cells", "different corners", text(node, " twice in cell ", c));
            }
            corners.col(a) = network.rest_positions.col(node);
        }
        if (!(signed_volume<Dim, Scalar>(corners) > 0)) {
            throw InvalidArgument("cells", "positively oriented corners",
                                  text("cell ", c, ", inverted or flat at rest"));
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
