// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/simulate/symplectic_euler.hpp>

namespace springfit {

template <int Dim, std::floating_point Scalar>
SymplecticEuler<Dim, Scalar>::SymplecticEuler(SpringNetwork<Dim, Scalar> network,
                                              const SymplecticEulerOptions<Scalar>& options)
    : m_network(std::move(network)), m_options(options), m_body(m_network) {
    require(options.step_fraction > 0 && options.step_fraction < 1, "step_fraction", "a value in (0, 1)",
            options.step_fraction);
    require(options.max_substeps > 0, "max_substeps", "at least one", options.max_substeps);
    m_longest_substep = options.step_fraction * stable_step(m_network);
}

template <int Dim, std::floating_point Scalar>
Status SymplecticEuler<Dim, Scalar>::advance(State<Dim, Scalar>& state, const Scenario<Dim, Scalar>& scenario,
                                             Scalar dt) {
    require(dt > 0 && std::isfinite(dt), "dt", "a positive time step", dt);
    Scalar longest = m_longest_substep;
    if (m_network.n_cells() > 0) {
        longest = std::min(longest, m_options.step_fraction *
                                        detail::stable_step_unchecked<Dim, Scalar>(m_network, state.positions));
    }
    const int substeps = n_substeps(dt, longest);
    if (substeps > m_options.max_substeps) {
        return Status::iteration_limit;
    }
    m_before = state;
    const Scalar h = dt / static_cast<Scalar>(substeps);
    const detail::DrivenScenario<Dim, Scalar> driven(scenario, m_network.rest_positions);
    m_external = external_forces<Dim, Scalar>(scenario, m_network.mass, state.time);

    m_body.set_clamped(driven.clamped());
    m_body.set_external_forces(m_external);
    state.velocities += (h / 2) * state.accelerations;
    m_body.write(state.positions, state.velocities);
    for (int s = 1; s <= substeps; ++s) {
        const Scalar time = state.time + dt * static_cast<Scalar>(s) / static_cast<Scalar>(substeps);
        driven.aim_clamps(
            time, h, [&](int node) { return m_body.position(node); },
            [&](int node, const Vector<Dim, Scalar>& velocity) { m_body.set_velocity(node, velocity); });
        if (s == 1) {
            m_body.drift(h);
        } else {
            m_body.step(h);
        }
        if (driven.loads_vary()) {
            m_external = external_forces<Dim, Scalar>(scenario, m_network.mass, time);
            m_body.set_external_forces(m_external);
        }
    }
    m_body.kick(h / 2);
    m_body.read(state.positions, state.velocities);
    state.time += dt;
    apply_clamps<Dim, Scalar>(scenario, m_network.rest_positions, state.time, state.positions);
    detail::finish_frame<Dim, Scalar>(m_network, m_external, driven.clamped(), m_before, state);
    if (!detail::is_finite<Dim, Scalar>(state)) {
        state = m_before;
        return Status::diverged;
    }
    return Status::converged;
}

template <int Dim, std::floating_point Scalar>
int SymplecticEuler<Dim, Scalar>::n_substeps(Scalar dt, Scalar longest) {
    const Scalar count = std::ceil(dt / longest);
    constexpr int most = std::numeric_limits<int>::max();
    return count < static_cast<Scalar>(most) ? std::max(1, static_cast<int>(count)) : most;
}

} // namespace springfit
