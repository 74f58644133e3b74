// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/network/biquadratic_forces.hpp>
#include <springfit/simulate/symplectic_euler.hpp>

namespace springfit {

/// A time step, s, below which the explicit step of a biquadratic network is stable at `positions`; no eigensolver.
///
/// With s = S D the pulls along the edges (`network/biquadratic_forces.hpp`), the stiffness is at most the graph
/// Laplacian with the weights
///
///     w_i = 4 L_i sum_j |S_ij| L_j + 2 max(s_i, 0)
///
/// on the edges of each triangle, the damping matrix that with beta times the first term; from there on it is the bound
/// of `stable_step` for springs. Unlike that one it moves with the positions: the stiffness grows with the square of
/// the stretch. Infinite where nothing binds the step. O(triangles).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Scalar stable_step_at(const BiquadraticNetwork<Dim, Scalar>& network,
                                    const Points<Dim, Scalar>& positions) {
    Values<Scalar> stiffness = Values<Scalar>::Zero(network.n_nodes()); // sum of w at a node over its mass
    Values<Scalar> damping = Values<Scalar>::Zero(network.n_nodes());
    for (Index t = 0; t < network.n_triangles(); ++t) {
        const detail::BiquadraticTriangle<Dim, Scalar> triangle(network, t, positions);
        const Vector<3, Scalar> axial = triangle.axial_bounds();
        const Vector<3, Scalar> weights = axial + 2 * (triangle.s * triangle.change).cwiseMax(Scalar(0));
        for (int i = 0; i < 3; ++i) {
            for (int end = 1; end <= 2; ++end) {
                const int node = triangle.nodes((i + end) % 3);
                stiffness(node) += weights(i) / network.mass(node);
                damping(node) += network.damping * axial(i) / network.mass(node);
            }
        }
    }
    Scalar step = std::numeric_limits<Scalar>::infinity();
    for (Index t = 0; t < network.n_triangles(); ++t) {
        for (int i = 0; i < 3; ++i) {
            const int p = network.triangles(i, t);
            const int q = network.triangles((i + 1) % 3, t);
            const Scalar a = stiffness(p) + stiffness(q);
            const Scalar b = damping(p) + damping(q);
            const Scalar rate = b / 2 + std::sqrt(b * b / 4 + a);
            if (rate > 0) {
                step = std::min(step, 2 / rate);
            }
        }
    }
    return step;
}

/// Explicit stepper of a biquadratic network, in the leap-frog form of `SymplecticEuler`, whose options, order and
/// treatment of clamps it has. Sub-steps are equal within a call of `advance` and at most `step_fraction` of the stable
/// step at rest and at the call's first positions: within one frame, edges may become half as long again at a
/// fraction of 0.5. A state that is not finite is undone: `diverged`. Model of `Stepper`.
template <int Dim, std::floating_point ScalarType>
class BiquadraticEuler {
public:
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    /// Throws InvalidArgument for a network or an option that cannot be used.
    explicit BiquadraticEuler(BiquadraticNetwork<Dim, Scalar> network,
                              const SymplecticEulerOptions<Scalar>& options = {})
        : m_network(std::move(network)), m_options(options) {
        validate(m_network);
        require(options.step_fraction > 0 && options.step_fraction < 1, "step_fraction", "a value in (0, 1)",
                options.step_fraction);
        require(options.max_substeps > 0, "max_substeps", "at least one", options.max_substeps);
        m_stable_at_rest = stable_step_at(m_network, m_network.rest_positions);
    }

    [[nodiscard]] const BiquadraticNetwork<Dim, Scalar>& network() const { return m_network; }
    [[nodiscard]] const Points<Dim, Scalar>& rest_positions() const { return m_network.rest_positions; }
    [[nodiscard]] const Values<Scalar>& masses() const { return m_network.mass; }

    /// Sub-steps that `advance` takes for a step of dt from `positions`.
    [[nodiscard]] Scalar n_substeps(Scalar dt, const Points<Dim, Scalar>& positions) const {
        const Scalar stable = std::min(m_stable_at_rest, stable_step_at(m_network, positions));
        return std::max(Scalar(1), std::ceil(dt / (m_options.step_fraction * stable)));
    }

    [[nodiscard]] State<Dim, Scalar> start(const Scenario<Dim, Scalar>& scenario) const {
        return detail::start_network<Dim, Scalar>(m_network, scenario);
    }

    [[nodiscard]] Status advance(State<Dim, Scalar>& state, const Scenario<Dim, Scalar>& scenario, Scalar dt) {
        require(dt > 0 && std::isfinite(dt), "dt", "a positive time step", dt);
        const Scalar count = n_substeps(dt, state.positions);
        if (!(count <= static_cast<Scalar>(m_options.max_substeps))) {
            return Status::iteration_limit;
        }
        m_before = state;
        const Scalar h = dt / count;
        const detail::DrivenScenario<Dim, Scalar> driven(scenario, m_network.rest_positions);
        m_moves.setOnes(m_network.n_nodes());
        for (int node : driven.clamped()) {
            m_moves(node) = 0;
        }
        m_external = external_forces<Dim, Scalar>(scenario, m_network.mass, state.time);
        state.velocities += (h / 2) * state.accelerations;
        for (int s = 1; s <= static_cast<int>(count); ++s) {
            if (s > 1) {
                kick(h, state);
            }
            const Scalar time = m_before.time + dt * static_cast<Scalar>(s) / count;
            driven.aim_clamps(
                time, h, [&](int node) { return state.positions.col(node); },
                [&](int node, const Vector<Dim, Scalar>& velocity) { state.velocities.col(node) = velocity; });
            state.positions += h * state.velocities;
            if (driven.loads_vary()) {
                m_external = external_forces<Dim, Scalar>(scenario, m_network.mass, time);
            }
        }
        state.time = m_before.time + dt;
        apply_clamps<Dim, Scalar>(scenario, m_network.rest_positions, state.time, state.positions);
        kick(h / 2, state);
        detail::finish_frame<Dim, Scalar>(m_network, m_external, driven.clamped(), m_before, state);
        if (!detail::is_finite<Dim, Scalar>(state)) {
            state = m_before;
            return Status::diverged;
        }
        return Status::converged;
    }

private:
    /// v += h a at the free nodes.
    void kick(Scalar h, State<Dim, Scalar>& state) {
        compute_accelerations<Dim, Scalar>(m_network, state.positions, state.velocities, m_external, m_accelerations);
        for (Index i = 0; i < m_network.n_nodes(); ++i) {
            state.velocities.col(i) += h * m_moves(i) * m_accelerations.col(i);
        }
    }

    BiquadraticNetwork<Dim, Scalar> m_network;
    SymplecticEulerOptions<Scalar> m_options;
    Scalar m_stable_at_rest;
    Values<Scalar> m_moves; ///< 1 at free nodes, 0 at clamped ones
    Points<Dim, Scalar> m_external;
    Points<Dim, Scalar> m_accelerations;
    State<Dim, Scalar> m_before;
};

/// The stepper with which a biquadratic network is recorded. Makes it a model of `Reference`.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] BiquadraticEuler<Dim, Scalar> make_stepper(const BiquadraticNetwork<Dim, Scalar>& network) {
    return BiquadraticEuler<Dim, Scalar>(network);
}

} // namespace springfit
