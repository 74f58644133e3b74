// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <springfit/mesh/element.hpp>
#include <springfit/mesh/mesh.hpp>

namespace springfit::cgal::detail {

/// Where a point lies in a cell.
template <CellType Cell>
struct CellCoordinates {
    Eigen::Matrix<double, Cell::n_nodes, 1> weights; ///< shape functions N_a(xi); they sum to 1
    double outside = 0;                              ///< how far xi lies out of the reference element; <= 0 inside
    bool found = false;                              ///< whether xi was found
};

/// Solves sum_a N_a(xi) x_a = p for xi by Newton's method from the middle of the cell: one step in simplices with
/// straight edges. In a surface cell in space, the point of the cell's surface where Gauss-Newton finds p nearest.
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] CellCoordinates<Cell> invert(const Mesh<Dim, Scalar, Cell>& mesh, Index cell,
                                           const Vector<Dim, double>& p) {
    constexpr int dim = Cell::dimension;
    constexpr bool simplex = Cell::n_corners == dim + 1;
    constexpr int max_steps = 30;
    constexpr double farthest = 10; // steps do not leave this range of xi, so that a far point does no harm
    using Element = fem::Element<Cell>;
    const Eigen::Matrix<double, Dim, Cell::n_nodes> x = mesh.cell_nodes(cell).template cast<double>();
    typename Element::Coordinates xi{};
    xi.fill(simplex ? 1. / (dim + 1) : 0.);
    double last_change = std::numeric_limits<double>::infinity();
    for (int step = 0; step < max_steps && last_change > 1e-15; ++step) {
        const auto n = Element::values(xi);
        const auto g = Element::gradients(xi);
        Vector<Dim, double> residual = p;
        Eigen::Matrix<double, Dim, dim> jacobian = Eigen::Matrix<double, Dim, dim>::Zero();
        for (int a = 0; a < Cell::n_nodes; ++a) {
            const auto i = static_cast<std::size_t>(a);
            residual -= n[i] * x.col(a);
            for (int d = 0; d < dim; ++d) {
                jacobian.col(d) += g[i][static_cast<std::size_t>(d)] * x.col(a);
            }
        }
        Eigen::Matrix<double, dim, 1> change;
        if constexpr (dim == Dim) {
            change = jacobian.inverse() * residual;
        } else {
            const Eigen::Matrix<double, dim, dim> normal = jacobian.transpose() * jacobian;
            change = normal.inverse() * (jacobian.transpose() * residual);
        }
        last_change = change.norm();
        for (int d = 0; d < dim; ++d) {
            auto& coordinate = xi[static_cast<std::size_t>(d)];
            coordinate = std::clamp(coordinate + change(d), -farthest, farthest);
        }
    }
    CellCoordinates<Cell> result;
    result.found = last_change < 1e-9;
    const auto n = Element::values(xi);
    result.weights = Eigen::Map<const Eigen::Matrix<double, Cell::n_nodes, 1>>(n.data());
    if constexpr (simplex) {
        double sum = 0;
        result.outside = -std::numeric_limits<double>::infinity();
        for (const double coordinate : xi) {
            result.outside = std::max(result.outside, -coordinate);
            sum += coordinate;
        }
        result.outside = std::max(result.outside, sum - 1);
    } else {
        for (const double coordinate : xi) {
            result.outside = std::max(result.outside, std::abs(coordinate));
        }
        result.outside -= 1;
    }
    return result;
}

} // namespace springfit::cgal::detail
