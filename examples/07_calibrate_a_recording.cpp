// SPDX-License-Identifier: BSD-3-Clause
// Springs from motion that another program recorded. With a motion file and a folder it does what
// `springfit fit MOTION --young 5e4 --poisson 0.3 --density 1000 --out FOLDER` does.

#include <cstdio>

#include <springfit/io/calibration_json.hpp>
#include <springfit/io/motion_file.hpp>
#include <springfit/springfit.hpp>

namespace {

using namespace springfit;

const IsotropicSolid solid{.young = 5e4, .poisson = 0.3};

/// Stands for a file: a hidden body that swings.
io::RecordedMotion<3, double> some_recording() {
    const auto mesh = tetrahedron_grid<double>({2, 4, 2}, {0.1, 0.2, 0.1}); // m
    auto hidden = springs_along_edges(mesh, {.density = 1000.});
    hidden.stiffness = 1.3 * van_gelder(mesh, hidden.springs, solid).stiffness;
    Scenario<3, double> swing;
    swing.clamps.push_back({side_nodes(mesh.nodes, {.axis = 1}), {}});
    swing.gravity.push_back({{2., -1., 0.5}, ramp_and_release(0.02, 0.05)});
    io::RecordedMotion<3, double> recorded;
    recorded.motion = record(hidden, swing, {.dt = 0.002, .frames = 90}).motion;
    recorded.topology = io::motion_topology(mesh, hidden.springs);
    return recorded;
}

} // namespace

int main(int argc, char** argv) {
    const auto recorded = argc > 1 ? io::read_motion<3, double>(argv[1]) : some_recording();
    const Mesh<3, double, Tet4> mesh{recorded.motion.rest_positions, recorded.topology.cells};
    const auto variants = network_variants<3>(mesh, solid, {.density = 1000.});
    const auto result = calibrate(variants, split_motions<3, double>({recorded.motion}));

    for (const auto& candidate : result.candidates) {
        std::printf("%-14s %.4f\n", candidate.name.c_str(), candidate.held_out.error);
    }
    std::printf("%s: %s\n", result.best().name.c_str(), std::string(to_string(result.verdict)).c_str());
    if (argc > 2) {
        io::write_model(std::filesystem::path(argv[2]) / "model.json", io::model_of(result, {.input = argv[1]}));
    }
    return is_usable(result.verdict) ? 0 : 1;
}
