// SPDX-License-Identifier: BSD-3-Clause
#include <springfit/cgal/triangulate.hpp>

int main() {
    springfit::cgal::Outline square;
    square.points.resize(2, 4);
    square.points << 0, 1, 1, 0, 0, 0, 1, 1;
    square.segments.resize(2, 4);
    square.segments << 0, 1, 2, 3, 1, 2, 3, 0;
    const auto mesh = springfit::cgal::triangulate<double>(square, {.cell_size = 0.3});
    return mesh.n_cells() > 0 ? 0 : 1;
}
