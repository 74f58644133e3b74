// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/motion/scenario.hpp>

namespace springfit {

/// What load cases need to know of a body.
template <int Dim, std::floating_point Scalar>
struct Specimen {
    Points<Dim, Scalar> rest_positions; ///< [Dim x n_nodes], m
    Values<Scalar> masses;              ///< [n_nodes], kg
    std::vector<int> surface;           ///< nodes that a hand can reach
    std::vector<Clamp<Dim, Scalar>> clamps;

    [[nodiscard]] Index n_nodes() const { return rest_positions.cols(); }
};

/// Throws InvalidArgument unless there is a finite position and a positive mass for every node, and surface and clamps
/// name nodes of the body.
template <int Dim, std::floating_point Scalar>
void validate(const Specimen<Dim, Scalar>& body) {
    require(body.n_nodes() > 0 && body.rest_positions.allFinite(), "body", "finite rest positions",
            text(body.n_nodes(), " nodes"));
    require(body.masses.size() == body.n_nodes(), "body", "one mass per node", body.masses.size());
    require(body.masses.allFinite() && body.masses.minCoeff() > 0, "body", "positive masses", body.masses.minCoeff());
    for (int node : body.surface) {
        require(node >= 0 && node < body.n_nodes(), "body", text("surface nodes in [0, ", body.n_nodes(), ")"), node);
    }
    Scenario<Dim, Scalar> held;
    held.clamps = body.clamps;
    (void)clamped_nodes(held, body.n_nodes());
}

} // namespace springfit
