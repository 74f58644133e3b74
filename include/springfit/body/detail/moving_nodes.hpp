// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/body/detail/node_lanes.hpp>
#include <springfit/body/detail/packed_springs.hpp>
#include <springfit/network/volume.hpp>

namespace springfit::detail {

/// Writes the dot products of four pairs of vectors.
template <std::floating_point Scalar>
void dot_products(const Four<Scalar>* a, const Four<Scalar>* b, Scalar* target) {
    using Lanes = Simd<Scalar, 4>;
    const Lanes p = a[0].lanes * b[0].lanes, q = a[1].lanes * b[1].lanes;
    const Lanes r = a[2].lanes * b[2].lanes, s = a[3].lanes * b[3].lanes;
    const Lanes first = __builtin_shufflevector(p, q, 0, 4, 1, 5) + __builtin_shufflevector(p, q, 2, 6, 3, 7);
    const Lanes last = __builtin_shufflevector(r, s, 0, 4, 1, 5) + __builtin_shufflevector(r, s, 2, 6, 3, 7);
    *reinterpret_cast<Lanes*>(target) =
        __builtin_shufflevector(first, last, 0, 1, 4, 5) + __builtin_shufflevector(first, last, 2, 3, 6, 7);
}

/// What the bodies of the implicit steps share: the nodes, by locality inside and as in the network outside.
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
class MovingNodes {
public:
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    [[nodiscard]] Index n_nodes() const { return m_springs.n_nodes(); }

    [[nodiscard]] Vector<Dim, Scalar> position(int node) const { return vector(m_positions[place(node)]); }
    [[nodiscard]] Vector<Dim, Scalar> velocity(int node) const { return vector(m_velocities[place(node)]); }
    /// One node, O(1): to grab it, to push it, to keep it off the ground. Node numbers are not checked.
    void set_position(int node, const Vector<Dim, Scalar>& position) { set(m_positions[place(node)], position); }
    void set_velocity(int node, const Vector<Dim, Scalar>& velocity) { set(m_velocities[place(node)], velocity); }
    void set_external_force(int node, const Vector<Dim, Scalar>& force) { set(m_external[place(node)], force); }
    void add_external_force(int node, const Vector<Dim, Scalar>& force) {
        const std::size_t i = place(node);
        set(m_external[i], vector(m_external[i]) + force);
    }

    /// Writes positions and velocities `[Dim x n_nodes]`, m and m/s.
    void read(Points<Dim, Scalar>& positions, Points<Dim, Scalar>& velocities) const {
        positions.resize(Dim, n_nodes());
        velocities.resize(Dim, n_nodes());
        for (int node = 0; node < n_nodes(); ++node) {
            positions.col(node) = position(node);
            velocities.col(node) = velocity(node);
        }
    }

    /// Writes positions alone.
    void read(Points<Dim, Scalar>& positions) const {
        positions.resize(Dim, n_nodes());
        for (int node = 0; node < n_nodes(); ++node) {
            positions.col(node) = position(node);
        }
    }

    /// Writes the positions of these nodes `[Dim x nodes.size()]`, m, as of a surface.
    void read(const std::vector<int>& nodes, Points<Dim, Scalar>& positions) const {
        positions.resize(Dim, static_cast<Index>(nodes.size()));
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            positions.col(static_cast<Index>(n)) = position(nodes[n]);
        }
    }

    /// Sets positions and velocities `[Dim x n_nodes]`, m and m/s.
    void write(const Points<Dim, Scalar>& positions, const Points<Dim, Scalar>& velocities) {
        require(positions.cols() == n_nodes(), "positions", text(n_nodes(), " nodes"), positions.cols());
        require(velocities.cols() == n_nodes(), "velocities", text(n_nodes(), " nodes"), velocities.cols());
        for (int node = 0; node < n_nodes(); ++node) {
            set(m_positions[place(node)], positions.col(node));
            set(m_velocities[place(node)], velocities.col(node));
        }
    }

    /// Forces on the nodes from now on `[Dim x n_nodes]`, N.
    void set_external_forces(const Points<Dim, Scalar>& forces) {
        require(forces.cols() == n_nodes(), "forces", text(n_nodes(), " nodes"), forces.cols());
        for (int node = 0; node < n_nodes(); ++node) {
            set(m_external[place(node)], forces.col(node));
        }
    }

protected:
    MovingNodes(const SpringNetwork<Dim, Scalar>& network, const Execution& execution)
        : m_springs((validate(network), network)), m_execution(execution) {
        const auto n = static_cast<std::size_t>(network.n_nodes());
        m_positions.resize(n);
        m_velocities.resize(n);
        m_external.resize(n);
        m_mass.resize(n);
        m_is_free.assign(n, 1);
        for (int node = 0; node < n_nodes(); ++node) {
            m_mass[place(node)] = network.mass(node);
        }
        write(network.rest_positions, Points<Dim, Scalar>::Zero(Dim, network.n_nodes()));
    }

    /// Marks all nodes but these as free.
    void clamp(const std::vector<int>& nodes) {
        for (int node : nodes) {
            require(node >= 0 && node < n_nodes(), "nodes", text("node numbers in [0, ", n_nodes(), ")"), node);
        }
        std::fill(m_is_free.begin(), m_is_free.end(), char(1));
        for (int node : nodes) {
            m_is_free[place(node)] = 0;
        }
    }

    [[nodiscard]] std::size_t place(int node) const { return static_cast<std::size_t>(m_springs.number(node)); }

    template <class Lanes>
    [[nodiscard]] static Vector<Dim, Scalar> vector(const Lanes& four) {
        Vector<Dim, Scalar> result;
        for (int d = 0; d < Dim; ++d) {
            result(d) = static_cast<Scalar>(four.lanes[d]);
        }
        return result;
    }
    template <class Values>
    static void set(Four<Scalar>& four, const Values& values) {
        for (int d = 0; d < Dim; ++d) {
            four.lanes[d] = values(d);
        }
    }

    /// `body(d, domain)` for each domain, in chunks of the execution.
    template <class Body>
    void for_domains(const Body& body) const {
        const auto& domains = m_springs.domains();
        m_execution.for_chunks(static_cast<Index>(domains.size()), 1, [&](Index d, Index, Index) {
            body(static_cast<std::size_t>(d), domains[static_cast<std::size_t>(d)]);
        });
    }

    using Packed = PackedSprings<Dim, Scalar>;

    Packed m_springs;
    Execution m_execution;
    std::vector<Four<Scalar>> m_positions, m_velocities, m_external; ///< the lanes beyond Dim are 0
    std::vector<Scalar> m_mass;
    std::vector<char> m_is_free;
};

} // namespace springfit::detail
