// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fit/trajectory/detail/window_simulation.hpp>

namespace springfit::detail {

template <int Dim>
bool WindowSimulation<Dim>::add_gradient(WindowTape<Dim>& tape, NetworkValues& derivative) const {
    if (m_windows.frames == 0) {
        const ColumnBlock& y = tape.positions.front();
        ColumnBlock z;
        if (!solve(tape.turned.front(), y, y, weighted(residual(y, 0), 0), exactly, z)) {
            return false;
        }
        add_parameter_derivative<Dim>(m_system.network, y, z, derivative);
        return true;
    }
    return backwards(
        tape, [&](const ColumnBlock& state, Index frame) { return weighted(residual(state, frame), frame); },
        [&](const ColumnBlock& y, const ColumnBlock& x, const ColumnBlock& right, ColumnBlock& z) {
            return solve(m_system.preconditioner(y), y, x, right, exactly, z);
        },
        true, derivative);
}

template <int Dim>
void WindowSimulation<Dim>::add_product(WindowTape<Dim>& tape, const NetworkValues& change,
                                        NetworkValues& derivative) const {
    if (m_windows.frames == 0) {
        const ColumnBlock& y = tape.positions.front();
        ColumnBlock force = ColumnBlock::Zero(y.rows(), y.cols());
        add_parameter_forces<Dim>(m_system.network, change, y, force);
        m_system.hold(force);
        ColumnBlock u;
        (void)solve(tape.turned.front(), y, y, force, loosely, u);
        (void)solve(tape.turned.front(), y, y, weighted(u, 0), loosely, force);
        add_parameter_derivative<Dim>(m_system.network, y, force, derivative);
        return;
    }
    const std::vector<ColumnBlock> moved = forwards(tape, change);
    (void)backwards(
        tape,
        [&](const ColumnBlock&, Index frame) { return weighted(moved[static_cast<std::size_t>(frame - 1)], frame); },
        [&](const ColumnBlock& y, const ColumnBlock& x, const ColumnBlock& right, ColumnBlock& z) {
            solve_step(y, x, right, by_step, z);
            return true;
        },
        false, derivative);
}

template <int Dim>
template <class Draw>
void WindowSimulation<Dim>::add_probe(WindowTape<Dim>& tape, Draw&& draw, NetworkValues& derivative) const {
    const auto random = [&](const ColumnBlock& state, Index frame) {
        ColumnBlock z(state.rows(), state.cols());
        for (Index column = 0; column < z.cols(); ++column) {
            for (Index row = 0; row < z.rows(); ++row) {
                z(row, column) = draw() * std::sqrt(m_windows.weight(column));
            }
        }
        m_system.hold(z);
        hide_unobserved(frame, z);
        return z;
    };
    if (m_windows.frames == 0) {
        const ColumnBlock& y = tape.positions.front();
        ColumnBlock z;
        m_system.factor.solve(random(y, 0), z);
        add_parameter_derivative<Dim>(m_system.network, y, z, derivative);
        return;
    }
    (void)backwards(
        tape, [&](const ColumnBlock& state, Index frame) { return random(state, frame); },
        [&](const ColumnBlock& y, const ColumnBlock& x, const ColumnBlock& right, ColumnBlock& z) {
            solve_step(y, x, right, roughly, z);
            return true;
        },
        false, derivative);
}

/// The change of the positions at each frame along a change of the network's values.
template <int Dim>
std::vector<ColumnBlock> WindowSimulation<Dim>::forwards(WindowTape<Dim>& tape, const NetworkValues& change) const {
    std::vector<ColumnBlock> frames;
    ColumnBlock dx = ColumnBlock::Zero(tape.positions.front().rows(), tape.positions.front().cols());
    ColumnBlock dv = dx;
    ColumnBlock dy;
    for (Index segment = 0; segment < n_segments(); ++segment) {
        (void)run_segment(tape, segment);
        for (Index s = 0; s < segment_length(segment); ++s) {
            const ColumnBlock& x = tape.x[static_cast<std::size_t>(s)];
            const ColumnBlock& y = tape.y[static_cast<std::size_t>(s)];
            ColumnBlock force = ColumnBlock::Zero(x.rows(), x.cols());
            m_system.add_inertia(dx + m_part * dv, 1, force);
            add_parameter_forces<Dim>(m_system.network, change, y, force);
            if (m_system.is_damped()) {
                add_damping_product<Dim>(m_system.network, x, m_system.damping, dx, force);
                add_damping_parameter_forces<Dim>(m_system.network, change, x, m_system.damping * (y - x), force);
            }
            m_system.hold(force);
            solve_step(y, x, force, by_step, dy);
            finish_step(dy, dx, dv);
            if (const Index step = segment * m_interval + s + 1; step % m_rule.steps_per_frame == 0) {
                frames.push_back(dx);
            }
        }
    }
    return frames;
}

/// The discrete adjoint: `source(x, frame)` is what pulls at the positions of a frame, `solve(y, x, right, z)`
/// solves with the matrix of a step.
template <int Dim>
template <class Source, class Solve>
bool WindowSimulation<Dim>::backwards(WindowTape<Dim>& tape, const Source& source, const Solve& solve,
                                      bool with_directions, NetworkValues& derivative) const {
    const double alpha = m_rule.alpha;
    const double step_length = m_part / alpha;
    ColumnBlock lx = ColumnBlock::Zero(tape.positions.front().rows(), tape.positions.front().cols());
    ColumnBlock lv = lx;
    ColumnBlock z;
    for (Index segment = n_segments() - 1; segment >= 0; --segment) {
        if (!run_segment(tape, segment)) {
            return false;
        }
        for (Index s = segment_length(segment) - 1; s >= 0; --s) {
            const ColumnBlock& x = tape.x[static_cast<std::size_t>(s)];
            const ColumnBlock& y = tape.y[static_cast<std::size_t>(s)];
            if (const Index step = segment * m_interval + s + 1; step % m_rule.steps_per_frame == 0) {
                ColumnBlock end = x;
                for_lanes(end, [&](Index row, Index column) {
                    lanes(end, row, column) += (lanes(y, row, column) - lanes(x, row, column)) / alpha;
                });
                lx += source(end, step / m_rule.steps_per_frame);
            }
            ColumnBlock ly(lx.rows(), lx.cols());
            for_lanes(ly, [&](Index row, Index column) {
                const ColumnLanes share = lanes(lv, row, column) / (alpha * alpha * step_length);
                lanes(ly, row, column) = lanes(lx, row, column) / alpha + share;
                lanes(lx, row, column) = lanes(lx, row, column) * (1 - 1 / alpha) - share;
                lanes(lv, row, column) = lanes(lv, row, column) * (1 - 1 / alpha);
            });
            if (!solve(y, x, ly, z)) {
                return false;
            }
            add_parameter_derivative<Dim>(m_system.network, y, z, derivative);
            ColumnBlock inertial = ColumnBlock::Zero(x.rows(), x.cols());
            m_system.add_inertia(z, 1, inertial);
            for_lanes(inertial, [&](Index row, Index column) {
                lanes(lx, row, column) += lanes(inertial, row, column);
                lanes(lv, row, column) += m_part * lanes(inertial, row, column);
            });
            if (m_system.is_damped()) {
                const ColumnBlock rates = m_system.damping * (y - x);
                add_damping_parameter_derivative<Dim>(m_system.network, x, rates, z, derivative);
                add_damping_product<Dim>(m_system.network, x, m_system.damping, z, lx);
                if (with_directions) {
                    add_damping_derivative<Dim>(m_system.network, x, rates, z, -1, lx);
                }
            }
            m_system.hold(lx);
            m_system.hold(lv);
        }
    }
    return true;
}

} // namespace springfit::detail
