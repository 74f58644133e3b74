// SPDX-License-Identifier: BSD-3-Clause
#include <springfit/closed_form/baudet.hpp>
#include <springfit/closed_form/cubic_cell.hpp>
#include <springfit/closed_form/projection.hpp>
#include <springfit/closed_form/van_gelder.hpp>
#include <springfit/mesh/topology.hpp>
#include <springfit/network/topology.hpp>

#include "body.hpp"

namespace program {

using namespace springfit;

namespace {

/// Every published formula that holds for the cells, the most common one first.
template <int Dim, CellType Cell>
std::vector<ClosedFormResult> closed_forms(const Mesh<Dim, double, Cell>& mesh, const NodePairs& springs,
                                           const IsotropicSolid& solid) {
    std::vector<ClosedFormResult> results;
    const auto add = [&](const char* name, ClosedForm<double> form) {
        results.push_back({name, std::move(form.stiffness), form.n_clamped});
    };
    if constexpr (SimplexCell<Cell>) {
        add("van_gelder", van_gelder(mesh, springs, solid));
        if constexpr (Cell::dimension == 2) {
            add("van_gelder_nu", van_gelder_any_poisson(mesh, springs, solid));
        }
        add("projection", projection(mesh, springs, solid));
    } else if constexpr (std::same_as<Cell, Quad4>) {
        add("baudet", baudet(mesh, springs, solid));
    } else {
        add("cubic_cell", cubic_cell(mesh, springs, solid));
    }
    return results;
}

} // namespace

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
                                                          .density = options.density,
                                                          .thickness = thickness});
                body.closed_forms = closed_forms(mesh, body.network.springs,
                                                 {.young = options.young, .poisson = options.poisson, .thickness = thickness});
                body.topology = io::motion_topology(mesh, body.network.springs);
                body.cell_name = Cell::name;
                if constexpr (solid) {
                    body.surface = boundary_nodes(mesh);
                } else { // a hand reaches every node of a sheet
                    for (int i = 0; i < static_cast<int>(mesh.n_nodes()); ++i) {
                        body.surface.push_back(i);
                    }
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
                                       "springs can be laid along, found ", Cell::name, " cells in dimension ", Dim));
        }
    });
}

template Discretisation<2> discretise<2>(const AnyMesh&, const FitOptions&);
template Discretisation<3> discretise<3>(const AnyMesh&, const FitOptions&);
template AnyMesh mesh_of<2>(const io::RecordedMotion<2, double>&, const std::string&);
template AnyMesh mesh_of<3>(const io::RecordedMotion<3, double>&, const std::string&);

} // namespace program
