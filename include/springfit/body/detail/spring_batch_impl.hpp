// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>

#include <springfit/body/spring_batch.hpp>

namespace springfit {

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
SpringBatch<Dim, ScalarType>::SpringBatch(const SpringNetwork<Dim, Scalar>& network, Index n_bodies,
                                          const Execution& execution)
    : m_n_bodies(n_bodies), m_execution(execution),
      m_order((validate(network), locality_order(network.n_nodes(), network.springs))), m_number(m_order.size()) {
    require(n_bodies > 0, "n_bodies", "at least one", n_bodies);
    const std::size_t n = m_order.size();
    m_own_inverse_mass.resize(n);
    for (std::size_t place = 0; place < n; ++place) {
        m_number[static_cast<std::size_t>(m_order[place])] = static_cast<int>(place);
        m_own_inverse_mass[place] = 1 / network.mass(m_order[place]);
    }
    m_inverse_mass = m_own_inverse_mass;
    const auto number = [&](int node) { return m_number[static_cast<std::size_t>(node)]; };
    std::vector<std::vector<Spring>> springs(n);
    for (Index e = 0; e < network.n_springs(); ++e) {
        const auto [low, high] = std::minmax({number(network.springs(0, e)), number(network.springs(1, e))});
        springs[static_cast<std::size_t>(low)].push_back(
            {high, network.stiffness(e), network.stiffness(e) * network.rest_length(e), network.damping(e)});
    }
    m_first_spring.assign(1, 0);
    for (auto& own : springs) {
        std::sort(own.begin(), own.end(), [](const Spring& a, const Spring& b) { return a.second < b.second; });
        m_springs.insert(m_springs.end(), own.begin(), own.end());
        m_first_spring.push_back(static_cast<int>(m_springs.size()));
    }
    m_cells = detail::packed_cells(network, number);
    m_nodes.assign(static_cast<std::size_t>(Execution::n_chunks(n_bodies, lanes)) * n, Node{});
    for (std::size_t i = 0; i < m_nodes.size(); ++i) {
        for (int d = 0; d < Dim; ++d) {
            m_nodes[i].position[d] = network.rest_positions(d, m_order[i % n]);
        }
    }
}

/// Calls `visit(node of the network, its values, lane)` for the nodes of a body.
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
template <class Visit>
void SpringBatch<Dim, ScalarType>::for_nodes(Index body, const Visit& visit) {
    require(body >= 0 && body < m_n_bodies, "body", text("a number in [0, ", m_n_bodies, ")"), body);
    for (Index place = 0; place < n_nodes(); ++place) {
        visit(m_order[static_cast<std::size_t>(place)], node(body / lanes, static_cast<int>(place)),
              static_cast<int>(body % lanes));
    }
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBatch<Dim, ScalarType>::read(Index body, Points<Dim, Scalar>& positions,
                                        Points<Dim, Scalar>& velocities) const {
    require(body >= 0 && body < m_n_bodies, "body", text("a number in [0, ", m_n_bodies, ")"), body);
    positions.resize(Dim, n_nodes());
    velocities.resize(Dim, n_nodes());
    for (Index place = 0; place < n_nodes(); ++place) {
        const Node& own = node(body / lanes, static_cast<int>(place));
        const int i = m_order[static_cast<std::size_t>(place)];
        for (int d = 0; d < Dim; ++d) {
            positions(d, i) = own.position[d](body % lanes);
            velocities(d, i) = own.velocity[d](body % lanes);
        }
    }
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBatch<Dim, ScalarType>::write(Index body, const Points<Dim, Scalar>& positions,
                                         const Points<Dim, Scalar>& velocities) {
    require(positions.cols() == n_nodes(), "positions", text(n_nodes(), " nodes"), positions.cols());
    require(velocities.cols() == n_nodes(), "velocities", text(n_nodes(), " nodes"), velocities.cols());
    for_nodes(body, [&](int i, Node& own, int lane) {
        for (int d = 0; d < Dim; ++d) {
            own.position[d](lane) = positions(d, i);
            own.velocity[d](lane) = velocities(d, i);
        }
    });
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBatch<Dim, ScalarType>::set_external_forces(Index body, const Points<Dim, Scalar>& forces) {
    require(forces.cols() == n_nodes(), "forces", text(n_nodes(), " nodes"), forces.cols());
    for_nodes(body, [&](int i, Node& own, int lane) {
        for (int d = 0; d < Dim; ++d) {
            own.external[d](lane) = forces(d, i);
        }
    });
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBatch<Dim, ScalarType>::set_clamped(const std::vector<int>& nodes) {
    for (int node : nodes) {
        require(node >= 0 && node < n_nodes(), "nodes", text("node numbers in [0, ", n_nodes(), ")"), node);
    }
    m_inverse_mass = m_own_inverse_mass;
    for (int node : nodes) {
        m_inverse_mass[static_cast<std::size_t>(m_number[static_cast<std::size_t>(node)])] = 0;
    }
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBatch<Dim, ScalarType>::step(Scalar h) {
    m_execution.for_chunks(Execution::n_chunks(m_n_bodies, lanes), 1, [&](Index group, Index, Index) {
        add_cell_forces(group);
        advance(group, h);
    });
}

/// All forces on a node are there once the springs that it is the lower end of are done: it can move at once, since
/// later springs do not end at it.
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBatch<Dim, ScalarType>::advance(Index group, Scalar h) {
    Node* const nodes = &node(group, 0);
    for (std::size_t i = 0; i < m_order.size(); ++i) {
        Node& own = nodes[i];
        const Vectors position = own.position;
        const Vectors velocity = own.velocity;
        Vectors force;
        for (int d = 0; d < Dim; ++d) {
            force[d] = own.force[d] + own.external[d];
        }
        for (int s = m_first_spring[i]; s < m_first_spring[i + 1]; ++s) {
            const Spring& spring = m_springs[static_cast<std::size_t>(s)];
            Node& other = nodes[spring.second];
            Vectors r;
            Lanes square = std::numeric_limits<Scalar>::min();
            Lanes rate = Scalar(0);
            for (int d = 0; d < Dim; ++d) {
                r[d] = other.position[d] - position[d];
                square += r[d] * r[d];
                rate += r[d] * (other.velocity[d] - velocity[d]);
            }
            const Lanes inverse = Scalar(1) / sqrt(square);
            const Lanes factor = spring.stiffness - inverse * (spring.pull - spring.damping * (inverse * rate));
            for (int d = 0; d < Dim; ++d) {
                const Lanes along = factor * r[d];
                force[d] += along;
                other.force[d] -= along;
            }
        }
        for (int d = 0; d < Dim; ++d) {
            own.velocity[d] = velocity[d] + (h * m_inverse_mass[i]) * force[d];
            own.position[d] = position[d] + h * own.velocity[d];
            own.force[d] = Scalar(0);
        }
    }
}

/// The force on a corner is -kappa (V / V_0 - 1) dV/dx; those on all corners add up to 0.
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBatch<Dim, ScalarType>::add_cell_forces(Index group) {
    for (const Cell& cell : m_cells) {
        Node& origin = node(group, cell.corners[0]);
        std::array<Vectors, Dim> sides, gradients;
        for (int a = 0; a < Dim; ++a) {
            const Vectors& end = node(group, cell.corners[a + 1]).position;
            for (int d = 0; d < Dim; ++d) {
                sides[a][d] = end[d] - origin.position[d];
            }
        }
        const Lanes volume = detail::spanned_volume<Dim>(sides, gradients);
        const Lanes pressure = Cell::share * cell.stiffness * (Scalar(1) - Cell::share * cell.inverse_volume * volume);
        for (int d = 0; d < Dim; ++d) {
            Lanes opposite = Scalar(0);
            for (int a = 0; a < Dim; ++a) {
                const Lanes force = pressure * gradients[a][d];
                node(group, cell.corners[a + 1]).force[d] += force;
                opposite += force;
            }
            origin.force[d] -= opposite;
        }
    }
}

} // namespace springfit
