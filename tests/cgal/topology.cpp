// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <set>

#include <springfit/cgal/topology.hpp>
#include <springfit/mesh/structured.hpp>

using namespace springfit;

namespace {

/// Holds every query against a plain search through the cells.
template <int Dim, class Cell>
void check_queries(const Mesh<Dim, double, Cell>& mesh) {
    const cgal::Topology topology(mesh);
    CHECK(topology.n_nodes() == mesh.n_nodes());
    const NodePairs pairs = edges(mesh);
    CHECK(topology.edges() == pairs);
    CHECK(topology.boundary_nodes() == boundary_nodes(mesh));

    const auto key = [](const Facet<Cell>& facet) {
        auto corners = facet.corners;
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        return std::tuple(facet.cell, facet.local, corners);
    };
    std::set<decltype(key(std::declval<Facet<Cell>>()))> expected_facets;
    std::set<decltype(key(std::declval<Facet<Cell>>()))> facets;
    for (const auto& facet : boundary_facets(mesh)) {
        expected_facets.insert(key(facet));
    }
    for (const auto& facet : topology.boundary_facets()) {
        facets.insert(key(facet));
    }
    CHECK(facets == expected_facets);

    std::vector<std::set<int>> near(static_cast<std::size_t>(mesh.n_nodes()));
    for (Index e = 0; e < pairs.cols(); ++e) {
        near[static_cast<std::size_t>(pairs(0, e))].insert(pairs(1, e));
        near[static_cast<std::size_t>(pairs(1, e))].insert(pairs(0, e));
    }
    const auto has = [&](Index cell, int node) { return (mesh.cells.col(cell).array() == node).any(); };
    for (int i = 0; i < mesh.n_nodes(); ++i) {
        std::vector<int> cells;
        for (int c = 0; c < mesh.n_cells(); ++c) {
            if (has(c, i)) {
                cells.push_back(c);
            }
        }
        CHECK(topology.cells_of_node(i) == cells);
        const auto& around = near[static_cast<std::size_t>(i)];
        CHECK(topology.neighbours(i) == std::vector<int>(around.begin(), around.end()));
        std::set<int> two(around);
        for (const int j : around) {
            two.insert(near[static_cast<std::size_t>(j)].begin(), near[static_cast<std::size_t>(j)].end());
        }
        two.erase(i);
        CHECK(topology.k_ring(i, 2) == std::vector<int>(two.begin(), two.end()));
        CHECK(topology.k_ring(i, 0).empty());
        CHECK(topology.k_ring(i, 1000).size() == static_cast<std::size_t>(mesh.n_nodes() - 1));
    }
    for (Index e = 0; e < pairs.cols(); ++e) {
        std::vector<int> cells;
        for (int c = 0; c < mesh.n_cells(); ++c) {
            const auto joins = [&](const auto& local) {
                const int a = mesh.cells(local[0], c);
                const int b = mesh.cells(local[1], c);
                return std::min(a, b) == pairs(0, e) && std::max(a, b) == pairs(1, e);
            };
            if (std::any_of(Cell::edges.begin(), Cell::edges.end(), joins)) {
                cells.push_back(c);
            }
        }
        CHECK(topology.cells_of_edge(pairs(0, e), pairs(1, e)) == cells);
        CHECK(topology.cells_of_edge(pairs(1, e), pairs(0, e)) == cells);
    }
    std::size_t shared = 0;
    for (int c = 0; c < mesh.n_cells(); ++c) {
        for (const int other : topology.cells_across(c)) {
            const auto back = topology.cells_across(other);
            CHECK(std::count(back.begin(), back.end(), c) == 1);
            ++shared;
        }
    }
    CHECK(shared + expected_facets.size() == Cell::facets.size() * static_cast<std::size_t>(mesh.n_cells()));

    if constexpr (SimplexCell<Cell>) {
        const NodePairs ring = second_ring(mesh);
        std::vector<std::set<int>> facing(static_cast<std::size_t>(mesh.n_nodes()));
        for (Index p = 0; p < ring.cols(); ++p) {
            facing[static_cast<std::size_t>(ring(0, p))].insert(ring(1, p));
            facing[static_cast<std::size_t>(ring(1, p))].insert(ring(0, p));
        }
        for (int i = 0; i < mesh.n_nodes(); ++i) {
            const auto& expected = facing[static_cast<std::size_t>(i)];
            CHECK(topology.second_ring(i) == std::vector<int>(expected.begin(), expected.end()));
        }
    }
}

template <class Cell>
Mesh<3, double, Cell> lifted(const Mesh<2, double, Cell>& flat) {
    Mesh<3, double, Cell> mesh{Points<3, double>(3, flat.n_nodes()), flat.cells};
    mesh.nodes << flat.nodes, flat.nodes.row(0).array().sin().matrix();
    return mesh;
}

} // namespace

