// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fem/model.hpp>

#include "trial.hpp"

/// What the parts in space share.
namespace study {

inline constexpr double young = 5e4;
inline constexpr double density = 1000;
inline constexpr std::array<double, 3> box_size{0.8, 0.3, 0.3};

/// Which springs and cells a network of tetrahedra has.
struct NetworkKind {
    bool second_ring = false;
    bool volume = false;
};

[[nodiscard]] inline std::string name_of(const NetworkKind& kind) {
    return std::string("edges") + (kind.second_ring ? ", second ring" : "") + (kind.volume ? ", volume" : "");
}

/// Clamped at the lowest side along an axis.
template <CellType Cell>
[[nodiscard]] Body<3, double> body_of(const Mesh<3, double, Cell>& mesh, const Values<double>& masses, int axis = 0) {
    Body<3, double> body{mesh.nodes, masses, boundary_nodes(mesh), {}};
    body.clamps = {{side_nodes<3, double>(mesh.nodes, {axis, false}, axis == 0 ? 0.02 : 0.05), {}}};
    return body;
}

/// Finite elements that do not lock.
[[nodiscard]] inline fem::ModelOptions<double> model_options(double poisson) {
    fem::ModelOptions<double> options;
    options.dilatation = poisson >= 0.45 ? fem::Dilatation::mean : fem::Dilatation::pointwise;
    return options;
}

/// Sets of a tetrahedral body of the linear material, clamped at x = 0.
[[nodiscard]] CaseSets<3> linear_sets(const Mesh<3, double, Tet4>& mesh, double poisson, const CaseSettings& cases,
                                      const Settings& settings);

/// A network of tetrahedra with the closed form's values, as the prior of a fit.
[[nodiscard]] inline SpringNetwork<3, double> prior_network(const Mesh<3, double, Tet4>& mesh, double poisson,
                                                            const NetworkKind& kind) {
    auto network = springs_along_edges(
        mesh, {.second_ring = kind.second_ring, .volume = kind.volume, .density = density});
    const IsotropicSolid solid{.young = young, .poisson = poisson};
    if (kind.volume) {
        apply_cauchy_split(mesh, solid, network);
    } else {
        apply(van_gelder(mesh, network.springs, solid), network);
    }
    return network;
}

/// Scores of the closed forms on the edges of a mesh.
[[nodiscard]] std::vector<Score> edge_form_scores(const Mesh<3, double, Tet4>& mesh, double poisson,
                                                  const CaseSets<3>& sets, const Settings& settings);

} // namespace study
