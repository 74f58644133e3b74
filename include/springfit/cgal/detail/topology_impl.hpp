// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cgal/topology.hpp>

namespace springfit::cgal {

namespace detail {

inline std::vector<int> ascending(std::vector<int> numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    return numbers;
}

} // namespace detail

template <CellType Cell>
    requires(Cell::n_nodes == Cell::n_corners)
template <int Dim, std::floating_point Scalar>
Topology<Cell>::Topology(const Mesh<Dim, Scalar, Cell>& mesh) {
    validate(mesh);
    m_dart_of_facet.reserve(n_facets * static_cast<std::size_t>(mesh.n_cells()));
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        add_cell(mesh.cells.col(c), static_cast<int>(c));
    }
    springfit::detail::for_shared_facets(mesh, [&](const std::vector<Facet<Cell>>& shared) {
        if (shared.size() > 2) {
            throw InvalidArgument("mesh", "facets shared by at most two cells",
                                  text(shared.size(), " cells at a facet of cell ", shared[0].cell));
        }
        if (shared.size() == 2) {
            join(shared[0], shared[1]);
        }
    });
    index_nodes(mesh.n_nodes());
}

template <CellType Cell>
    requires(Cell::n_nodes == Cell::n_corners)
void Topology<Cell>::add_cell(const Eigen::Matrix<int, Cell::n_nodes, 1>& corners, int cell) {
    const auto make_ring = [&](const auto& local, int facet) {
        std::vector<Dart> ring;
        for (std::size_t a = 0; a < local.size(); ++a) {
            const int number = Cell::dimension == 2 ? static_cast<int>(a) : facet;
            ring.push_back(m_map.create_dart(detail::DartInfo{corners(local[a]), cell, number}));
        }
        for (std::size_t a = 0; a < ring.size(); ++a) {
            m_map.template link_beta<1>(ring[a], ring[(a + 1) % ring.size()]);
        }
        return ring;
    };
    if constexpr (Cell::dimension == 2) { // one ring; dart a runs along facet a
        std::array<int, Cell::n_corners> local;
        for (std::size_t a = 0; a < local.size(); ++a) {
            local[a] = Cell::facets[a][0];
        }
        const auto ring = make_ring(local, 0);
        m_dart_of_facet.insert(m_dart_of_facet.end(), ring.begin(), ring.end());
    } else { // a ring per face; the two darts along each edge are joined
        std::array<std::array<Dart, Cell::n_corners>, Cell::n_corners> along{};
        for (std::size_t f = 0; f < n_facets; ++f) {
            const auto& local = Cell::facets[f];
            const auto ring = make_ring(local, static_cast<int>(f));
            m_dart_of_facet.push_back(ring.front());
            for (std::size_t a = 0; a < local.size(); ++a) {
                const auto from = static_cast<std::size_t>(local[a]);
                const auto to = static_cast<std::size_t>(local[(a + 1) % local.size()]);
                along[from][to] = ring[a];
                if (along[to][from] != Dart{}) {
                    m_map.template link_beta<2>(ring[a], along[to][from]);
                }
            }
        }
    }
}

template <CellType Cell>
    requires(Cell::n_nodes == Cell::n_corners)
void Topology<Cell>::join(const Facet<Cell>& a, const Facet<Cell>& b) {
    const auto dart_of = [&](const Facet<Cell>& facet) {
        return m_dart_of_facet[n_facets * static_cast<std::size_t>(facet.cell) + static_cast<std::size_t>(facet.local)];
    };
    Dart p = dart_of(a);
    Dart q = dart_of(b);
    if constexpr (Cell::dimension == 3) {
        while (node(q) != node(next(p))) { // both facets have the same corners
            q = m_map.template beta<1>(q);
        }
    }
    for (std::size_t i = 0; i < (Cell::dimension == 3 ? a.corners.size() : 1); ++i) {
        if (node(p) != node(next(q)) || node(q) != node(next(p))) {
            throw InvalidArgument("mesh", "cells oriented alike",
                                  text("cells ", a.cell, " and ", b.cell, " oriented against each other"));
        }
        m_map.template link_beta<Cell::dimension>(p, q);
        p = m_map.template beta<1>(p);
        q = m_map.template beta<0>(q);
    }
}

template <CellType Cell>
    requires(Cell::n_nodes == Cell::n_corners)
void Topology<Cell>::index_nodes(Index n_nodes) {
    m_first_dart.assign(static_cast<std::size_t>(n_nodes) + 1, 0);
    const Map& map = m_map;
    for (auto d = map.darts().begin(); d != map.darts().end(); ++d) {
        ++m_first_dart[static_cast<std::size_t>(node(d)) + 1];
    }
    std::partial_sum(m_first_dart.begin(), m_first_dart.end(), m_first_dart.begin());
    std::vector<int> end(m_first_dart.begin(), m_first_dart.end() - 1);
    m_darts_of_node.resize(m_map.number_of_darts());
    for (auto d = map.darts().begin(); d != map.darts().end(); ++d) {
        m_darts_of_node[static_cast<std::size_t>(end[static_cast<std::size_t>(node(d))]++)] = d;
    }
}

