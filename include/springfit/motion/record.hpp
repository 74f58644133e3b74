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
    ProgressCallback progress{}; ///< called once per step; returning false stops with the frames so far
};

/// The result of a recording.
template <int Dim, std::floating_point Scalar>
struct Recording {
    Motion<Dim, Scalar> motion;        ///< every frame up to where the status says
    Status status = Status::converged; ///< `converged`, `interrupted`, or why the stepper could not go on
};

namespace detail {

/// Throws InvalidArgument unless what a reference gave for its nodes has a column for each.
template <int Dim, std::floating_point Scalar>
void check_nodes(const Points<Dim, Scalar>& found, std::string_view what, Index n_nodes) {
    require(found.cols() == n_nodes, "reference", text(what, " [", Dim, " x ", n_nodes, "]"),
            text("[", Dim, " x ", found.cols(), "]"));
}

/// The same for all of a state; true where it is finite.
template <int Dim, std::floating_point Scalar>
bool check_state(const State<Dim, Scalar>& state, Index n_nodes) {
    check_nodes<Dim, Scalar>(state.positions, "positions", n_nodes);
    check_nodes<Dim, Scalar>(state.velocities, "velocities", n_nodes);
    check_nodes<Dim, Scalar>(state.accelerations, "accelerations", n_nodes);
    return std::isfinite(state.time) && state.positions.allFinite() && state.velocities.allFinite() &&
           state.accelerations.allFinite();
}

template <std::floating_point Scalar>
void check_masses(const Values<Scalar>& masses, Index n_nodes) {
    require(masses.size() == n_nodes, "reference", text(n_nodes, " masses, one per node"), masses.size());
}

} // namespace detail

/// Records the motion of a stepper under a scenario. Status `diverged`, with the frames before, where the stepper comes
/// to a state, or the loads to forces, that are not finite. Throws InvalidArgument for a scenario that does not fit the
/// body, and for a state or masses of another number of nodes.
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
    detail::check_masses<Scalar>(stepper.masses(), motion.n_nodes());

    const Scalar step = options.dt / static_cast<Scalar>(options.steps_per_frame);
    auto state = stepper.start(scenario);
    if (!detail::check_state<S::dimension, Scalar>(state, motion.n_nodes())) {
        recording.status = Status::diverged;
        return recording;
    }
    for (int frame = 0; frame < options.frames; ++frame) {
        for (int s = 0; frame > 0 && s < options.steps_per_frame; ++s) {
            recording.status = stepper.advance(state, scenario, step);
            if (recording.status == Status::converged &&
                !detail::check_state<S::dimension, Scalar>(state, motion.n_nodes())) {
                recording.status = Status::diverged;
            }
            if (recording.status != Status::converged) {
                return recording;
            }
            const double steps_done = frame + static_cast<double>(s + 1) / options.steps_per_frame;
            if (s + 1 < options.steps_per_frame && !go_on(options.progress, "record", steps_done / options.frames)) {
                recording.status = Status::interrupted;
                return recording;
            }
        }
        auto external = external_forces<S::dimension, Scalar>(scenario, stepper.masses(), state.time);
        if (!external.allFinite()) {
            recording.status = Status::diverged;
            return recording;
        }
        motion.times.push_back(state.time);
        motion.positions.push_back(state.positions);
        motion.velocities.push_back(state.velocities);
        motion.accelerations.push_back(state.accelerations);
        motion.external_forces.push_back(std::move(external));
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
