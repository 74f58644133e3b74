// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/closed_form/detail/simplex_edges.hpp>
#include <springfit/core/maximum.hpp>

namespace springfit::detail {

/// Side lengths of a rectangle or box along its corners 0-1, 0-3 and 0-4; throws InvalidArgument for any other shape.
template <int Dim, std::floating_point Scalar, CellType Cell>
    requires std::same_as<Cell, Quad4> || std::same_as<Cell, Hex8>
Vector<Cell::dimension, Scalar> box_sides(const Mesh<Dim, Scalar, Cell>& mesh, Index cell) {
    constexpr int d = Cell::dimension;
    constexpr int neighbours[3] = {1, 3, 4};
    constexpr int steps[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                 {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    (void)corner_volumes(mesh, cell); // refuses inverted cells
    const auto x = mesh.cell_nodes(cell);
    Eigen::Matrix<Scalar, Dim, d> axes;
    Vector<d, Scalar> sides;
    for (int k = 0; k < d; ++k) {
        axes.col(k) = x.col(neighbours[k]) - x.col(0);
        sides(k) = axes.col(k).norm();
    }
    Scalar skew = 0; // relative to the sides
    for (int k = 0; k < d; ++k) {
        for (int l = 0; l < k; ++l) {
            skew = maximum(skew, std::abs(axes.col(k).dot(axes.col(l))) / (sides(k) * sides(l)));
        }
    }
    for (int a = 0; a < Cell::n_corners; ++a) {
        Vector<Dim, Scalar> away = x.col(a) - x.col(0);
        for (int k = 0; k < d; ++k) {
            away -= static_cast<Scalar>(steps[a][k]) * axes.col(k);
        }
        skew = maximum(skew, away.norm() / sides.minCoeff());
    }
    if (!(skew < Scalar(exactness))) {
        throw InvalidArgument("mesh",
                              d == 2 ? "rectangular cells (natsupakpong takes any quadrilaterals)"
                                     : "box-shaped cells (natsupakpong takes any hexahedra)",
                              text(Cell::name, " ", cell, " of another shape"));
    }
    return sides;
}

} // namespace springfit::detail
