// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/network/biquadratic_forces.hpp>
#include <springfit/network/forces.hpp>

/// What the equilibria of a network need to know of it: how well its energy and forces are known, and its size.
namespace springfit::detail {

/// The sum of the magnitudes that the elastic energy adds and takes away at positions `[Dim x n_nodes]`, J.
template <int Dim, std::floating_point Scalar>
Scalar energy_terms(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions) {
    Scalar terms = 0;
    for (Index e = 0; e < network.n_springs(); ++e) {
        const SpringVector<Dim, Scalar> spring(network.springs, e, positions);
        const Scalar tension = network.stiffness(e) * std::abs(spring.length - network.rest_length(e));
        terms += tension * (spring.length + network.rest_length(e));
    }
    for (Index c = 0; c < network.n_cells(); ++c) {
        const VolumeCell<Dim, Scalar> cell(network, c, positions);
        const SimplexCorners<Dim, Scalar> sides = cell.corners.colwise() - cell.corners.col(0);
        const Scalar size = cell.gradient().colwise().norm().dot(sides.colwise().norm()); // of the sums in V
        terms += std::abs(network.volume_stiffness(c) * cell.dilation) * (size + network.rest_volume(c));
    }
    return terms;
}

/// Each D is a difference of squares.
template <int Dim, std::floating_point Scalar>
Scalar energy_terms(const BiquadraticNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions) {
    Scalar terms = 0;
    for (Index t = 0; t < network.n_triangles(); ++t) {
        const BiquadraticTriangle<Dim, Scalar> triangle(network, t, positions);
        terms += (triangle.s.cwiseAbs() * triangle.change.cwiseAbs()).dot(triangle.lengths2);
    }
    return terms;
}

/// A bound on the stiffness that a node meets at positions `[Dim x n_nodes]`, the largest of all nodes, N/m.
template <int Dim, std::floating_point Scalar>
Scalar largest_stiffness(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions) {
    Values<Scalar> stiffness = Values<Scalar>::Zero(network.n_nodes());
    for (Index e = 0; e < network.n_springs(); ++e) {
        const Scalar value = network.stiffness(e);
        stiffness(network.springs(0, e)) += value;
        stiffness(network.springs(1, e)) += value;
    }
    for (Index c = 0; c < network.n_cells(); ++c) {
        const VolumeCell<Dim, Scalar> cell(network, c, positions);
        const Scalar kappa = std::abs(network.volume_stiffness(c));
        const auto slopes = cell.gradient().colwise().norm().eval();
        const auto curvature = cell.curvature();
        for (int a = 0; a <= Dim; ++a) {
            stiffness(network.cells(a, c)) +=
                kappa * (slopes(a) * slopes.sum() / network.rest_volume(c) + std::abs(cell.dilation) * curvature(a));
        }
    }
    return stiffness.maxCoeff();
}

template <int Dim, std::floating_point Scalar>
Scalar largest_stiffness(const BiquadraticNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions) {
    Values<Scalar> stiffness = Values<Scalar>::Zero(network.n_nodes());
    for (Index t = 0; t < network.n_triangles(); ++t) {
        const BiquadraticTriangle<Dim, Scalar> triangle(network, t, positions);
        const Vector<3, Scalar> weights = triangle.axial_bounds();
        for (int i = 0; i < 3; ++i) {
            stiffness(triangle.nodes(i)) += weights((i + 1) % 3) + weights((i + 2) % 3);
        }
    }
    return stiffness.maxCoeff();
}

/// The pairs of nodes by which the rotation of a node's surroundings is found `[2 x n_pairs]`.
template <int Dim, std::floating_point Scalar>
const NodePairs& neighbours(const SpringNetwork<Dim, Scalar>& network) {
    return network.springs;
}

template <int Dim, std::floating_point Scalar>
NodePairs neighbours(const BiquadraticNetwork<Dim, Scalar>& network) {
    NodePairs pairs(2, 3 * network.n_triangles());
    for (Index t = 0; t < network.n_triangles(); ++t) {
        for (int i = 0; i < 3; ++i) {
            pairs.col(3 * t + i) << network.triangles(i, t), network.triangles((i + 1) % 3, t);
        }
    }
    return pairs;
}

} // namespace springfit::detail
