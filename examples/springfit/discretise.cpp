// SPDX-License-Identifier: BSD-3-Clause
#include <numeric>

#include <springfit/closed_form/all.hpp>
#include <springfit/mesh/topology.hpp>
#include <springfit/network/topology.hpp>

#include "body.hpp"

namespace program {

using namespace springfit;

template <int Dim>
Discretisation<Dim> discretise(const AnyMesh& any, const FitOptions& options) {
    return std::visit(
        [&]<int MeshDim, CellType Cell>(const Mesh<MeshDim, double, Cell>& mesh) -> Discretisation<Dim> {
            if constexpr (MeshDim != Dim) {
                throw InvalidArgument("mesh", text("dimension ", Dim), MeshDim == 2 ? "2" : "3");
            } else {
                constexpr bool solid = Cell::dimension == 3;
                require(!(solid && options.thickness), "--thickness", "a plane body or a membrane", "a solid");
                const double thickness = options.thickness.value_or(1);
                Discretisation<Dim> body;
                body.network = springs_along_edges(mesh, {.diagonals = !SimplexCell<Cell>,
                                                          .second_ring = options.second_ring,
                                                          .volume = options.volume,
                                                          .density = options.density,
                                                          .thickness = thickness});
                body.closed_forms =
                    closed_forms(mesh, body.network.springs,
                                 {.young = options.young, .poisson = options.poisson, .thickness = thickness});
                if constexpr (SimplexCell<Cell> && Cell::dimension == Dim) {
                    if (options.volume) {
                        body.cauchy_split =
                            cauchy_split(mesh, body.network.springs,
                                         {.young = options.young, .poisson = options.poisson, .thickness = thickness});
                    }
                }
                body.topology = io::motion_topology(mesh, body.network.springs);
                body.cell_name = Cell::name;
                return body;
            }
        },
        any);
}

template <int Dim>
Specimen<Dim, double> body_of(const AnyMesh& any, const FitOptions& options) {
    return std::visit(
        [&]<int MeshDim, CellType Cell>(const Mesh<MeshDim, double, Cell>& mesh) -> Specimen<Dim, double> {
            if constexpr (MeshDim != Dim) {
                throw InvalidArgument("mesh", text("dimension ", Dim), text(MeshDim));
            } else {
                const auto masses = node_masses(mesh, options.density, options.thickness.value_or(1));
                Specimen<Dim, double> body{mesh.nodes, masses, {}, {}};
                if constexpr (Cell::dimension == 3) {
                    body.surface = boundary_nodes(mesh);
                } else { // a hand reaches every node of a sheet
                    body.surface.resize(static_cast<std::size_t>(mesh.n_nodes()));
                    std::iota(body.surface.begin(), body.surface.end(), 0);
                }
                return body;
            }
        },
        any);
}

template <int Dim>
AnyMesh mesh_of(const io::RecordedMotion<Dim, double>& recorded, const std::string& path) {
    const auto& topology = recorded.topology;
    if (!topology.kind) {
        throw FileError(path, "/mesh/cells: expected the cells of the body, found none");
    }
    return io::with_cell(*topology.kind, [&]<CellType Cell>(Cell) -> AnyMesh {
        constexpr bool linear = Cell::n_nodes == Cell::n_corners;
        constexpr bool membrane_of_quads = Dim == 3 && std::same_as<Cell, Quad4>;
        if constexpr (Cell::dimension <= Dim && linear && !membrane_of_quads) {
            Mesh<Dim, double, Cell> mesh{recorded.motion.rest_positions, topology.cells};
            validate(mesh);
            return mesh;
        } else {
            throw FileError(path, text("/mesh/cells: expected triangles, quadrilaterals, tetrahedra or hexahedra that "
                                       "springs can be laid along, found ",
                                       Cell::name, " cells in dimension ", Dim));
        }
    });
}

template Discretisation<2> discretise<2>(const AnyMesh&, const FitOptions&);
template Discretisation<3> discretise<3>(const AnyMesh&, const FitOptions&);
template Specimen<2, double> body_of<2>(const AnyMesh&, const FitOptions&);
template Specimen<3, double> body_of<3>(const AnyMesh&, const FitOptions&);
template AnyMesh mesh_of<2>(const io::RecordedMotion<2, double>&, const std::string&);
template AnyMesh mesh_of<3>(const io::RecordedMotion<3, double>&, const std::string&);

} // namespace program
