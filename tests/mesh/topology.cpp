// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <set>

#include <springfit/mesh/structured.hpp>

using namespace springfit;

namespace {

/// V - E + F - C of a mesh of one piece without holes is 1.
template <class Mesh>
Index edge_count_by_euler_2d(const Mesh& mesh) {
    return mesh.n_nodes() + mesh.n_cells() - 1;
}

} // namespace

TEST_CASE("edges are counted as Euler says") {
    const auto triangles = triangle_grid<double>({4, 5}, {1., 1.});
    CHECK(edges(triangles).cols() == edge_count_by_euler_2d(triangles));
    const auto quads = quad_grid<double>({4, 5}, {1., 1.});
    CHECK(edges(quads).cols() == edge_count_by_euler_2d(quads));
    CHECK(diagonals(quads).cols() == 2 * quads.n_cells());

    const auto tets = tetrahedron_grid<double>({3, 2, 2}, {1., 1., 1.});
    const auto boundary = static_cast<Index>(boundary_facets(tets).size());
    const Index faces = (4 * tets.n_cells() + boundary) / 2;
    CHECK(edges(tets).cols() == tets.n_nodes() + faces - tets.n_cells() - 1);

    const auto hexes = hex_grid<double>({3, 2, 2}, {1., 1., 1.});
    CHECK(edges(hexes).cols() == 3 * 3 * 3 + 4 * 2 * 3 + 4 * 3 * 2);
    CHECK(boundary_facets(hexes).size() == 2 * (3 * 2 + 3 * 2 + 2 * 2));
}

TEST_CASE("boundary facets are closed and point outwards") {
    const auto check = [](const auto& mesh, double volume) {
        Vector<3, double> total = Vector<3, double>::Zero();
        double flux = 0; // of x / 3 through the boundary: the volume
        for (const auto& facet : boundary_facets(mesh)) {
            Vector<3, double> area = Vector<3, double>::Zero();
            Vector<3, double> centre = Vector<3, double>::Zero();
            for (std::size_t a = 0; a < facet.corners.size(); ++a) {
                const Vector<3, double> p = mesh.nodes.col(facet.corners[a]);
                const Vector<3, double> q = mesh.nodes.col(facet.corners[(a + 1) % facet.corners.size()]);
                area += p.cross(q) / 2;
                centre += p / static_cast<double>(facet.corners.size());
            }
            total += area;
            flux += area.dot(centre) / 3;
        }
        CHECK(total.norm() < 1e-14);
        CHECK(test::relative(flux, volume, volume) < 1e-14);
    };
    check(tetrahedron_grid<double>({3, 2, 2}, {1., 2., 3.}), 6);
    check(hex_grid<double>({3, 2, 2}, {1., 2., 3.}), 6);
}

TEST_CASE("the second ring joins the vertices across shared facets") {
    const auto triangles = triangle_grid<double>({2, 1}, {2., 1.});
    // Squares cut as 0-1-4-3 by (0, 4) and 1-2-5-4 by (2, 4): across (0, 4): 1 and 3; across (1, 4): 0 and 2; across
    // (2, 4): 1 and 5.
    NodePairs expected(2, 3);
    expected << 0, 1, 1, 2, 3, 5;
    CHECK(second_ring(triangles) == expected);

    const auto tets = tetrahedron_grid<double>({3, 3, 3}, {1., 1., 1.});
    std::set<std::pair<int, int>> first;
    const NodePairs ring1 = edges(tets);
    for (Index e = 0; e < ring1.cols(); ++e) {
        first.insert({ring1(0, e), ring1(1, e)});
    }
    const NodePairs ring2 = second_ring(tets);
    CHECK(ring2.cols() > 0);
    for (Index e = 0; e < ring2.cols(); ++e) {
        CHECK(first.count({ring2(0, e), ring2(1, e)}) == 0);
    }
}
