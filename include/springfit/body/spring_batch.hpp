// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/body/detail/packed_cell.hpp>
#include <springfit/core/execution.hpp>
#include <springfit/solve/locality.hpp>

namespace springfit {

/// Many copies of one network stepped together, each with a state and external forces of its own, as a game with many
/// bodies of one kind or a learning loop has them.
///
/// The step is that of `SpringBody`. Bodies lie side by side in the lanes of vectors, so that a spring's values are
/// read once for as many bodies and nothing is gathered or shuffled. Groups of bodies run in parallel by the
/// `Execution`; a body's motion depends neither on the threads nor on the other bodies. Clamped nodes are those of all
/// bodies.
///
/// Memory: 4 Dim numbers per node and body. A step allocates nothing and costs O(bodies (springs + cells)).
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
class SpringBatch {
public:
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    /// Bodies at rest, free, without external forces. Throws InvalidArgument unless the network is valid and there is
    /// at least one body.
    SpringBatch(const SpringNetwork<Dim, Scalar>& network, Index n_bodies, const Execution& execution = {});

    [[nodiscard]] Index n_bodies() const { return m_n_bodies; }
    [[nodiscard]] Index n_nodes() const { return static_cast<Index>(m_order.size()); }

    /// Writes positions and velocities of one body `[Dim x n_nodes]`, m and m/s.
    void read(Index body, Points<Dim, Scalar>& positions, Points<Dim, Scalar>& velocities) const;
    /// Sets positions and velocities of one body `[Dim x n_nodes]`, m and m/s.
    void write(Index body, const Points<Dim, Scalar>& positions, const Points<Dim, Scalar>& velocities);
    /// Forces on the nodes of one body from now on `[Dim x n_nodes]`, N.
    void set_external_forces(Index body, const Points<Dim, Scalar>& forces);
    /// The nodes, of every body, that no force moves: they go on with the velocity they have. All others are free.
    void set_clamped(const std::vector<int>& nodes);

    /// One step of h of every body: v += h a(x, v), x += h v.
    void step(Scalar h);

private:
    static constexpr int lanes = 32 / static_cast<int>(sizeof(Scalar)); ///< bodies in a group
    using Lanes = detail::Lanes<Scalar, lanes>;
    using Vectors = std::array<Lanes, Dim>; ///< a vector of as many bodies

    using Cell = detail::PackedCell<Dim, Scalar>;

    struct alignas(32) Node {
        Vectors position, velocity, force, external;
    };
    struct Spring {
        int second;             ///< its upper end
        Scalar stiffness, pull; ///< k and k l
        Scalar damping;         ///< c
    };

    [[nodiscard]] Node& node(Index group, int place) {
        return m_nodes[static_cast<std::size_t>(group * n_nodes() + place)];
    }
    [[nodiscard]] const Node& node(Index group, int place) const {
        return m_nodes[static_cast<std::size_t>(group * n_nodes() + place)];
    }
    template <class Visit>
    void for_nodes(Index body, const Visit& visit);
    void add_cell_forces(Index group);
    void advance(Index group, Scalar h);

    Index m_n_bodies;
    Execution m_execution;
    std::vector<int> m_order, m_number;
    std::vector<int> m_first_spring; ///< per node, its entries of m_springs, those it is the lower end of
    std::vector<Spring> m_springs;
    std::vector<Cell> m_cells;
    std::vector<Scalar> m_own_inverse_mass, m_inverse_mass; ///< the latter 0 where clamped
    std::vector<Node> m_nodes;                              ///< group by group; forces are 0 between steps
};

} // namespace springfit

#include <springfit/body/detail/spring_batch_impl.hpp>
