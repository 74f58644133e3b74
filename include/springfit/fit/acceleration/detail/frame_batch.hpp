// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <springfit/core/types.hpp>

namespace springfit::detail {

/// A few frames side by side, so that the same spring at all of them is one run of vector arithmetic.
///
/// Lanes are frames: node i has `Dim` runs of `lanes` numbers in each array. Always in double, whatever the data is in:
/// the sums over frames are normal equations, whose rounding the fit amplifies by the condition number.
template <int Dim, std::floating_point Scalar>
class FrameBatch {
public:
    static constexpr int lanes = 32;
    static constexpr int rows = Dim * lanes; ///< equations of one node in one batch
    using Lanes = Eigen::Array<double, lanes, 1>;
    using ConstLanes = Eigen::Map<const Lanes, Eigen::AlignedMax>;

    FrameBatch() = default;
    FrameBatch(Index n_nodes, bool velocities)
        : m_positions(Values<double>::Zero(n_nodes * rows)),
          m_velocities(Values<double>::Zero(velocities ? n_nodes * rows : 0)),
          m_loads(Values<double>::Zero(n_nodes * rows)), m_weights(Values<double>::Zero(n_nodes * lanes)) {}

    [[nodiscard]] int size() const { return m_size; }
    [[nodiscard]] bool full() const { return m_size == lanes; }

    /// Adds a frame: what the springs must give is `m_i a_i - f_i`, f_i all other forces, and its square counts
    /// `root_weights(i)^2`.
    void push(const Points<Dim, Scalar>& positions, const Points<Dim, Scalar>& velocities,
              const Points<Dim, Scalar>& accelerations, const Points<Dim, double>& forces,
              const Values<double>& root_weights) {
        Frame& frame = m_frames[static_cast<std::size_t>(m_size++)];
        frame.positions = positions;
        if (m_velocities.size() > 0) {
            frame.velocities = velocities;
        }
        frame.accelerations = accelerations;
        frame.forces = forces;
        frame.root_weights = root_weights;
    }

    /// Lays the frames side by side, for nodes [begin, end).
    void transpose(Index begin, Index end, const Values<double>& masses) {
        for (int lane = 0; lane < m_size; ++lane) {
            const Frame& frame = m_frames[static_cast<std::size_t>(lane)];
            for (Index i = begin; i < end; ++i) {
                for (int d = 0; d < Dim; ++d) {
                    const Index at = i * rows + d * lanes + lane;
                    m_positions(at) = static_cast<double>(frame.positions(d, i));
                    m_loads(at) = masses(i) * static_cast<double>(frame.accelerations(d, i)) - frame.forces(d, i);
                    if (m_velocities.size() > 0) {
                        m_velocities(at) = static_cast<double>(frame.velocities(d, i));
                    }
                }
                m_weights(i * lanes + lane) = frame.root_weights(i);
            }
        }
    }

    /// Forgets all frames.
    void clear() {
        m_size = 0;
        m_weights.setZero();
    }

    [[nodiscard]] ConstLanes position(Index node, int d) const { return run(m_positions, node * rows + d * lanes); }
    [[nodiscard]] ConstLanes velocity(Index node, int d) const { return run(m_velocities, node * rows + d * lanes); }
    [[nodiscard]] ConstLanes load(Index node, int d) const { return run(m_loads, node * rows + d * lanes); }
    [[nodiscard]] ConstLanes weight(Index node) const { return run(m_weights, node * lanes); }

private:
    struct Frame {
        Points<Dim, Scalar> positions, velocities, accelerations;
        Points<Dim, double> forces;
        Values<double> root_weights;
    };

    [[nodiscard]] static ConstLanes run(const Values<double>& values, Index first) {
        return ConstLanes(values.data() + first);
    }

    int m_size = 0;
    std::array<Frame, lanes> m_frames;
    Values<double> m_positions, m_velocities, m_loads, m_weights;
};

} // namespace springfit::detail
