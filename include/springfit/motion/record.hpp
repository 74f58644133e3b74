// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/progress.hpp>
#include <springfit/motion/motion.hpp>

namespace springfit {

template <std::floating_point Scalar>
struct RecordOptions {
    Scalar dt = Scalar(0.01);    ///< time between frames, s, > 0
    int frames = 50;             ///< frames to record, the start included, >= 1
    int steps_per_frame = 1;     ///< steps of dt / steps_per_frame between two frames, >= 1
    ProgressCallback progress{}; ///< called once per frame; returning false stops with the frames so far
};

/// What came of a recording.
template <int Dim, std::floating_point Scalar>
struct Recording {
    Motion<Dim, Scalar> motion;        ///< every frame up to where the status says
    Status status = Status::converged; ///< `converged`, `interrupted`, or why the stepper could not go on
};

/// Records the motion of a stepper under a scenario. Throws InvalidArgument for a scenario that does not fit the body.
template <Stepper S>
[[nodiscard]] auto record_stepper(S& stepper, const Scenario<S::dimension, typename S::Scalar>& scenario,
                                  const RecordOptions<typename S::Scalar>& options) {
    using Scalar = typename S::Scalar;
    require(options.dt > 0 && std::isfinite(options.dt), "dt", "a positive time step", options.dt);
    require(options.frames >= 1, "frames", "at least one frame", options.frames);
    require(options.steps_per_frame >= 1, "steps_per_frame", "at least one step", options.steps_per_frame);

    Recording<S::dimension, Scalar> recording;
    auto& motion = recording.motion;
    motion.name = scenario.name;
    motion.rest_positions = stepper.rest_positions();
    validate(scenario, motion.n_nodes());
    motion.clamped = clamped_nodes(scenario, motion.n_nodes());

    const Scalar step = options.dt / static_cast<Scalar>(options.steps_per_frame);
    auto state = stepper.start(scenario);
    for (int frame = 0; frame < options.frames; ++frame) {
        for (int s = 0; frame > 0 && s < options.steps_per_frame; ++s) {
            recording.status = stepper.advance(state, scenario, step);
            if (recording.status != Status::converged) {
                return recording;
            }
        }
        motion.times.push_back(state.time);
        motion.positions.push_back(state.positions);
        motion.velocities.push_back(state.velocities);
        motion.accelerations.push_back(state.accelerations);
        motion.external_forces.push_back(external_forces<S::dimension, Scalar>(scenario, stepper.masses(), state.time));
        if (!go_on(options.progress, "record", static_cast<double>(frame + 1) / options.frames)) {
            recording.status = Status::interrupted;
            return recording;
        }
    }
    return recording;
}

/// Records the motion of a reference under a scenario, with the integrator that `make_stepper` chooses for it.
template <Reference R>
[[nodiscard]] auto record(const R& reference, const Scenario<R::dimension, typename R::Scalar>& scenario,
                          const RecordOptions<typename R::Scalar>& options) {
    auto stepper = make_stepper(reference);
    return record_stepper(stepper, scenario, options);
}

} // namespace springfit
