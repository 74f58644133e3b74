// SPDX-License-Identifier: BSD-3-Clause
// `springfit simulate`: steps a fitted model and writes its motion.

#include <cstdio>
#include <limits>

#include <unistd.h>

#include <springfit/io/model_json.hpp>
#include <springfit/io/motion_file.hpp>
#include <springfit/motion/record.hpp>
#include <springfit/simulate/implicit_euler.hpp>
#include <springfit/simulate/projective_euler.hpp>
#include <springfit/simulate/symplectic_euler.hpp>

#include "commands.hpp"
#include "terminal.hpp"

namespace program {

using namespace springfit;

namespace {

/// Into how many calls of its stepper a time between two frames is cut, so that the user's Ctrl-C is soon heard. Throws
/// InvalidArgument for more steps than anybody can wait for.
template <int Dim>
int explicit_steps_per_frame(const SymplecticEuler<Dim, double>& stepper, double dt, int at_least) {
    constexpr int substeps_at_once = 100000;
    constexpr int most_steps = 10000;
    const double step = dt / at_least;
    const int substeps = stepper.n_substeps(step);
    require(substeps / substeps_at_once < most_steps / at_least + 1, "--duration",
            text("frames of at most ", double(substeps_at_once) * most_steps,
                 " stable steps (more --frames, or --integrator implicit)"),
            text(dt, " s between frames, with a stable step of ", stable_step(stepper.network()), " s"));
    return at_least * (1 + substeps / substeps_at_once);
}

/// Refuses more frames than this machine can hold.
void check_memory(const SimulateOptions& options, int dimension, Index n_nodes) {
    constexpr double arrays = 4; // positions, velocities, accelerations and forces
    const double needed = arrays * sizeof(double) * dimension * static_cast<double>(n_nodes) * options.frames;
    const double there = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
    require(!(there > 0) || needed <= there, "--frames", "frames that the memory of this machine can hold",
            text(options.frames, " of ", n_nodes, " nodes, which take ", std::ceil(needed / 1e9), " GB"));
}

template <int Dim>
int simulate_model(const io::Model<Dim, double>& model, const SimulateOptions& options, io::OutputFolder& folder) {
    std::vector<double> gravity = options.gravity.value_or(std::vector<double>());
    if (!options.gravity) {
        gravity.assign(Dim, 0);
        gravity[1] = -9.81;
    }
    require(gravity.size() == Dim, "--gravity", text(Dim, " numbers, separated by commas"), gravity.size());
    Scenario<Dim, double> scenario;
    scenario.name = "gravity";
    scenario.clamps.push_back({model.fixed, {}});
    scenario.gravity.push_back({Eigen::Map<const Vector<Dim, double>>(gravity.data()), {}});
    require(scenario.gravity.front().acceleration.allFinite(), "--gravity", "finite numbers",
            scenario.gravity.front().acceleration.transpose());

    RecordOptions<double> how;
    how.frames = options.frames;
    how.dt = options.duration / (options.frames - 1);
    if (options.time_step) {
        const double steps = std::ceil(how.dt / *options.time_step * (1 - 1e-12));
        require(steps <= std::numeric_limits<int>::max(), "--time-step", "a step of which a frame has at most 2e9",
                *options.time_step);
        how.steps_per_frame = static_cast<int>(steps);
    }
    check_memory(options, Dim, model.network.n_nodes());
    Terminal terminal;
    how.progress = terminal.callback();
    const auto recording = [&] {
        if (options.integrator == "implicit") {
            ImplicitEuler<Dim, double> stepper(model.network);
            return record_stepper(stepper, scenario, how);
        }
        if (options.integrator == "projective") {
            ProjectiveEuler<Dim, double> stepper(model.network);
            return record_stepper(stepper, scenario, how);
        }
        SymplecticEuler<Dim, double> stepper(model.network, {.max_substeps = std::numeric_limits<int>::max()});
        how.steps_per_frame = explicit_steps_per_frame(stepper, how.dt, how.steps_per_frame);
        return record_stepper(stepper, scenario, how);
    }();
    if (recording.status == Status::interrupted && recording.motion.n_frames() == 0) {
        throw Interrupted();
    }
    if (recording.status != Status::converged && recording.status != Status::interrupted) {
        throw InvalidArgument(
            "simulation",
            recording.status == Status::diverged
                ? "a motion that stays finite (a shorter --time-step or --integrator implicit may help)"
                : "steps that can be solved (a shorter --time-step may help)",
            text(to_string(recording.status), " after ", recording.motion.n_frames(), " of ", options.frames,
                 " frames; nothing was written"));
    }
    io::OutputGroup outputs;
    const auto write = [&](const char* name, const Motion<Dim, double>& body, const io::MotionTopology& topology,
                           const std::vector<Points<Dim, double>>& positions) {
        io::MotionWriter<Dim, double> writer(outputs, folder.path() / name, body, topology);
        for (std::size_t t = 0; t < positions.size(); ++t) {
            writer.append({.time = recording.motion.times[t], .fitted_positions = &positions[t]});
        }
        writer.finish();
    };
    write("motion.h5", recording.motion, {.kind = {}, .cells = {}, .springs = model.network.springs},
          recording.motion.positions);
    if (model.surface) {
        Motion<Dim, double> body;
        body.name = recording.motion.name;
        body.rest_positions = model.surface->rest_positions;
        body.clamped = targets_of(model.surface->from_nodes, recording.motion.clamped);
        write("surface.h5", body, io::motion_topology(*model.surface), deform(*model.surface, recording.motion));
    } else { // what a run of another model left there
        outputs.remove(folder.path() / "surface.h5");
        outputs.remove(folder.path() / "surface.xdmf");
    }
    outputs.commit();
    std::printf("wrote %lld frames of motion.h5%s and the .xdmf beside to %s\n",
                static_cast<long long>(recording.motion.n_frames()), model.surface ? ", surface.h5" : "",
                folder.path().string().c_str());
    return recording.status == Status::interrupted ? exit_interrupted : 0;
}

} // namespace

int run_simulate(const SimulateOptions& options) {
    require(!options.out.empty(), "--out", "a folder", "an empty name");
    require(options.duration > 0 && std::isfinite(options.duration), "--duration", "a positive time, s",
            options.duration);
    require(options.frames >= 2, "--frames", "at least 2", options.frames);
    require(!options.time_step || (*options.time_step > 0 && std::isfinite(*options.time_step)), "--time-step",
            "a positive time, s", options.time_step.value_or(0));
    const io::Json json = io::read_json(options.model);
    if (io::model_dimension(json, options.model) == 2) {
        const auto model = io::model_from_json<2, double>(json, options.model);
        io::OutputFolder folder(options.out);
        return simulate_model<2>(model, options, folder);
    }
    const auto model = io::model_from_json<3, double>(json, options.model);
    io::OutputFolder folder(options.out);
    return simulate_model<3>(model, options, folder);
}

} // namespace program
