// SPDX-License-Identifier: BSD-3-Clause
#include <springfit/cgal/topology.hpp>
#include <springfit/mesh/structured.hpp>

int main() {
    const auto mesh = springfit::tetrahedron_grid<double>({1, 1, 1}, {1., 1., 1.});
    const springfit::cgal::Topology topology(mesh);
    return topology.boundary_nodes().size() == 8 ? 0 : 1;
}
