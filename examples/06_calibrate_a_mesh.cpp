// SPDX-License-Identifier: BSD-3-Clause
// From a mesh and a material to judged springs in one call. With a mesh file and a folder it does what
// `springfit fit MESH --young 5e4 --poisson 0.3 --density 1000 --strain 0.01 --deformation 0.01 --out FOLDER` does.

#include <cstdio>

#include <springfit/io/calibration_json.hpp>
#include <springfit/io/mesh_file.hpp>
#include <springfit/springfit.hpp>

int main(int argc, char** argv) {
    using namespace springfit;
    const auto mesh = argc > 1 ? io::read_mesh(argv[1]).as_mesh<3, double, Tet4>()
                               : tetrahedron_grid<double>({3, 6, 3}, {0.1, 0.2, 0.1}); // m
    BodyOptions<3> body{.density = 1000, .clamped = side_nodes(mesh.nodes, {.axis = 1})};
    body.record.strain = body.record.deformation = 0.01; // small, where springs alone do well
    const auto result = calibrate(mesh, fem::NeoHookean{.young = 5e4, .poisson = 0.3}, body);

    for (const auto& candidate : result.candidates) {
        std::printf("%-14s %.4f\n", candidate.name.c_str(), candidate.held_out.error);
    }
    std::printf("%s: %s\n", result.best().name.c_str(), std::string(to_string(result.verdict)).c_str());
    if (argc > 2) {
        io::write_model(std::filesystem::path(argv[2]) / "model.json", io::model_of(result, {.input = argv[1]}));
    }
    return is_usable(result.verdict) ? 0 : 1;
}