TEST_CASE("queries agree with a plain search, in the plane, on membranes and in space") {
    check_queries(triangle_grid<double>({4, 3}, {1., 1.}));
    check_queries(quad_grid<double>({4, 3}, {1., 1.}));
    check_queries(lifted(triangle_grid<double>({3, 4}, {1., 1.})));
    check_queries(lifted(quad_grid<double>({3, 2}, {1., 1.})));
    check_queries(tetrahedron_grid<double>({3, 2, 2}, {1., 1., 1.}));
    check_queries(hex_grid<double>({3, 2, 2}, {1., 1., 1.}));
}

TEST_CASE("bodies that hang together in one node or edge are seen whole") {
    Mesh<2, double, Tri3> wings;
    wings.nodes.resize(2, 5);
    wings.nodes << 0, -1, -1, 1, 1, 0, -1, 1, -1, 1;
    wings.cells.resize(3, 2);
    wings.cells << 0, 0, 2, 3, 1, 4;
    check_queries(wings);

    Mesh<3, double, Tet4> hinge; // two tetrahedra on the edge (0, 1)
    hinge.nodes.resize(3, 6);
    hinge.nodes << 0, 0, 1, 1, -1, -1, 0, 0, -1, 1, 1, -1, 0, 1, 0, 0, 0, 0;
    hinge.cells.resize(4, 2);
    hinge.cells << 0, 0, 2, 4, 3, 5, 1, 1;
    check_queries(hinge);
}

TEST_CASE("meshes and questions that make no sense are refused") {
    auto mesh = triangle_grid<double>({2, 1}, {1., 1.});
    std::swap(mesh.cells(0, 1), mesh.cells(1, 1));
    CHECK_THROWS_WITH_AS(cgal::Topology{mesh},
                         "mesh: expected cells oriented alike, found cells 0 and 1 oriented against "
                         "each other",
                         InvalidArgument);
    Mesh<3, double, Tri3> fan; // three triangles at one edge
    fan.nodes.resize(3, 5);
    fan.nodes << 0, 0, 1, -1, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0;
    fan.cells.resize(3, 3);
    fan.cells << 0, 1, 0, 1, 0, 1, 2, 3, 4;
    CHECK_THROWS_WITH_AS(cgal::Topology{fan},
                         "mesh: expected facets shared by at most two cells, found 3 cells at a facet "
                         "of cell 0",
                         InvalidArgument);
    const cgal::Topology topology(hex_grid<double>({1, 1, 1}, {1., 1., 1.}));
    CHECK_THROWS_WITH_AS((void)topology.cells_of_node(8), "node: expected a number in [0, 8), found 8",
                         InvalidArgument);
    CHECK_THROWS_AS((void)topology.k_ring(0, -1), InvalidArgument);
    CHECK_THROWS_AS((void)topology.cells_across(1), InvalidArgument);
    CHECK(topology.cells_of_edge(0, 6).empty());
}
