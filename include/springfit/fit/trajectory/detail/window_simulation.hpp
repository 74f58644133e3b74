// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fit/trajectory/detail/implicit_block.hpp>
#include <springfit/fit/trajectory/detail/windows.hpp>
#include <springfit/motion/motion.hpp>
#include <springfit/network/forces.hpp>

namespace springfit::detail {

/// The rule of a step of h from (x, v): y is where an implicit Euler step of alpha h leads, and the step is carried on
/// from there in a straight line, x+ = x + (y - x) / alpha, v+ = v + ((y - x) / (alpha h) - v) / alpha: implicit Euler
/// at alpha = 1, the implicit midpoint rule at 1/2.
struct StepRule {
    double alpha = 0.5;
    int steps_per_frame = 1;
};

/// The record of a simulated block: its states at checkpoints, and all steps of one segment between them.
template <int Dim>
struct WindowTape {
    std::vector<CorotatedBlockPreconditioner<Dim>> turned; ///< of a static case: the factor turned to the equilibrium
    std::vector<ColumnBlock> positions, velocities; ///< at the start of each segment; of a static case, the equilibrium
    Index segment = -1;                             ///< whose steps are kept
    std::vector<ColumnBlock> x, v, y;               ///< of each step of that segment
};

/// The motions of a network in one block of windows, and their derivatives.
template <int Dim>
class WindowSimulation {
public:
    using Motions = std::vector<Motion<Dim, double>>;

    WindowSimulation(const WindowBlock& windows, const WindowGroup<Dim>& group, const Motions& motions,
                     const StepRule& rule, Index checkpoint_interval, const SpringNetwork<Dim, double>& network,
                     const BlockCholesky& factor)
        : m_windows(windows), m_motions(motions), m_rule(rule), m_part(rule.alpha * group.step),
          m_system{network, group.clamped, factor, group.step > 0 ? 1 / (m_part * m_part) : 0.,
                   group.step > 0 ? 1 / m_part : 0.},
          m_n_steps(windows.frames * rule.steps_per_frame), m_interval(checkpoint_interval) {}

    /// Newton iterations from the equilibrium of another network: one that is farther away is not worth the search.
    static constexpr int max_iterations_near = 30;

    /// Simulates; `misfit` is sum weight |x - x_ref|^2. `near` is where static equilibria are looked for, in few
    /// iterations; null: at the reference, and where none is found there, at rest. False where the network does not
    /// come to balance.
    [[nodiscard]] bool simulate(WindowTape<Dim>& tape, const WindowTape<Dim>* near, double& misfit) const {
        tape = {};
        misfit = 0;
        if (m_windows.frames == 0) {
            const ColumnBlock reference = gather(&Motion<Dim, double>::positions, 0, 0);
            const ColumnBlock external = gather(&Motion<Dim, double>::external_forces, 0, 0);
            const bool is_near = near != nullptr && !near->positions.empty();
            ColumnBlock y = is_near ? near->positions.front() : reference;
            set_clamped(reference, y);
            const bool is_balanced = is_near
                                         ? solve_implicit<Dim>(m_system, reference, y, external, y, max_iterations_near)
                                         : solve_implicit<Dim>(m_system, reference, y, external, y);
            if (!is_balanced && is_near) {
                return false;
            }
            if (!is_balanced) {
                y = rest(reference);
                set_clamped(reference, y);
                if (!solve_implicit<Dim>(m_system, reference, y, external, y)) {
                    return false;
                }
            }
            misfit = weighted_square(residual(y, 0));
            tape.turned.push_back(m_system.preconditioner(y));
            tape.positions.push_back(std::move(y));
            return true;
        }
        ColumnBlock x = gather(&Motion<Dim, double>::positions, 0, 0);
        ColumnBlock v = gather(&Motion<Dim, double>::velocities, 0, 0);
        for (Index segment = 0; segment < n_segments(); ++segment) {
            tape.positions.push_back(x);
            tape.velocities.push_back(v);
            if (!run_segment(tape, segment)) {
                return false;
            }
            for (Index s = 0; s < segment_length(segment); ++s) {
                x = tape.x[static_cast<std::size_t>(s)];
                v = tape.v[static_cast<std::size_t>(s)];
                finish_step(tape.y[static_cast<std::size_t>(s)], x, v);
                if (const Index step = segment * m_interval + s + 1; step % m_rule.steps_per_frame == 0) {
                    misfit += weighted_square(residual(x, step / m_rule.steps_per_frame));
                }
            }
        }
        return std::isfinite(misfit);
    }

