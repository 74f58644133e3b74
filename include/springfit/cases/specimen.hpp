// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numeric>

#include <springfit/mesh/corner_mesh.hpp>
#include <springfit/mesh/topology.hpp>
#include <springfit/motion/scenario.hpp>
#include <springfit/network/masses.hpp>

namespace springfit {

/// A body to load and to record: what load cases need to know of it.
template <int Dim, std::floating_point Scalar>
struct Specimen {
    Points<Dim, Scalar> rest_positions; ///< [Dim x n_nodes], m
    Values<Scalar> masses;              ///< [n_nodes], kg
    std::vector<int> surface;           ///< nodes that a hand can reach
    std::vector<Clamp<Dim, Scalar>> clamps{};
    NodePairs edges{}; ///< pairs of nodes whose strain counts `[2 x n]`; needed for equilibria alone

    [[nodiscard]] Index n_nodes() const { return rest_positions.cols(); }

    /// Diagonal of its bounding box, m.
    [[nodiscard]] Scalar size() const {
        return (rest_positions.rowwise().maxCoeff() - rest_positions.rowwise().minCoeff()).norm();
    }
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

/// A mesh of density rho, kg/m^3, as a specimen without clamps, by its corners: a hand reaches the surface of a solid
/// and every node of a plane body or membrane, whose thickness h, m, counts. Throws InvalidArgument where `node_masses`
/// does. O(cells log cells).
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] Specimen<Dim, Scalar> specimen_of(const Mesh<Dim, Scalar, Cell>& mesh, double density,
                                                double thickness = 1) {
    const auto corners = corner_mesh(mesh);
    Specimen<Dim, Scalar> specimen{.rest_positions = corners.nodes,
                                   .masses = node_masses(corners, density, thickness),
                                   .surface = {},
                                   .clamps = {},
                                   .edges = edges(corners)};
    if constexpr (Cell::dimension == 3) {
        specimen.surface = boundary_nodes(corners);
    } else {
        specimen.surface.resize(static_cast<std::size_t>(specimen.n_nodes()));
        std::iota(specimen.surface.begin(), specimen.surface.end(), 0);
    }
    return specimen;
}

} // namespace springfit
