// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <springfit/mesh/mesh.hpp>

namespace springfit::detail {

/// Checks the thickness and returns what it multiplies volumes by: 1 in solids.
template <CellType Cell, std::floating_point Scalar>
Scalar thickness_factor(Scalar thickness) {
    require(thickness > 0 && std::isfinite(thickness), "thickness", "a positive thickness", thickness);
    return Cell::dimension == 2 ? thickness : Scalar(1);
}

/// Volume spanned by the columns `[Dim x cell dimension]`: a signed determinant, or the area of a piece of membrane.
template <class Jacobian>
typename Jacobian::Scalar spanned(const Jacobian& jacobian) {
    if constexpr (static_cast<int>(Jacobian::RowsAtCompileTime) == static_cast<int>(Jacobian::ColsAtCompileTime)) {
        return jacobian.determinant();
    } else {
        return jacobian.col(0).cross(jacobian.col(1)).norm();
    }
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
        const Scalar volume = spanned(sides) / (d == 2 ? 2 : 6);
        positive = volume > 0;
        shares.setConstant(volume / corners);
    } else {
        // Corner (s_1, ..., s_d) in {-1, 1}^d has the shape function prod (1 + s_k xi_k) / 2.
        constexpr int signs[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                     {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
        const Scalar gauss = 1 / std::sqrt(Scalar(3)); // two points on each axis, of weight 1
        for (int q = 0; q < corners; ++q) {
            Eigen::Matrix<Scalar, corners, 1> shape;
            Eigen::Matrix<Scalar, corners, d> gradient;
            for (int a = 0; a < corners; ++a) {
                Scalar factors[d];
                shape(a) = 1;
                for (int k = 0; k < d; ++k) {
                    factors[k] = (1 + static_cast<Scalar>(signs[a][k] * signs[q][k]) * gauss) / 2;
                    shape(a) *= factors[k];
                }
                for (int k = 0; k < d; ++k) {
                    gradient(a, k) = static_cast<Scalar>(signs[a][k]) / 2;
                    for (int other = 0; other < d; ++other) {
                        gradient(a, k) *= other == k ? Scalar(1) : factors[other];
                    }
                }
            }
            const Eigen::Matrix<Scalar, Dim, d> jacobian = x * gradient;
            const Scalar density = spanned(jacobian);
            positive = positive && density > 0;
            shares += density * shape;
        }
    }
    if (!positive) {
        throw InvalidArgument("mesh", "cells of positive volume", text("cell ", cell, ", inverted or flat"));
    }
    return shares;
}

} // namespace springfit::detail
