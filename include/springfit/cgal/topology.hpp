// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numeric>
#include <tuple>

#include <CGAL/Combinatorial_map.h>

#include <springfit/mesh/topology.hpp>

namespace springfit::cgal {

namespace detail {

/// Data of a dart: the node where it starts, and the facet of the cell that it belongs to.
struct DartInfo {
    int node = -1;
    int cell = -1;
    int facet = -1;
};

struct DartItems {
    template <class Map>
    struct Dart_wrapper {
        using Dart_info = DartInfo;
        using Attributes = std::tuple<>;
    };
};

} // namespace detail

/// Neighbourhood queries of a mesh of linear cells, on a combinatorial map: of dimension 2 for triangles and
/// quadrilaterals (in the plane or as a membrane), of dimension 3 for tetrahedra and hexahedra.
///
/// Lists of nodes and cells come back ascending. Building is O(cells log cells) with about 0.8 kB per tetrahedron; a
/// query costs what it visits.
template <CellType Cell>
    requires(Cell::n_nodes == Cell::n_corners)
class Topology {
public:
    /// Throws InvalidArgument for a mesh that is not valid, a facet shared by more than two cells, and cells that share
    /// a facet but are not oriented alike.
    template <int Dim, std::floating_point Scalar>
    explicit Topology(const Mesh<Dim, Scalar, Cell>& mesh);

    Topology(const Topology&) = delete;
    Topology& operator=(const Topology&) = delete;

    [[nodiscard]] Index n_nodes() const { return static_cast<Index>(m_first_dart.size()) - 1; }

    /// Every edge once, as (lower, higher) node number in ascending order `[2 x n_edges]`.
    [[nodiscard]] NodePairs edges() const;

    /// The cells that have the node.
    [[nodiscard]] std::vector<int> cells_of_node(int node) const;

    /// The cells that have the edge between two nodes; none where no edge joins them.
    [[nodiscard]] std::vector<int> cells_of_edge(int a, int b) const;

    /// The cells that share a facet with a cell.
    [[nodiscard]] std::vector<int> cells_across(int cell) const;

    /// The nodes that an edge joins with the node.
    [[nodiscard]] std::vector<int> neighbours(int node) const { return k_ring(node, 1); }

    /// The nodes at most `k` edges away from a node, itself left out.
    [[nodiscard]] std::vector<int> k_ring(int node, int k) const;

    /// The nodes that face a node across a facet of one of its cells and that no edge joins with it.
    [[nodiscard]] std::vector<int> second_ring(int node) const
        requires SimplexCell<Cell>;

    /// The facets with a cell on one side only, oriented outwards, ordered by cell.
    [[nodiscard]] std::vector<Facet<Cell>> boundary_facets() const;

    /// The nodes on the boundary facets.
    [[nodiscard]] std::vector<int> boundary_nodes() const;

private:
    using Map = CGAL::Combinatorial_map<Cell::dimension, detail::DartItems>;
    using Dart = typename Map::Dart_handle;
    using ConstDart = typename Map::Dart_const_handle;
    static constexpr std::size_t n_facets = Cell::facets.size();

    void check_node(int node) const {
        if (!(node >= 0 && node < n_nodes())) {
            throw InvalidArgument("node", text("a number in [0, ", n_nodes(), ")"), text(node));
        }
    }
    [[nodiscard]] int node(ConstDart dart) const { return m_map.info(dart).node; }
    [[nodiscard]] ConstDart next(ConstDart dart) const { return m_map.template beta<1>(dart); }
    [[nodiscard]] bool on_boundary(ConstDart dart) const { return m_map.template is_free<Cell::dimension>(dart); }

    void add_cell(const Eigen::Matrix<int, Cell::n_nodes, 1>& corners, int cell);
    void join(const Facet<Cell>& a, const Facet<Cell>& b);
    void index_nodes(Index n_nodes);

    /// Calls `visit(dart)` for every dart that starts at the node.
    template <class Visit>
    void at_node(int node, const Visit& visit) const {
        for (int d = m_first_dart[static_cast<std::size_t>(node)]; d < m_first_dart[static_cast<std::size_t>(node) + 1];
             ++d) {
            visit(m_darts_of_node[static_cast<std::size_t>(d)]);
        }
    }

    Map m_map;
    std::vector<Dart> m_dart_of_facet; ///< one per cell and facet; in the plane it runs along the facet
    std::vector<int> m_first_dart;     ///< per node, into m_darts_of_node
    std::vector<ConstDart> m_darts_of_node;
};

template <int Dim, std::floating_point Scalar, CellType Cell>
Topology(const Mesh<Dim, Scalar, Cell>&) -> Topology<Cell>;

} // namespace springfit::cgal

#include <springfit/cgal/detail/topology_impl.hpp>
