// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include <springfit/body/spring_body.hpp>

namespace springfit {

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
SpringBody<Dim, ScalarType>::SpringBody(const SpringNetwork<Dim, Scalar>& network, const Execution& execution)
    : m_springs((validate(network), network)), m_execution(execution) {
    const auto n = static_cast<std::size_t>(network.n_nodes());
    m_nodes.assign(n, Record{});
    m_external.assign(n, Force{});
    m_forces.assign(n, Force{});
    m_inverse_mass.resize(n);
    for (std::size_t place = 0; place < n; ++place) {
        m_inverse_mass[place] = 1 / network.mass(m_springs.order()[place]);
    }
    set_clamped({});
    write(network.rest_positions, Points<Dim, Scalar>::Zero(Dim, network.n_nodes()));
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
std::size_t SpringBody<Dim, ScalarType>::bytes() const {
    const std::size_t per_node = sizeof(Record) + 2 * sizeof(Force) + sizeof(Scalar) + 2 * sizeof(int);
    std::size_t total = m_nodes.size() * per_node;
    for (const auto& domain : m_springs.domains()) {
        total += (domain.inner.size() + domain.border.size()) * sizeof(Block) + domain.cells.size() * sizeof(Cell);
    }
    return total;
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
Vector<Dim, ScalarType> SpringBody<Dim, ScalarType>::position(int node) const {
    const Record& record = m_nodes[static_cast<std::size_t>(m_springs.number(node))];
    Vector<Dim, Scalar> result;
    for (int d = 0; d < Dim; ++d) {
        result(d) = record.lanes[d];
    }
    return result;
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
Vector<Dim, ScalarType> SpringBody<Dim, ScalarType>::velocity(int node) const {
    const Record& record = m_nodes[static_cast<std::size_t>(m_springs.number(node))];
    Vector<Dim, Scalar> result;
    for (int d = 0; d < Dim; ++d) {
        result(d) = record.lanes[Lanes::velocity + d];
    }
    return result;
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBody<Dim, ScalarType>::set_position(int node, const Vector<Dim, Scalar>& position) {
    Record& record = m_nodes[static_cast<std::size_t>(m_springs.number(node))];
    for (int d = 0; d < Dim; ++d) {
        record.lanes[d] = position(d);
    }
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBody<Dim, ScalarType>::set_external_force(int node, const Vector<Dim, Scalar>& force) {
    Force& external = m_external[static_cast<std::size_t>(m_springs.number(node))];
    for (int d = 0; d < Dim; ++d) {
        external.lanes[d] = force(d);
    }
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBody<Dim, ScalarType>::add_external_force(int node, const Vector<Dim, Scalar>& force) {
    Force& external = m_external[static_cast<std::size_t>(m_springs.number(node))];
    for (int d = 0; d < Dim; ++d) {
        external.lanes[d] += force(d);
    }
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBody<Dim, ScalarType>::set_velocity(int node, const Vector<Dim, Scalar>& velocity) {
    Record& record = m_nodes[static_cast<std::size_t>(m_springs.number(node))];
    for (int d = 0; d < Dim; ++d) {
        record.lanes[Lanes::velocity + d] = velocity(d);
    }
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBody<Dim, ScalarType>::read(Points<Dim, Scalar>& positions, Points<Dim, Scalar>& velocities) const {
    positions.resize(Dim, n_nodes());
    velocities.resize(Dim, n_nodes());
    for (Index place = 0; place < n_nodes(); ++place) {
        const int node = m_springs.order()[static_cast<std::size_t>(place)];
        const Record& record = m_nodes[static_cast<std::size_t>(place)];
        for (int d = 0; d < Dim; ++d) {
            positions(d, node) = record.lanes[d];
            velocities(d, node) = record.lanes[Lanes::velocity + d];
        }
    }
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBody<Dim, ScalarType>::read(Points<Dim, Scalar>& positions) const {
    positions.resize(Dim, n_nodes());
    for (Index place = 0; place < n_nodes(); ++place) {
        const int node = m_springs.order()[static_cast<std::size_t>(place)];
        for (int d = 0; d < Dim; ++d) {
            positions(d, node) = m_nodes[static_cast<std::size_t>(place)].lanes[d];
        }
    }
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBody<Dim, ScalarType>::read(const std::vector<int>& nodes, Points<Dim, Scalar>& positions) const {
    positions.resize(Dim, static_cast<Index>(nodes.size()));
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        positions.col(static_cast<Index>(n)) = position(nodes[n]);
    }
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBody<Dim, ScalarType>::write(const Points<Dim, Scalar>& positions, const Points<Dim, Scalar>& velocities) {
    require(positions.cols() == n_nodes(), "positions", text(n_nodes(), " nodes"), positions.cols());
    require(velocities.cols() == n_nodes(), "velocities", text(n_nodes(), " nodes"), velocities.cols());
    for (Index place = 0; place < n_nodes(); ++place) {
        const int node = m_springs.order()[static_cast<std::size_t>(place)];
        Record& record = m_nodes[static_cast<std::size_t>(place)];
        for (int d = 0; d < Dim; ++d) {
            record.lanes[d] = positions(d, node);
            record.lanes[Lanes::velocity + d] = velocities(d, node);
        }
    }
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBody<Dim, ScalarType>::set_external_forces(const Points<Dim, Scalar>& forces) {
    require(forces.cols() == n_nodes(), "forces", text(n_nodes(), " nodes"), forces.cols());
    for (Index place = 0; place < n_nodes(); ++place) {
        const int node = m_springs.order()[static_cast<std::size_t>(place)];
        for (int d = 0; d < Dim; ++d) {
            m_external[static_cast<std::size_t>(place)].lanes[d] = forces(d, node);
        }
    }
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBody<Dim, ScalarType>::set_clamped(const std::vector<int>& nodes) {
    for (int node : nodes) {
        require(node >= 0 && node < n_nodes(), "nodes", text("node numbers in [0, ", n_nodes(), ")"), node);
    }
    for (std::size_t i = 0; i < m_external.size(); ++i) {
        m_external[i].lanes[3] = m_inverse_mass[i];
    }
    for (int node : nodes) {
        m_external[static_cast<std::size_t>(m_springs.number(node))].lanes[3] = 0;
    }
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBody<Dim, ScalarType>::drift(Scalar h) {
    for (Record& record : m_nodes) {
        typename Lanes::Force position, velocity;
        Lanes::split(record.lanes, position, velocity);
        Lanes::join(position + h * velocity, velocity, record.lanes);
    }
}

/// Forces of all domains first, then their nodes: a node must not move while another domain looks at it.
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBody<Dim, ScalarType>::advance(Scalar h, bool drifts) {
    const auto& domains = m_springs.domains();
    const auto n_domains = static_cast<Index>(domains.size());
    m_execution.for_chunks(n_domains, 1, [&](Index d, Index, Index) {
        const auto& domain = domains[static_cast<std::size_t>(d)];
        add_spring_forces(domain.inner, true);
        add_spring_forces(domain.border, false);
        add_cell_forces(domain);
    });
    const Scalar drift = drifts ? h : Scalar(0);
    m_execution.for_chunks(n_domains, 1, [&](Index d, Index, Index) {
        const auto end = static_cast<std::size_t>(domains[static_cast<std::size_t>(d)].end);
        for (auto i = static_cast<std::size_t>(domains[static_cast<std::size_t>(d)].begin); i < end; ++i) {
            typename Lanes::Force position, velocity;
            Lanes::split(m_nodes[i].lanes, position, velocity);
            const typename Lanes::Force external = m_external[i].lanes;
            const Scalar inverse_mass = external[3];
            velocity += (h * inverse_mass) *
                        (m_forces[i].lanes + __builtin_shufflevector(external, typename Lanes::Force{}, 0, 1, 2, 4));
            position += drift * velocity;
            Lanes::join(position, velocity, m_nodes[i].lanes);
            m_forces[i].lanes = typename Lanes::Force{};
        }
    });
}

/// The force of a spring is (k - k l / L + c (r . s) / L^2) r, and 0 where its ends meet.
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBody<Dim, ScalarType>::add_spring_forces(const std::vector<Block>& blocks, bool on_both_ends) {
    constexpr int lanes = Packed::lanes;
    using Values = detail::Lanes<Scalar, lanes>;
    for (std::size_t first = 0; first < blocks.size(); first += Packed::blocks_per_chunk) {
        const std::size_t n = std::min<std::size_t>(Packed::blocks_per_chunk, blocks.size() - first);
        const Block* const chunk = blocks.data() + first;
        alignas(64) Force vectors[Packed::blocks_per_chunk][lanes];
        alignas(64) Scalar factors[Packed::blocks_per_chunk][lanes];
        for (std::size_t b = 0; b < n; ++b) {
            const Block& block = chunk[b];
            detail::prefetch(chunk + b + Packed::blocks_ahead);
            typename Lanes::Force squares[lanes / 4], rates[lanes / 4];
            for (int group = 0; group < lanes / 4; ++group) {
                typename Lanes::Record differences[4];
                for (int l = 0; l < 4; ++l) {
                    const int lane = 4 * group + l;
                    differences[l] = m_nodes[static_cast<std::size_t>(block.second[lane])].lanes -
                                     m_nodes[static_cast<std::size_t>(block.first[lane])].lanes;
                    Lanes::vector(differences[l], vectors[b][lane].lanes);
                }
                Lanes::products(differences, squares[group], rates[group]);
            }
            alignas(32) Scalar all_squares[lanes], all_rates[lanes];
            detail::concatenate<lanes>(squares, all_squares);
            detail::concatenate<lanes>(rates, all_rates);
            const Values& rate = Values::at(all_rates);
            const Values inverse = Scalar(1) / sqrt(Values::at(all_squares) + std::numeric_limits<Scalar>::min());
            Values::at(factors[b]) = Values::at(block.stiffness) -
                                     inverse * (Values::at(block.pull) - Values::at(block.damping) * (inverse * rate));
        }
        for (std::size_t b = 0; b < n; ++b) {
            for (int lane = 0; lane < lanes; ++lane) {
                const typename Lanes::Force force = factors[b][lane] * vectors[b][lane].lanes;
                m_forces[static_cast<std::size_t>(chunk[b].first[lane])].lanes += force;
                if (on_both_ends) {
                    m_forces[static_cast<std::size_t>(chunk[b].second[lane])].lanes -= force;
                }
            }
        }
    }
}

/// The force on a corner is -kappa (V / V_0 - 1) dV/dx; those on all corners add up to 0.
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
void SpringBody<Dim, ScalarType>::add_cell_forces(const typename Packed::Domain& domain) {
    for (const Cell& cell : domain.cells) {
        const auto find = [&](int corner, Force& position) {
            Lanes::vector(m_nodes[static_cast<std::size_t>(cell.corners[corner])].lanes, position.lanes);
        };
        Force origin;
        std::array<Force, Dim> sides, gradients;
        find(0, origin);
        for (int a = 0; a < Dim; ++a) {
            find(a + 1, sides[a]);
            sides[a].lanes -= origin.lanes;
        }
        const Scalar volume = Cell::share * detail::spanned_volume<Dim>(sides, gradients);
        const Scalar pressure = Cell::share * cell.stiffness * (1 - volume * cell.inverse_volume);
        const auto add = [&](int corner, const typename Lanes::Force& force) {
            if (cell.corners[corner] >= domain.begin && cell.corners[corner] < domain.end) {
                m_forces[static_cast<std::size_t>(cell.corners[corner])].lanes += force;
            }
        };
        typename Lanes::Force total = {};
        for (int a = 0; a < Dim; ++a) {
            const typename Lanes::Force force = pressure * gradients[a].lanes;
            add(a + 1, force);
            total += force;
        }
        add(0, -total);
    }
}

} // namespace springfit
