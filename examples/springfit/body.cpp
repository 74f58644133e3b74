// SPDX-License-Identifier: BSD-3-Clause
// A mesh of any cells as springs, as a specimen and as a network's surface.

#include <springfit/calibrate/calibrate.hpp>
#include <springfit/cases/clamp_sets.hpp>
#include <springfit/network/builders.hpp>

#include "body.hpp"

namespace program {

using namespace springfit;

template <int Dim>
Discretisation<Dim> discretise(const AnyMesh& any, const FitOptions& options) {
    return std::visit(
        [&]<int MeshDim, CellType Cell>(const Mesh<MeshDim, double, Cell>& mesh) -> Discretisation<Dim> {
            if constexpr (MeshDim != Dim) {
                throw InvalidArgument("mesh", text("dimension ", Dim), text(MeshDim));
            } else {
                require(!(Cell::dimension == 3 && options.thickness), "--thickness", "a plane body or a membrane",
                        "a solid");
                Discretisation<Dim> body;
                body.network = springs_along_edges(mesh, {.diagonals = !SimplexCell<Cell>,
                                                          .second_ring = options.second_ring,
                                                          .volume = options.volume,
                                                          .density = options.density,
                                                          .thickness = options.thickness.value_or(1)});
                body.topology = io::motion_topology(mesh, body.network.springs);
                body.cell_name = Cell::name;
                return body;
            }
        },
        any);
}

template <int Dim>
std::vector<NetworkVariant<Dim>> variants_of(const AnyMesh& any, const FitOptions& options) {
    return std::visit(
        [&]<int MeshDim, CellType Cell>(const Mesh<MeshDim, double, Cell>& mesh) -> std::vector<NetworkVariant<Dim>> {
            if constexpr (MeshDim != Dim) {
                throw InvalidArgument("mesh", text("dimension ", Dim), text(MeshDim));
            } else {
                BodyOptions<Dim> body;
                body.parts = options.parts == "edges" ? Parts::given : Parts::automatic;
                body.density = options.density;
                body.thickness = options.thickness.value_or(1);
                body.second_ring = options.second_ring;
                body.volume = options.volume;
                return network_variants(
                    mesh, {.young = options.young, .poisson = options.poisson, .thickness = body.thickness}, body);
            }
        },
        any);
}

template <int Dim>
Specimen<Dim, double> specimen_of(const AnyMesh& any, const FitOptions& options) {
    auto specimen = std::visit(
        [&]<int MeshDim, CellType Cell>(const Mesh<MeshDim, double, Cell>& mesh) -> Specimen<Dim, double> {
            if constexpr (MeshDim != Dim) {
                throw InvalidArgument("mesh", text("dimension ", Dim), text(MeshDim));
            } else {
                return springfit::specimen_of(mesh, options.density, options.thickness.value_or(1));
            }
        },
        any);
    specimen.clamps = {{nodes_to_clamp<Dim>(sides_to_clamp(options), specimen.rest_positions), {}}};
    return specimen;
}

template <int Dim>
FineSurface<Dim> surface_of(const FineMesh& fine) {
    return std::visit(
        [&]<int MeshDim, CellType Cell>(const Mesh<MeshDim, double, Cell>& mesh) -> FineSurface<Dim> {
            if constexpr (MeshDim == Dim && Cell::dimension == Dim) {
                return {boundary_surface(mesh, fine.at_fine), boundary_nodes(mesh)};
            } else {
                throw InvalidArgument("mesh", text("dimension ", Dim), text(MeshDim));
            }
        },
        fine.mesh);
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

std::vector<std::string> sides_to_clamp(const FitOptions& options) {
    return options.clamps.empty() ? std::vector<std::string>{"y-min"} : options.clamps;
}

template <int Dim>
std::vector<int> nodes_to_clamp(const std::vector<std::string>& clamps, const Points<Dim, double>& rest_positions) {
    std::vector<int> nodes;
    for (const std::string& clamp : clamps) {
        const std::string side = clamp.substr(0, clamp.find(':'));
        const int axis = side.empty() ? -1 : side[0] - 'x';
        const bool is_side = axis >= 0 && axis < Dim && (side.substr(1) == "-min" || side.substr(1) == "-max");
        require(is_side, "--clamp", Dim == 2 ? "x-min, x-max, y-min or y-max" : "x-min, x-max, y-min, ... or z-max",
                clamp);
        double part = side_depth;
        if (side.size() < clamp.size()) {
            const std::string number = clamp.substr(side.size() + 1);
            std::size_t used = 0;
            try {
                part = std::stod(number, &used);
            } catch (const std::exception&) {
                used = 0;
            }
            require(used == number.size() && !number.empty() && part >= 0 && part < 1, "--clamp",
                    "a part of the extent in [0, 1) after the colon", clamp);
        }
        const std::vector<int> held = side_nodes(rest_positions, {axis, side.substr(2) == "max"}, part);
        nodes.insert(nodes.end(), held.begin(), held.end());
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    require(static_cast<Index>(nodes.size()) < rest_positions.cols(), "--clamp", "nodes left to move", "none");
    return nodes;
}

template Discretisation<2> discretise<2>(const AnyMesh&, const FitOptions&);
template Discretisation<3> discretise<3>(const AnyMesh&, const FitOptions&);
template std::vector<NetworkVariant<2>> variants_of<2>(const AnyMesh&, const FitOptions&);
template std::vector<NetworkVariant<3>> variants_of<3>(const AnyMesh&, const FitOptions&);
template Specimen<2, double> specimen_of<2>(const AnyMesh&, const FitOptions&);
template Specimen<3, double> specimen_of<3>(const AnyMesh&, const FitOptions&);
template FineSurface<2> surface_of<2>(const FineMesh&);
template FineSurface<3> surface_of<3>(const FineMesh&);
template AnyMesh mesh_of<2>(const io::RecordedMotion<2, double>&, const std::string&);
template AnyMesh mesh_of<3>(const io::RecordedMotion<3, double>&, const std::string&);
template std::vector<int> nodes_to_clamp<2>(const std::vector<std::string>&, const Points<2, double>&);
template std::vector<int> nodes_to_clamp<3>(const std::vector<std::string>&, const Points<3, double>&);

} // namespace program
