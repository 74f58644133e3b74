// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <springfit/mesh/detail/measure.hpp>
#include <springfit/mesh/element.hpp>
#include <springfit/mesh/mesh.hpp>
#include <springfit/mesh/simplex.hpp>

namespace springfit::detail {

/// Checks the thickness and returns what it multiplies volumes by: 1 in solids.
template <CellType Cell, std::floating_point Scalar>
Scalar thickness_factor(Scalar thickness) {
    require(thickness > 0 && std::isfinite(thickness), "thickness", "a positive thickness", thickness);
    return Cell::dimension == 2 ? thickness : Scalar(1);
}

/// The share of each corner in the volume (area) of a cell: the integral of its linear, bilinear or trilinear shape
/// function, by Gauss points that are exact for flat cells. Throws InvalidArgument where the volume is not positive.
template <int Dim, std::floating_point Scalar, CellType Cell>
Eigen::Matrix<Scalar, Cell::n_corners, 1> corner_volumes(const Mesh<Dim, Scalar, Cell>& mesh, Index cell) {
    constexpr int corners = Cell::n_corners;
    constexpr int d = Cell::dimension;
    const Eigen::Matrix<Scalar, Dim, corners> x = mesh.cell_nodes(cell).template leftCols<corners>();
    Eigen::Matrix<Scalar, corners, 1> shares = Eigen::Matrix<Scalar, corners, 1>::Zero();
    bool positive = true;
    if constexpr (SimplexCell<Cell>) {
        const Eigen::Matrix<Scalar, Dim, d> sides = x.template rightCols<d>().colwise() - x.col(0);
        const Scalar volume = measure(sides) * (d == 2 ? simplex_share<2, Scalar> : simplex_share<3, Scalar>);
        positive = volume > 0;
        shares.setConstant(volume / corners);
    } else {
        using Element = fem::Element<Cell>;
        for (const auto& point : Element::stiffness_rule) { // two points on each axis
            const auto values = Element::values(point.xi);
            const auto gradients = Element::gradients(point.xi);
            Eigen::Matrix<Scalar, corners, 1> shape;
            Eigen::Matrix<Scalar, corners, d> slope;
            for (int a = 0; a < corners; ++a) {
                shape(a) = static_cast<Scalar>(values[static_cast<std::size_t>(a)]);
                for (int k = 0; k < d; ++k) {
                    slope(a, k) =
                        static_cast<Scalar>(gradients[static_cast<std::size_t>(a)][static_cast<std::size_t>(k)]);
                }
            }
            const Scalar density = measure(Eigen::Matrix<Scalar, Dim, d>(x * slope));
            positive = positive && density > 0;
            shares += static_cast<Scalar>(point.weight) * density * shape;
        }
    }
    if (!positive) {
        throw InvalidArgument("mesh", "cells of positive volume", text("cell ", cell, ", inverted or flat"));
    }
    return shares;
}

} // namespace springfit::detail