    /// derivative += 1/2 d misfit / d network's values, by the adjoint. False where a state is not stable.
    [[nodiscard]] bool add_gradient(WindowTape<Dim>& tape, NetworkValues& derivative) const;

    /// derivative += J' W J change, J the derivative of the positions but for that of the springs' directions in
    /// damping.
    void add_product(WindowTape<Dim>& tape, const NetworkValues& change, NetworkValues& derivative) const;

    /// derivative += J' W^(1/2) z for numbers z, one for each coordinate of each frame, from `draw()`.
    template <class Draw>
    void add_probe(WindowTape<Dim>& tape, Draw&& draw, NetworkValues& derivative) const;

private:
    using Frames = std::vector<Points<Dim, double>>;

    [[nodiscard]] Index n_segments() const { return (m_n_steps + m_interval - 1) / m_interval; }
    [[nodiscard]] Index segment_length(Index segment) const {
        return std::min(m_interval, m_n_steps - segment * m_interval);
    }

    /// A recorded quantity of each window, `fraction` of the way from one of its frames to the next.
    [[nodiscard]] ColumnBlock gather(Frames Motion<Dim, double>::* quantity, Index frame, double fraction) const {
        const auto columns = static_cast<Index>(m_windows.motions.size());
        ColumnBlock result(Dim * m_system.network.n_nodes(), columns);
        for (Index c = 0; c < columns; ++c) {
            const auto& motion = m_motions[m_windows.motions[static_cast<std::size_t>(c)]];
            const auto at = static_cast<std::size_t>(m_windows.first[static_cast<std::size_t>(c)] + frame);
            const auto& here = (motion.*quantity)[at];
            result.col(c) = here.reshaped();
            if (fraction > 0) {
                result.col(c) += fraction * ((motion.*quantity)[at + 1] - here).reshaped();
            }
        }
        return result;
    }

    /// The rest shape in every column, as `like` is sized.
    [[nodiscard]] ColumnBlock rest(const ColumnBlock& like) const {
        return m_system.network.rest_positions.reshaped().replicate(1, like.cols());
    }

    void set_clamped(const ColumnBlock& from, ColumnBlock& to) const {
        for (int node : m_system.clamped) {
            to.middleRows<Dim>(Dim * node) = from.middleRows<Dim>(Dim * node);
        }
    }

    /// x - x_ref at a frame of the windows; 0 at clamped nodes and where nothing was seen.
    [[nodiscard]] ColumnBlock residual(const ColumnBlock& x, Index frame) const {
        ColumnBlock result = x - gather(&Motion<Dim, double>::positions, frame, 0);
        m_system.hold(result);
        hide_unobserved(frame, result);
        return result;
    }

    void hide_unobserved(Index frame, ColumnBlock& block) const {
        for (Index c = 0; c < block.cols(); ++c) {
            const auto& motion = m_motions[m_windows.motions[static_cast<std::size_t>(c)]];
            if (motion.unobserved.empty()) {
                continue;
            }
            const auto at = static_cast<std::size_t>(m_windows.first[static_cast<std::size_t>(c)] + frame);
            for (int node : motion.unobserved[at]) {
                block.col(c).template segment<Dim>(Dim * node).setZero();
            }
        }
    }

    [[nodiscard]] double weighted_square(const ColumnBlock& residual) const {
        return (column_dots(residual, residual) * m_windows.weight.array()).sum();
    }

    /// W block, the derivative of the objective by the positions of a frame: no weight where nothing was seen.
    [[nodiscard]] ColumnBlock weighted(const ColumnBlock& block, Index frame) const {
        ColumnBlock result = block * m_windows.weight.asDiagonal();
        hide_unobserved(frame, result);
        return result;
    }

    void finish_step(const ColumnBlock& y, ColumnBlock& x, ColumnBlock& v) const {
        for_lanes(y, [&](Index row, Index column) {
            const ColumnLanes moved = lanes(y, row, column) - lanes(x, row, column);
            lanes(x, row, column) += moved / m_rule.alpha;
            lanes(v, row, column) += (moved / m_part - lanes(v, row, column)) / m_rule.alpha;
        });
    }

