// SPDX-License-Identifier: BSD-3-Clause
// MuJoCo has no point masses with springs; the closest model of them is a body with three sliding joints per node and a
// spatial tendon per spring.

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

#include <mujoco/mujoco.h>
#include <unistd.h>

#include <springfit/simulate/stable_step.hpp>

#include "../bodies.hpp"
#include "peers.hpp"

namespace bench::peers {

namespace {

using springfit::Index;
using Network = springfit::SpringNetwork<3, double>;

void write_model(const Network& network, const std::filesystem::path& file) {
    std::ofstream out(file);
    out.precision(17);
    out << "<mujoco><compiler boundmass='0' boundinertia='0'/>\n"
        << "<option gravity='0 0 0' integrator='Euler' jacobian='sparse' timestep='" << stable_step(network) / 2
        << "'><flag contact='disable' constraint='disable'/></option>\n<worldbody>\n";
    for (Index i = 0; i < network.n_nodes(); ++i) {
        const auto x = network.rest_positions.col(i);
        out << "<body pos='" << x(0) << ' ' << x(1) << ' ' << x(2) << "'><inertial pos='0 0 0' mass='"
            << network.mass(i) << "' diaginertia='1 1 1'/><joint type='slide' axis='1 0 0'/>"
            << "<joint type='slide' axis='0 1 0'/><joint type='slide' axis='0 0 1'/><site name='" << i
            << "'/></body>\n";
    }
    out << "</worldbody>\n<tendon>\n";
    for (Index e = 0; e < network.n_springs(); ++e) {
        out << "<spatial stiffness='" << network.stiffness(e) << "' damping='" << network.damping(e)
            << "' springlength='" << network.rest_length(e) << "'><site site='" << network.springs(0, e)
            << "'/><site site='" << network.springs(1, e) << "'/></spatial>\n";
    }
    out << "</tendon></mujoco>\n";
}

void step(benchmark::State& state, Index springs) {
    const Network network = bench::network<3, double>(springs);
    const auto file = std::filesystem::temp_directory_path() / ("springfit-bench-" + std::to_string(getpid()) + ".xml");
    write_model(network, file);
    char error[1000] = "";
    const std::unique_ptr<mjModel, decltype(&mj_deleteModel)> model(
        mj_loadXML(file.c_str(), nullptr, error, sizeof error), &mj_deleteModel);
    std::filesystem::remove(file);
    if (!model) {
        state.SkipWithError(error);
        return;
    }
    const std::unique_ptr<mjData, decltype(&mj_deleteData)> data(mj_makeData(model.get()), &mj_deleteData);
    for (Index i = 0; i < network.n_nodes(); ++i) {
        for (Index d = 0; d < 3; ++d) {
            data->qpos[3 * i + d] = 0.01 * network.rest_positions(d, i);
        }
    }
    for (auto _ : state) {
        mj_step(model.get(), data.get());
        benchmark::ClobberMemory();
    }
    if (!std::isfinite(data->qpos[0])) {
        state.SkipWithError("the body flew apart");
    }
    count(state, network.n_springs());
}

} // namespace

void add_mujoco(Index springs) {
    if (springs <= 10000) { // beyond, its compiler of models takes minutes
        benchmark::RegisterBenchmark(bench::name<3, double>("mujoco_step", springs).c_str(), step, springs);
    }
}

} // namespace bench::peers