template <CellType Cell>
    requires(Cell::n_nodes == Cell::n_corners)
NodePairs Topology<Cell>::edges() const {
    std::vector<std::array<int, 2>> pairs;
    for (auto edge = m_map.template one_dart_per_cell<1>().begin(); edge != m_map.template one_dart_per_cell<1>().end();
         ++edge) {
        pairs.push_back({node(edge), node(next(edge))});
    }
    return springfit::detail::sorted_unique_pairs(pairs);
}

template <CellType Cell>
    requires(Cell::n_nodes == Cell::n_corners)
std::vector<int> Topology<Cell>::cells_of_node(int i) const {
    check_node(i);
    std::vector<int> cells;
    at_node(i, [&](ConstDart dart) { cells.push_back(m_map.info(dart).cell); });
    return detail::ascending(std::move(cells));
}

template <CellType Cell>
    requires(Cell::n_nodes == Cell::n_corners)
std::vector<int> Topology<Cell>::cells_of_edge(int a, int b) const {
    check_node(a);
    check_node(b);
    std::vector<int> cells;
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
        at_node(from, [&, end = to](ConstDart dart) {
            if (node(next(dart)) == end) {
                cells.push_back(m_map.info(dart).cell);
            }
        });
    }
    return detail::ascending(std::move(cells));
}

template <CellType Cell>
    requires(Cell::n_nodes == Cell::n_corners)
std::vector<int> Topology<Cell>::cells_across(int cell) const {
    const auto n_cells = static_cast<int>(m_dart_of_facet.size() / n_facets);
    require(cell >= 0 && cell < n_cells, "cell", text("a number in [0, ", n_cells, ")"), cell);
    std::vector<int> cells;
    for (std::size_t f = 0; f < n_facets; ++f) {
        const ConstDart dart = m_dart_of_facet[n_facets * static_cast<std::size_t>(cell) + f];
        if (!on_boundary(dart)) {
            cells.push_back(m_map.info(m_map.template beta<Cell::dimension>(dart)).cell);
        }
    }
    return detail::ascending(std::move(cells));
}

template <CellType Cell>
    requires(Cell::n_nodes == Cell::n_corners)
std::vector<int> Topology<Cell>::k_ring(int i, int k) const {
    check_node(i);
    require(k >= 0, "k", "a number of edges not below 0", k);
    std::vector<int> reached{i};
    std::vector<int> front{i};
    for (int ring = 0; ring < k && !front.empty(); ++ring) {
        std::vector<int> around;
        for (const int from : front) {
            at_node(from, [&](ConstDart dart) {
                around.push_back(node(next(dart)));
                around.push_back(node(m_map.template beta<0>(dart)));
            });
        }
        front.clear();
        around = detail::ascending(std::move(around));
        std::set_difference(around.begin(), around.end(), reached.begin(), reached.end(), std::back_inserter(front));
        reached.insert(reached.end(), front.begin(), front.end());
        std::sort(reached.begin(), reached.end());
    }
    std::erase(reached, i);
    return reached;
}

template <CellType Cell>
    requires(Cell::n_nodes == Cell::n_corners)
std::vector<int> Topology<Cell>::second_ring(int i) const
    requires SimplexCell<Cell>
{
    check_node(i);
    std::vector<int> facing;
    at_node(i, [&](ConstDart dart) {
        ConstDart opposite = next(dart); // along the facet that faces node i
        if constexpr (Cell::dimension == 3) {
            opposite = m_map.template beta<2>(opposite);
        }
        if (on_boundary(opposite)) {
            return;
        }
        ConstDart across = m_map.template beta<Cell::dimension>(opposite);
        if constexpr (Cell::dimension == 3) {
            across = m_map.template beta<2>(across);
        }
        facing.push_back(node(next(next(across))));
    });
    facing = detail::ascending(std::move(facing));
    std::erase(facing, i);
    const std::vector<int> first = neighbours(i);
    std::vector<int> second;
    std::set_difference(facing.begin(), facing.end(), first.begin(), first.end(), std::back_inserter(second));
    return second;
}

template <CellType Cell>
    requires(Cell::n_nodes == Cell::n_corners)
std::vector<Facet<Cell>> Topology<Cell>::boundary_facets() const {
    std::vector<Facet<Cell>> boundary;
    for (const ConstDart first : m_dart_of_facet) {
        if (on_boundary(first)) {
            Facet<Cell> facet{{}, m_map.info(first).cell, m_map.info(first).facet};
            ConstDart dart = first;
            for (int& corner : facet.corners) {
                corner = node(dart);
                dart = next(dart);
            }
            boundary.push_back(facet);
        }
    }
    return boundary;
}

template <CellType Cell>
    requires(Cell::n_nodes == Cell::n_corners)
std::vector<int> Topology<Cell>::boundary_nodes() const {
    std::vector<int> nodes;
    for (const auto& facet : boundary_facets()) {
        nodes.insert(nodes.end(), facet.corners.begin(), facet.corners.end());
    }
    return detail::ascending(std::move(nodes));
}

} // namespace springfit::cgal