    /// Makes the tape hold the steps of a segment, from its checkpoint.
    [[nodiscard]] bool run_segment(WindowTape<Dim>& tape, Index segment) const {
        if (tape.segment == segment) {
            return true;
        }
        tape.segment = -1;
        tape.x.clear();
        tape.v.clear();
        tape.y.clear();
        ColumnBlock x = tape.positions[static_cast<std::size_t>(segment)];
        ColumnBlock v = tape.velocities[static_cast<std::size_t>(segment)];
        for (Index s = 0; s < segment_length(segment); ++s) {
            const Index step = segment * m_interval + s;
            const Index frame = step / m_rule.steps_per_frame;
            const double fraction = (static_cast<double>(step % m_rule.steps_per_frame) + m_rule.alpha) /
                                    static_cast<double>(m_rule.steps_per_frame);
            const ColumnBlock target = x + m_part * v;
            ColumnBlock y = target;
            set_clamped(gather(&Motion<Dim, double>::positions, frame, fraction), y);
            if (!solve_implicit<Dim>(m_system, target, x,
                                     gather(&Motion<Dim, double>::external_forces, frame, fraction), y)) {
                return false;
            }
            tape.x.push_back(x);
            tape.v.push_back(v);
            finish_step(y, x, v);
            tape.y.push_back(std::move(y));
        }
        tape.segment = segment;
        return true;
    }

    /// The accuracy of a linear solve.
    struct Precision {
        double tolerance;
        int max_iterations;
    };
    static constexpr Precision exactly{1e-10, 300}; ///< for gradients
    static constexpr Precision loosely{1e-2, 20};   ///< for products of static cases with a Gauss-Newton matrix
    static constexpr Precision by_step{1e-3, 40};   ///< for those of motions in time
    static constexpr Precision roughly{1e-1, 20};   ///< for estimates of its diagonal

    [[nodiscard]] bool solve(const CorotatedBlockPreconditioner<Dim>& factor, const ColumnBlock& y,
                             const ColumnBlock& old, const ColumnBlock& right, const Precision& precision,
                             ColumnBlock& z) const {
        return solve_to(factor, y, old, right, precision.tolerance * column_norms(right), precision.max_iterations, z);
    }

    [[nodiscard]] bool solve_to(const CorotatedBlockPreconditioner<Dim>& factor, const ColumnBlock& y,
                                const ColumnBlock& old, const ColumnBlock& right, const Eigen::ArrayXd& goal,
                                int max_iterations, ColumnBlock& z) const {
        return block_conjugate_gradients(
            factor, [&](const ColumnBlock& p, ColumnBlock& q) { m_system.multiply(y, old, HessianForm::exact, p, q); },
            right, goal, max_iterations, z);
    }

    /// Solves a step's system for what is left of z beside that of free flight, p^2 M^-1 right, p = alpha h, to a part
    /// of the lesser of the two right-hand sides: what steps add up is as accurate then as a step is, however many they
    /// are. (Of z as a whole the forces of a short step are a part that a loose solve would not see.)
    void solve_step(const ColumnBlock& y, const ColumnBlock& old, const ColumnBlock& right, const Precision& precision,
                    ColumnBlock& z) const {
        z = right;
        m_system.divide_by_inertia(z);
        ColumnBlock left, rest;
        m_system.multiply(y, old, HessianForm::exact, z, left);
        left = right - left;
        const Eigen::ArrayXd goal = precision.tolerance * column_norms(left).min(column_norms(right));
        (void)solve_to(m_system.preconditioner(y), y, old, left, goal, precision.max_iterations, rest);
        z += rest;
    }

    [[nodiscard]] std::vector<ColumnBlock> forwards(WindowTape<Dim>& tape, const NetworkValues& change) const;

    template <class Source, class Solve>
    [[nodiscard]] bool backwards(WindowTape<Dim>& tape, const Source& source, const Solve& solve, bool with_directions,
                                 NetworkValues& derivative) const;

    const WindowBlock& m_windows;
    const Motions& m_motions;
    StepRule m_rule;
    double m_part; ///< alpha h
    ImplicitSystem<Dim> m_system;
    Index m_n_steps;
    Index m_interval;
};

} // namespace springfit::detail

#include <springfit/fit/trajectory/detail/window_derivatives_impl.hpp>
