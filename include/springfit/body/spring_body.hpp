// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/body/detail/node_lanes.hpp>
#include <springfit/body/detail/packed_springs.hpp>

namespace springfit {

/// A network in motion, laid out for speed: the explicit step of real-time use.
///
///     v += h M^-1 f(x, v) ,   x += h v                                  (symplectic Euler)
///
/// with the forces of `add_spring_forces` and external forces held until they are set anew. Stable for h below
/// `stable_step(network)`; with cells, below `stable_step_at(network, positions)`. Nodes are numbered as in the network
/// outside and by locality inside. Several threads, by the `Execution`, give the same bits as one.
///
/// Memory: 12 numbers per node in space, 8 in the plane, 3 numbers and two ints per spring. A step allocates nothing
/// and costs O(springs + cells); docs/performance.md has the nanoseconds.
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
class SpringBody {
public:
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    /// At rest, free, without external forces. Throws InvalidArgument unless the network is valid.
    explicit SpringBody(const SpringNetwork<Dim, Scalar>& network, const Execution& execution = {});

    [[nodiscard]] Index n_nodes() const { return m_springs.n_nodes(); }

    /// What a body keeps in memory, bytes.
    [[nodiscard]] std::size_t bytes() const;

    [[nodiscard]] Vector<Dim, Scalar> position(int node) const;
    [[nodiscard]] Vector<Dim, Scalar> velocity(int node) const;
    /// One node, O(1): to grab it, to push it, to keep it off the ground. Node numbers are not checked.
    void set_position(int node, const Vector<Dim, Scalar>& position);
    void set_velocity(int node, const Vector<Dim, Scalar>& velocity);
    void set_external_force(int node, const Vector<Dim, Scalar>& force);
    void add_external_force(int node, const Vector<Dim, Scalar>& force);

    /// Writes positions and velocities `[Dim x n_nodes]`, m and m/s.
    void read(Points<Dim, Scalar>& positions, Points<Dim, Scalar>& velocities) const;
    /// Writes positions alone.
    void read(Points<Dim, Scalar>& positions) const;
    /// Writes the positions of these nodes `[Dim x nodes.size()]`, m, as of a surface.
    void read(const std::vector<int>& nodes, Points<Dim, Scalar>& positions) const;
    /// Sets positions and velocities `[Dim x n_nodes]`, m and m/s.
    void write(const Points<Dim, Scalar>& positions, const Points<Dim, Scalar>& velocities);
    /// Forces on the nodes from now on `[Dim x n_nodes]`, N.
    void set_external_forces(const Points<Dim, Scalar>& forces);
    /// The nodes that no force moves: they go on with the velocity they have. All others are free.
    void set_clamped(const std::vector<int>& nodes);

    /// v += h a(x, v) at the free nodes.
    void kick(Scalar h) { advance(h, false); }
    /// x += h v.
    void drift(Scalar h);
    /// `kick`, then `drift`, in one pass.
    void step(Scalar h) { advance(h, true); }

private:
    using Lanes = detail::NodeLanes<Dim, Scalar>;
    using Packed = detail::PackedSprings<Dim, Scalar>;
    using Block = typename Packed::Block;
    using Cell = detail::PackedCell<Dim, Scalar>;

    struct Record { // a struct, since a template argument cannot carry the vector attribute
        typename Lanes::Record lanes;
    };
    using Force = detail::Four<Scalar>;

    void advance(Scalar h, bool drifts);
    void add_spring_forces(const std::vector<Block>& blocks, bool on_both_ends);
    void add_cell_forces(const typename Packed::Domain& domain);

    Packed m_springs;
    Execution m_execution;
    std::vector<Scalar> m_inverse_mass;
    std::vector<Record> m_nodes;
    std::vector<Force> m_external; ///< external forces; in the last lane 1 / m, or 0 where clamped
    std::vector<Force> m_forces;   ///< of the springs and cells; 0 between steps
};

} // namespace springfit

#include <springfit/body/detail/spring_body_impl.hpp>
