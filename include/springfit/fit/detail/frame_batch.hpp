// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <springfit/core/types.hpp>

namespace springfit::detail {

/// A few frames side by side, so that the same spring at all of them is one run of vector arithmetic.
///
/// Lanes are frames: node i has `Dim` runs of `lanes` numbers in each array. Always in double, whatever the data is in:
/// the sums over frames are normal equations, whose rounding the fit amplifies by the condition number.
template <int Dim>
class FrameBatch {
public:
    static constexpr int lanes = 32;
    static constexpr int rows = Dim * lanes; ///< equations of one node in one batch
    using Lanes = Eigen::Array<double, lanes, 1>;
    using ConstLanes = Eigen::Map<const Lanes, Eigen::Aligned32>;

    FrameBatch() = default;
    FrameBatch(Index n_nodes, bool velocities)
        : m_positions(Values<double>::Zero(n_nodes * rows)),
          m_velocities(Values<double>::Zero(velocities ? n_nodes * rows : 0)),
          m_loads(Values<double>::Zero(n_nodes * rows)), m_weights(Values<double>::Zero(n_nodes * lanes)) {}

    [[nodiscard]] int size() const { return m_size; }
    [[nodiscard]] bool full() const { return m_size == lanes; }

    /// Forgets all frames.
    void clear() {
        m_size = 0;
        m_weights.setZero();
    }

    /// Adds a frame: what the springs must give is `m_i a_i - f_i`, and its square counts `root_weights(i)^2`.
    template <class Positions, class Velocities, class Accelerations, class Forces>
    void push(const Positions& positions, const Velocities& velocities, const Accelerations& accelerations,
              const Forces& forces, const Values<double>& masses, const Values<double>& root_weights) {
        const Index lane = m_size++;
        for (Index i = 0; i < positions.cols(); ++i) {
            const Index first = i * rows + lane;
            for (int d = 0; d < Dim; ++d) {
                m_positions(first + d * lanes) = static_cast<double>(positions(d, i));
                m_loads(first + d * lanes) =
                    masses(i) * static_cast<double>(accelerations(d, i)) - static_cast<double>(forces(d, i));
            }
            m_weights(i * lanes + lane) = root_weights(i);
        }
        for (Index i = 0; m_velocities.size() > 0 && i < positions.cols(); ++i) {
            for (int d = 0; d < Dim; ++d) {
                m_velocities(i * rows + d * lanes + lane) = static_cast<double>(velocities(d, i));
            }
        }
    }

    [[nodiscard]] ConstLanes position(Index node, int d) const { return run(m_positions, node * rows + d * lanes); }
    [[nodiscard]] ConstLanes velocity(Index node, int d) const { return run(m_velocities, node * rows + d * lanes); }
    [[nodiscard]] ConstLanes load(Index node, int d) const { return run(m_loads, node * rows + d * lanes); }
    [[nodiscard]] ConstLanes weight(Index node) const { return run(m_weights, node * lanes); }

private:
    [[nodiscard]] static ConstLanes run(const Values<double>& values, Index first) {
        return ConstLanes(values.data() + first);
    }

    int m_size = 0;
    Values<double> m_positions, m_velocities, m_loads, m_weights;
};

} // namespace springfit::detail
