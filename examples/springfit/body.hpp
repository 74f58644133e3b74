// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <variant>

#include <springfit/cases/specimen.hpp>
#include <springfit/closed_form/cauchy_split.hpp>
#include <springfit/io/motion_file.hpp>
#include <springfit/mesh/mesh.hpp>
#include <springfit/network/spring_network.hpp>

#include "options.hpp"

namespace program {

/// A mesh of any kind of cell that the program reads or makes.
using AnyMesh = std::variant<springfit::Mesh<2, double, springfit::Tri3>, springfit::Mesh<2, double, springfit::Quad4>,
                             springfit::Mesh<3, double, springfit::Tet4>, springfit::Mesh<3, double, springfit::Hex8>,
                             springfit::Mesh<3, double, springfit::Tri3>>;

[[nodiscard]] int dimension_of(const AnyMesh& mesh);

/// Reads or makes the mesh of a surface, an outline or a mesh file; says on stderr what it did.
/// Throws FileError or InvalidArgument.
[[nodiscard]] AnyMesh read_mesh(const FitOptions& options);

/// A finer mesh of the same body, for the reference, and how values pass between its nodes and the network's.
struct FineMesh {
    AnyMesh mesh;
    springfit::Interpolation<double> at_network; ///< nodes of this mesh to nodes of the network
    springfit::Interpolation<double> at_fine;    ///< nodes of the network to nodes of this mesh
};

/// Makes the mesh of `--reference-nodes` beside that of the network, which `read_mesh` made from the same input.
/// Throws FileError or InvalidArgument.
[[nodiscard]] FineMesh read_fine_mesh(const FitOptions& options, const AnyMesh& coarse);

/// True for the file of a recorded motion.
[[nodiscard]] bool is_motion_file(const std::string& path);

/// The mesh of a recorded motion. Throws FileError where it holds no cells of a kind that springs can be laid along.
template <int Dim>
[[nodiscard]] AnyMesh mesh_of(const springfit::io::RecordedMotion<Dim, double>& recorded, const std::string& path);

/// A body as springs, whatever its cells are.
template <int Dim>
struct Discretisation {
    springfit::SpringNetwork<Dim, double> network; ///< springs, rest lengths and masses; stiffness 0 as yet
    std::vector<springfit::NamedClosedForm<double>> closed_forms; ///< all that hold for these cells, at least one
    /// Springs together with cells that hold their volume, of `--volume` on simplices.
    std::optional<springfit::CauchySplit<double>> cauchy_split;
    springfit::io::MotionTopology topology; ///< cells and springs, for the motion files
    std::string cell_name;
};

template <int Dim>
[[nodiscard]] Discretisation<Dim> discretise(const AnyMesh& mesh, const FitOptions& options);

/// A mesh as the load cases see it, without clamps: its surface is what a hand can reach, every node of a sheet.
template <int Dim>
[[nodiscard]] springfit::Specimen<Dim, double> body_of(const AnyMesh& mesh, const FitOptions& options);

/// The sides that `--clamp` names, or y-min.
[[nodiscard]] std::vector<std::string> sides_to_clamp(const FitOptions& options);

/// The nodes that the `--clamp` options name. Throws InvalidArgument for an unknown side or one that holds no node.
template <int Dim>
[[nodiscard]] std::vector<int> clamped_nodes(const std::vector<std::string>& clamps,
                                             const springfit::Points<Dim, double>& rest_positions);

} // namespace program
