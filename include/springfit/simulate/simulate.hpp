// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <springfit/motion/record.hpp>
#include <springfit/simulate/symplectic_euler.hpp>

namespace springfit {

namespace detail {

template <std::floating_point Scalar>
void check_frame_times(const std::vector<Scalar>& times) {
    require(!times.empty(), "times", "at least one frame time", "none");
    for (std::size_t t = 0; t < times.size(); ++t) {
        require(std::isfinite(times[t]) && (t == 0 ? times[t] >= 0 : times[t] > times[t - 1]), "times",
                "increasing times from 0 on", text(times[t], " at frame ", t));
    }
}

/// Calls `visit(frame, state)` with the network's state at each of `times`; stops where visit returns false. A network
/// that needs more sub-steps than allowed for some frame is not started: `iteration_limit`.
template <int Dim, std::floating_point Scalar, class Visit>
Status for_frames(SymplecticEuler<Dim, Scalar>& stepper, const Scenario<Dim, Scalar>& scenario,
                  const std::vector<Scalar>& times, int max_substeps, const Visit& visit) {
    check_frame_times(times);
    Scalar before = 0;
    for (const Scalar time : times) {
        if (time > before && stepper.n_substeps(time - before) > max_substeps) {
            return Status::iteration_limit;
        }
        before = time;
    }
    auto state = stepper.start(scenario);
    for (std::size_t t = 0; t < times.size(); ++t) {
        if (times[t] > state.time) {
            const Status status = stepper.advance(state, scenario, times[t] - state.time);
            if (status != Status::converged) {
                return status;
            }
            state.time = times[t];
        }
        if (!visit(t, state)) {
            return Status::interrupted;
        }
    }
    return Status::converged;
}

} // namespace detail

/// The motion of a network under a scenario at the frame times of another motion (increasing, s, from 0 on), by
/// symplectic Euler with sub-steps below the stable step.
///
/// Status `converged`; `diverged` with the frames before; `iteration_limit`, without frames, where the stable step is
/// so short that a frame would take more than `options.max_substeps`; `interrupted`. Throws InvalidArgument for a
/// scenario or times that do not fit. O(springs x sub-steps).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Recording<Dim, Scalar> simulate(const SpringNetwork<Dim, Scalar>& network,
                                              const Scenario<Dim, Scalar>& scenario, const std::vector<Scalar>& times,
                                              const ProgressCallback& progress = {},
                                              const SymplecticEulerOptions<Scalar>& options = {}) {
    SymplecticEuler<Dim, Scalar> stepper(network, options);
    validate(scenario, network.n_nodes());
    Recording<Dim, Scalar> recording;
    auto& motion = recording.motion;
    motion.name = scenario.name;
    motion.rest_positions = network.rest_positions;
    motion.clamped = clamped_nodes(scenario, network.n_nodes());
    recording.status = detail::for_frames<Dim, Scalar>(
        stepper, scenario, times, options.max_substeps, [&](std::size_t frame, const State<Dim, Scalar>& state) {
            motion.times.push_back(state.time);
            motion.positions.push_back(state.positions);
            motion.velocities.push_back(state.velocities);
            motion.accelerations.push_back(state.accelerations);
            motion.external_forces.push_back(external_forces<Dim, Scalar>(scenario, network.mass, state.time));
            return go_on(progress, "simulate", static_cast<double>(frame + 1) / static_cast<double>(times.size()));
        });
    return recording;
}

} // namespace springfit
