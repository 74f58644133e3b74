// SPDX-License-Identifier: BSD-3-Clause
// Reads or makes a mesh.

#include <cstdio>

#include <glob.h>

#include <springfit/cgal/interpolation.hpp>
#include <springfit/cgal/tetrahedralize.hpp>
#include <springfit/cgal/triangulate.hpp>
#include <springfit/core/stage.hpp>
#include <springfit/io/mesh_file.hpp>
#include <springfit/mesh/corner_mesh.hpp>

#include "body.hpp"

namespace program {

using namespace springfit;

namespace {

[[nodiscard]] std::string extension(const std::string& path) {
    std::string text = std::filesystem::path(path).extension().string();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

[[nodiscard]] bool is_one_of(const std::string& value, std::initializer_list<const char*> choices) {
    return std::find(choices.begin(), choices.end(), value) != choices.end();
}

/// Options that say how to mesh have no use for a body that is meshed already.
void refuse_meshing_options(const FitOptions& options) {
    require(!options.cell_size, "--cell-size", "a surface or an outline as INPUT", options.input);
    require(!options.nodes, "--nodes", "a surface or an outline as INPUT", options.input);
    require(!options.reference_nodes, "--reference-nodes", "a surface or an outline as INPUT", options.input);
    require(options.fill_holes == 0, "--fill-holes", "a surface as INPUT", options.input);
}

/// The mesh of a file, corners only; plane where it is flat.
[[nodiscard]] AnyMesh from_mesh_file(const io::MeshFile& file) {
    for (const std::string& note : file.notes) {
        std::fprintf(stderr, "%s: %s\n", file.file.c_str(), note.c_str());
    }
    return io::with_cell(file.blocks.front().kind, [&]<CellType Cell>(Cell) -> AnyMesh {
        if constexpr (Cell::dimension == 3) {
            return corner_mesh(file.as_mesh<3, double, Cell>());
        } else {
            if (file.is_flat()) {
                return corner_mesh(file.as_mesh<2, double, Cell>());
            }
            if constexpr (std::same_as<Cell, Tri3>) {
                return file.as_mesh<3, double, Tri3>();
            } else {
                throw FileError(file.file, text("expected triangles for a membrane, found ", Cell::name, " cells"));
            }
        }
    });
}

/// The mesh of INPUT in the file's own unit.
[[nodiscard]] AnyMesh read_as_it_is(const FitOptions& options, const ProgressCallback& progress) {
    const std::string kind = extension(options.input);
    if (!std::filesystem::exists(options.input)) {
        throw FileError(options.input, "no such file");
    }
    if (is_one_of(kind, {".off", ".obj", ".stl", ".ply"})) {
        Stage stage(progress, "mesh");
        cgal::TetrahedralizeOptions how;
        how.cell_size = options.cell_size.value_or(0);
        how.n_nodes = options.cell_size ? 0 : options.nodes.value_or(default_nodes);
        how.seed = options.seed;
        how.repair.max_hole_edges = options.fill_holes;
        how.progress = stage.part();
        return cgal::tetrahedralize<double>(std::filesystem::path(options.input), how);
    }
    if (is_one_of(kind, {".poly", ".wkt"})) {
        require(options.fill_holes == 0, "--fill-holes", "a surface as INPUT", options.input);
        const Stage stage(progress, "mesh");
        cgal::TriangulateOptions how;
        how.cell_size = options.cell_size.value_or(0);
        how.n_nodes = options.cell_size ? 0 : options.nodes.value_or(default_nodes);
        how.several_pieces = true; // which the program says, and clamps have to hold
        return cgal::triangulate<double>(std::filesystem::path(options.input), how);
    }
    require(is_one_of(kind, {".msh", ".mesh", ".node", ".ele", ".vtk"}), "INPUT",
            "one of .off .obj .stl .ply .poly .wkt .msh .mesh .node .vtk .xdmf .h5", options.input);
    refuse_meshing_options(options);
    return from_mesh_file(io::read_mesh(options.input));
}

} // namespace

std::vector<std::string> expanded(const std::vector<std::string>& patterns) {
    std::vector<std::string> files;
    for (const std::string& pattern : patterns) {
        if (pattern.find_first_of("*?[") == std::string::npos || std::filesystem::exists(pattern)) {
            files.push_back(pattern);
            continue;
        }
        ::glob_t found{};
        const bool is_match = ::glob(pattern.c_str(), 0, nullptr, &found) == 0;
        for (std::size_t f = 0; is_match && f < found.gl_pathc; ++f) {
            files.emplace_back(found.gl_pathv[f]);
        }
        ::globfree(&found);
        if (!is_match) {
            throw FileError(pattern, "no such file");
        }
    }
    return files;
}

double metres(const std::string& unit) {
    return unit == "m" ? 1. : unit == "cm" ? 1e-2 : unit == "mm" ? 1e-3 : unit == "um" ? 1e-6 : 0.0254; // inch
}

double seconds(const std::string& unit) {
    return unit == "s" ? 1. : unit == "ms" ? 1e-3 : 1e-6; // us
}

bool is_motion_file(const std::string& path) {
    return is_one_of(extension(path), {".xdmf", ".xmf", ".h5", ".hdf5"});
}

int dimension_of(const AnyMesh& mesh) {
    return std::visit([](const auto& m) { return static_cast<int>(m.nodes.rows()); }, mesh);
}

AnyMesh read_mesh(const FitOptions& options, const ProgressCallback& progress) {
    AnyMesh mesh = read_as_it_is(options, progress);
    std::visit([&](auto& m) { m.nodes *= metres(options.unit); }, mesh);
    return mesh;
}

FineMesh read_fine_mesh(const FitOptions& options, const AnyMesh& coarse, const ProgressCallback& progress) {
    const int wanted = options.reference_nodes.value();
    auto finer = options;
    finer.nodes = wanted;
    finer.cell_size.reset();
    return std::visit(
        [&]<int Dim, CellType Cell>(const Mesh<Dim, double, Cell>& network) -> FineMesh {
            require(wanted > network.n_nodes(), "--reference-nodes",
                    text("more than the ", network.n_nodes(), " nodes of the network"), wanted);
            if constexpr (SimplexCell<Cell> && Cell::dimension == Dim) { // what surfaces and outlines are cut into
                FineMesh fine{.mesh = read_mesh(finer, progress), .at_network = {}, .at_fine = {}};
                const auto& mesh = std::get<Mesh<Dim, double, Cell>>(fine.mesh);
                fine.at_network = cgal::interpolation(mesh, network.nodes);
                fine.at_fine = cgal::interpolation(network, mesh.nodes);
                return fine;
            } else {
                throw InvalidArgument("--reference-nodes", "a surface or an outline as INPUT", options.input);
            }
        },
        coarse);
}

} // namespace program
