// SPDX-License-Identifier: BSD-3-Clause
//
// Writes the files that check_files.py reads: bodies small enough to be told again there, in the analytic motion.

#include <springfit/io/model_json.hpp>
#include <springfit/io/motion_file.hpp>

#include "analytic_motion.hpp"

using namespace springfit;

namespace {

constexpr int n_frames = 5;

template <int Dim, std::floating_point Scalar, CellType Cell>
void write(const std::filesystem::path& folder, const std::string& name, const Mesh<Dim, Scalar, Cell>& mesh) {
    const auto motion = test::analytic_motion(mesh.nodes, n_frames);
    NodePairs springs(2, 3);
    springs << 0, 1, 3, 1, 2, 0;
    auto fitted = motion.positions;
    for (auto& positions : fitted) {
        positions = mesh.nodes + 2 * (positions - mesh.nodes);
    }
    io::OutputGroup outputs;
    io::write_motion<Dim, Scalar>(outputs, folder / (name + ".h5"), motion, io::motion_topology(mesh, springs),
                                  &fitted);

    io::Model<Dim, Scalar> model;
    model.network.rest_positions = mesh.nodes;
    model.network.springs = springs;
    model.network.stiffness = Values<Scalar>{{Scalar(1) / 3, 0, Scalar(1e20)}};
    model.network.rest_length = Values<Scalar>{{1, Scalar(0.1), 2}};
    model.network.damping = Values<Scalar>{{0, Scalar(2) / 7, 1}};
    model.network.mass = Values<Scalar>::Constant(mesh.n_nodes(), Scalar(1) / 9);
    model.fixed = {0, 2};
    model.stable_time_step = Scalar(1) / 1234;
    model.provenance = {{"springfit", "0.1.0"}, {"material", {{"young", 5e4}}}};
    io::write_model(outputs, folder / (name + ".json"), model);
    outputs.commit();
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    std::filesystem::remove_all(folder);
    const io::OutputFolder output(folder);
    write<2, double, Tri3>(
        folder, "triangles",
        {Points<2, double>{{0, 1, 0, 1}, {0, 0, 1, 1.5}}, Mesh<2, double, Tri3>::CellArray{{0, 1}, {1, 3}, {2, 2}}});
    write<2, float, Tri3>(
        folder, "triangles_float",
        {Points<2, float>{{0, 1, 0, 1}, {0, 0, 1, 1.5F}}, Mesh<2, float, Tri3>::CellArray{{0, 1}, {1, 3}, {2, 2}}});
    const Points<3, double> nodes{{0, 1, 0, 0, 1}, {0, 0, 1, 0, 1}, {0, 0, 0, 1, 1}};
    write<3, double, Tet4>(folder, "tetrahedra",
                           {nodes, Mesh<3, double, Tet4>::CellArray{{0, 1}, {1, 2}, {2, 3}, {3, 4}}});
    write<3, double, Quad4>(folder, "membrane",
                            {nodes.leftCols(4), Mesh<3, double, Quad4>::CellArray{{0}, {1}, {3}, {2}}});
    return 0;
}
