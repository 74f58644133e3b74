// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>

#include <springfit/calibrate/candidate.hpp>
#include <springfit/cases/case_recorder.hpp>
#include <springfit/cases/coarse_cases.hpp>
#include <springfit/cases/specimen.hpp>
#include <springfit/io/motion_file.hpp>
#include <springfit/mesh/mesh.hpp>
#include <springfit/motion/surface.hpp>

#include "options.hpp"

namespace program {

/// A mesh of any kind of cell that the program reads or makes.
using AnyMesh = std::variant<springfit::Mesh<2, double, springfit::Tri3>, springfit::Mesh<2, double, springfit::Quad4>,
                             springfit::Mesh<3, double, springfit::Tet4>, springfit::Mesh<3, double, springfit::Hex8>,
                             springfit::Mesh<3, double, springfit::Tri3>>;

[[nodiscard]] int dimension_of(const AnyMesh& mesh);

/// Reads or makes the mesh of a surface, an outline or a mesh file, in m; says on stderr what it did.
/// Throws FileError or InvalidArgument.
[[nodiscard]] AnyMesh read_mesh(const FitOptions& options, const springfit::ProgressCallback& progress);

/// A finer mesh of the same body, for the reference, and how values pass between its nodes and the network's.
struct FineMesh {
    AnyMesh mesh;
    springfit::Interpolation<double> at_network; ///< nodes of this mesh to nodes of the network
    springfit::Interpolation<double> at_fine;    ///< nodes of the network to nodes of this mesh
};

/// Makes the mesh of `--reference-nodes` beside that of the network, which `read_mesh` made from the same input.
/// Throws FileError or InvalidArgument.
[[nodiscard]] FineMesh read_fine_mesh(const FitOptions& options, const AnyMesh& coarse,
                                      const springfit::ProgressCallback& progress);

/// True for the file of a recorded motion.
[[nodiscard]] bool is_motion_file(const std::string& path);

/// Names of files, patterns of the shell expanded. Throws FileError for one that nothing matches.
[[nodiscard]] std::vector<std::string> expanded(const std::vector<std::string>& patterns);

/// What `--unit` is, m, and `--time-unit`, s.
[[nodiscard]] double metres(const std::string& unit);
[[nodiscard]] double seconds(const std::string& unit);

/// The mesh of a recorded motion. Throws FileError where it holds no cells of a kind that springs can be laid along.
template <int Dim>
[[nodiscard]] AnyMesh mesh_of(const springfit::io::RecordedMotion<Dim, double>& recorded, const std::string& path);

/// A body as springs, whatever its cells are.
template <int Dim>
struct Discretisation {
    springfit::SpringNetwork<Dim, double> network; ///< springs, rest lengths and masses; stiffness 0
    springfit::io::MotionTopology topology;        ///< cells and springs, for the motion files
    std::string cell_name;
};

template <int Dim>
[[nodiscard]] Discretisation<Dim> discretise(const AnyMesh& mesh, const FitOptions& options);

/// The networks to try, with the values of every closed form that holds for their mesh.
template <int Dim>
[[nodiscard]] std::vector<springfit::NetworkVariant<Dim>> variants_of(const AnyMesh& mesh, const FitOptions& options);

/// The body that load cases are recorded of, held where `--clamp` says.
template <int Dim>
[[nodiscard]] springfit::Specimen<Dim, double> specimen_of(const AnyMesh& mesh, const FitOptions& options);

/// The boundary of a fine mesh as the network carries it, and the fine nodes that it consists of.
template <int Dim>
struct FineSurface {
    springfit::EmbeddedSurface<Dim, double> surface;
    std::vector<int> nodes;
};

template <int Dim>
[[nodiscard]] FineSurface<Dim> surface_of(const FineMesh& fine);

/// The finite element model of a mesh for the element and material asked for, and the element's name. Throws
/// InvalidArgument where they do not fit the mesh.
template <int Dim>
struct FemReference {
    std::unique_ptr<springfit::CaseRecorder<Dim, double>> recorder;
    std::string element;
};

template <int Dim>
[[nodiscard]] FemReference<Dim> make_fem_reference(const AnyMesh& mesh, const FitOptions& options);

/// The sides that `--clamp` names, or y-min.
[[nodiscard]] std::vector<std::string> sides_to_clamp(const FitOptions& options);

/// The nodes on the sides that are clamped. Throws InvalidArgument for an unknown side or where none is left to move.
template <int Dim>
[[nodiscard]] std::vector<int> nodes_to_clamp(const std::vector<std::string>& clamps,
                                              const springfit::Points<Dim, double>& rest_positions);

} // namespace program
