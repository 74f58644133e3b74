// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "trial.hpp"

/// What the parts in space share: tetrahedral bodies, their finite elements and the networks on their nodes.
namespace study {

using TetMesh = Mesh<3, double, Tet4>;

inline constexpr double young = 5e4;
inline constexpr double density = 1000;
inline constexpr std::array<double, 3> box_size{0.8, 0.3, 0.3};

enum class MaterialKind { linear, st_venant_kirchhoff, neo_hookean };

/// A finite element reference of a tetrahedral body.
struct ReferenceKind {
    MaterialKind material = MaterialKind::linear;
    double poisson = 0.25;
    /// The volume measure averaged around each node, so that the body does not lock; else of each tetrahedron as it is.
    bool mean_dilatation = false;
    double stiffness_damping = 0; ///< s

    [[nodiscard]] IsotropicSolid solid() const { return {.young = young, .poisson = poisson}; }
};

[[nodiscard]] std::string name_of(MaterialKind material);

/// Which springs and cells a network of tetrahedra has.
struct NetworkKind {
    bool second_ring = false;
    bool volume = false;
};

inline constexpr NetworkKind edges_alone{};
inline constexpr NetworkKind with_ring{true, false};
inline constexpr NetworkKind with_volume{false, true};
inline constexpr NetworkKind with_both{true, true};

[[nodiscard]] inline std::string name_of(const NetworkKind& kind) {
    return std::string("edges") + (kind.second_ring ? ", second ring" : "") + (kind.volume ? ", volume" : "");
}

/// Clamped at the lowest side along an axis, as deep as a part of the extent.
[[nodiscard]] Specimen<3, double> body_of(const TetMesh& mesh, int axis = 0, double depth = 0.02);

// What the reference does (references.cpp).

[[nodiscard]] CaseSets<3> record_solid(const TetMesh& mesh, const ReferenceKind& reference,
                                       const Specimen<3, double>& body, const CaseSettings& cases,
                                       const Settings& settings);
/// Scenarios scaled to a strain, with their equilibria.
[[nodiscard]] Cases<3> record_solid(const TetMesh& mesh, const ReferenceKind& reference,
                                    const std::vector<Scenario<3, double>>& scenarios, double strain,
                                    const Settings& settings);
/// Motions in time, as the scenarios are.
[[nodiscard]] Cases<3> record_swings(const TetMesh& mesh, const ReferenceKind& reference,
                                     const std::vector<Scenario<3, double>>& scenarios, double frame_time, int frames,
                                     const Settings& settings);
/// Lowest natural frequency, rad/s.
[[nodiscard]] double reference_frequency(const TetMesh& mesh, const ReferenceKind& reference,
                                         const std::vector<int>& clamped);
[[nodiscard]] double network_frequency(const SpringNetwork<3, double>& network, const std::vector<int>& clamped);

// Networks and rows (solid.cpp).

/// A network of tetrahedra with a closed form's values, the prior of a fit. Against a reference that does not lock,
/// volume stiffness starts at no more than 6 shear moduli: every cell holds its volume on its own, and several cells
/// share a node.
[[nodiscard]] SpringNetwork<3, double> prior_network(const TetMesh& mesh, const ReferenceKind& reference,
                                                     const NetworkKind& kind);

/// Scores of the closed forms on the edges of a mesh.
[[nodiscard]] std::vector<Score> edge_form_scores(const TetMesh& mesh, const ReferenceKind& reference,
                                                  const CaseSets<3>& sets, const Settings& settings);

/// One row of one network; `edge_forms` are the closed forms on edges, with which every network is compared.
[[nodiscard]] Row solid_row(const std::string& name, const TetMesh& mesh, const ReferenceKind& reference,
                            const std::string& setup, const NetworkKind& kind, const CaseSets<3>& sets,
                            const std::vector<Score>& edge_forms, const Methods& methods, const Settings& settings);

/// One row per network, of a body clamped by `body`.
[[nodiscard]] std::vector<Row> solid_rows(const std::string& name, const TetMesh& mesh, const Specimen<3, double>& body,
                                          const ReferenceKind& reference, const CaseSettings& cases,
                                          const std::vector<NetworkKind>& networks, const Methods& methods,
                                          const Settings& settings);

/// Rows of hexahedra with all diagonals and of a membrane (braced.cpp).
void add_braced_rows(Report& report, const Settings& settings);

} // namespace study
