// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cases/fem_recorder.hpp>

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

[[nodiscard]] FemRecorder<3, double> recorder_of(const TetMesh& mesh, const ReferenceKind& reference);
/// Motions in time, as the scenarios of the cases are; `stiffness_damping` is beta of D = beta K, s.
[[nodiscard]] RecordedCases<3, double> record_swings(const CaseRecorder<3, double>& reference,
                                                     const std::vector<LoadCase<3, double>>& cases,
                                                     double stiffness_damping, double frame_time, int frames,
                                                     const Settings& settings);
/// Lowest natural frequency, rad/s.
[[nodiscard]] double reference_frequency(const TetMesh& mesh, const ReferenceKind& reference,
                                         const std::vector<int>& clamped);
[[nodiscard]] double network_frequency(const SpringNetwork<3, double>& network, const std::vector<int>& clamped);

// Networks and rows (solid.cpp).

/// The closed forms of the springs on the edges of a mesh, with which every network is compared.
[[nodiscard]] std::vector<NamedNetwork<3>> edge_forms(const TetMesh& mesh, const ReferenceKind& reference);

/// A network of tetrahedra with a closed form's values; the last is the start and prior of a fit. Against a reference
/// that does not lock, volume stiffness starts at no more than 6 shear moduli: every cell holds its volume on its own,
/// and several cells share a node.
[[nodiscard]] std::vector<NamedNetwork<3>> start_of(const TetMesh& mesh, const ReferenceKind& reference,
                                                    const NetworkKind& kind);

/// Scores of `edge_forms`.
[[nodiscard]] std::vector<Score> edge_form_scores(const TetMesh& mesh, const ReferenceKind& reference,
                                                  const RecordedCases<3, double>& cases, const Settings& settings);

/// One row of one network; `forms` are the scores of `edge_forms`.
[[nodiscard]] Row solid_row(const std::string& name, const TetMesh& mesh, const ReferenceKind& reference,
                            const std::string& setup, const NetworkKind& kind, const RecordedCases<3, double>& cases,
                            const std::vector<Score>& forms, const CalibrateOptions& how);

/// One row per network, of a body clamped by `body`; acceleration is fitted where there are springs on edges alone.
[[nodiscard]] std::vector<Row> solid_rows(const std::string& name, const TetMesh& mesh, const Specimen<3, double>& body,
                                          const ReferenceKind& reference, const LoadCaseOptions& cases, double strain,
                                          const std::vector<NetworkKind>& networks, const CalibrateOptions& how,
                                          const Settings& settings);

/// Rows of hexahedra with all diagonals and of a membrane (braced.cpp).
void add_braced_rows(Report& report, const Settings& settings);

} // namespace study
