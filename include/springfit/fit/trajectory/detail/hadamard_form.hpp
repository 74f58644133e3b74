// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include <springfit/core/execution.hpp>
#include <springfit/fit/trajectory/detail/spring_block.hpp>
#include <springfit/fit/trajectory/parameters.hpp>

/// The pieces of the Gauss-Newton matrix of static cases in full, (B' K^-2 B) o (S W S'). Its rows are items: a
/// network's springs, then its cells. B is what a unit of tension, or of pressure, pulls at the nodes at the rest
/// shape; S what the unknowns do to tensions and pressures, case by case.
namespace springfit::detail {

/// The unknown of each item, -1 where it is not fitted, and what that unknown does to its tension or pressure.
struct FittedItems {
    std::vector<int> unknown;
    Values<double> slope;

    [[nodiscard]] Index size() const { return slope.size(); }
};

template <int Dim>
[[nodiscard]] FittedItems fitted_items(const TrajectoryParameters<Dim>& parameters,
                                       const SpringNetwork<Dim, double>& network) {
    const Index springs = network.n_springs();
    const Index items = springs + network.n_cells();
    FittedItems result{std::vector<int>(static_cast<std::size_t>(items)), Values<double>::Zero(items)};
    for (Index item = 0; item < items; ++item) {
        const auto kind = item < springs ? MotionParameter::stiffness : MotionParameter::volume;
        const Index own = item < springs ? item : item - springs;
        result.unknown[static_cast<std::size_t>(item)] = parameters.unknown(kind, own);
        if (result.unknown[static_cast<std::size_t>(item)] >= 0) {
            result.slope(item) = parameters.slope(kind, network, own);
        }
    }
    return result;
}

/// A column of B, into a column of zeros.
template <int Dim>
void set_unit_forces(const SpringNetwork<Dim, double>& network, Index item, Index column, ColumnBlock& forces) {
    const Index springs = network.n_springs();
    if (item < springs) {
        const int i = network.springs(0, item);
        const int j = network.springs(1, item);
        const Vector<Dim, double> n = (network.rest_positions.col(j) - network.rest_positions.col(i)).normalized();
        forces.col(column).template segment<Dim>(Dim * i) = n;
        forces.col(column).template segment<Dim>(Dim * j) = -n;
        return;
    }
    const auto corners = network.cells.col(item - springs);
    ColumnBlock x(forces.rows(), block_lanes);
    for (int a = 0; a <= Dim; ++a) {
        for (int d = 0; d < Dim; ++d) {
            x.row(Dim * corners(a) + d).setConstant(network.rest_positions(d, corners(a)));
        }
    }
    const CellLanes<Dim> cell(x, corners, 0);
    for (int a = 0; a < Dim; ++a) {
        for (int d = 0; d < Dim; ++d) {
            forces(Dim * corners(a + 1) + d, column) += cell.gradient[a][d](0);
            forces(Dim * corners(0) + d, column) -= cell.gradient[a][d](0);
        }
    }
}

/// B' K^-2 B [items x items], lower triangle, by the factor of K.
template <int Dim>
[[nodiscard]] DenseMatrix<double> compliance_product(const SpringNetwork<Dim, double>& network,
                                                     const BlockCholesky& factor, const Execution& execution) {
    const Index items = network.n_springs() + network.n_cells();
    const Index rows = Dim * network.n_nodes();
    DenseMatrix<double> columns(rows, items); // K^-1 B
    const Index chunks = (items + block_columns - 1) / block_columns;
    execution.for_chunks(chunks, 1, [&](Index, Index chunk, Index) {
        const Index first = chunk * block_columns;
        const Index count = std::min<Index>(block_columns, items - first);
        ColumnBlock right = ColumnBlock::Zero(rows, block_columns);
        for (Index c = 0; c < count; ++c) {
            set_unit_forces(network, first + c, c, right);
        }
        ColumnBlock solution;
        factor.solve(right, solution);
        columns.middleCols(first, count) = solution.leftCols(count);
    });
    DenseMatrix<double> product = DenseMatrix<double>::Zero(items, items);
    product.template selfadjointView<Eigen::Lower>().rankUpdate(columns.transpose());
    return product;
}

/// Appends the columns of S W^(1/2) of a block of equilibria x to `tensions` [items x cases].
template <int Dim>
void append_tensions(const SpringNetwork<Dim, double>& network, const FittedItems& items, const ColumnBlock& x,
                     const Values<double>& weight, DenseMatrix<double>& tensions) {
    const Index springs = network.n_springs();
    const auto& slope = items.slope;
    const Index before = tensions.cols();
    tensions.conservativeResize(items.size(), before + x.cols());
    for (Index column = 0; column < x.cols(); column += block_lanes) {
        const auto set_row = [&](Index item, const ColumnLanes& tension) {
            for (int c = 0; c < block_lanes; ++c) {
                tensions(item, before + column + c) = tension(c);
            }
        };
        for (Index e = 0; e < springs; ++e) {
            const SpringLanes<Dim> spring(x, network.springs(0, e), network.springs(1, e), column);
            set_row(e, slope(e) * (spring.length - network.rest_length(e)));
        }
        for (Index c = 0; c < network.n_cells(); ++c) {
            const CellLanes<Dim> cell(x, network.cells.col(c), column);
            set_row(springs + c, slope(springs + c) * (1 - cell.volume / network.rest_volume(c)));
        }
    }
    tensions.rightCols(x.cols()) *= weight.cwiseSqrt().asDiagonal();
}

/// h += product o squares, of which the lower triangles are given, between the unknowns of the items.
inline void add_hadamard(const FittedItems& items, const DenseMatrix<double>& product,
                         const DenseMatrix<double>& squares, DenseMatrix<double>& h) {
    for (Index column = 0; column < items.size(); ++column) {
        for (Index row = column; row < items.size(); ++row) {
            const int u = items.unknown[static_cast<std::size_t>(row)];
            const int v = items.unknown[static_cast<std::size_t>(column)];
            if (u >= 0 && v >= 0) {
                const double entry = product(row, column) * squares(row, column);
                h(u, v) += entry;
                if (row != column) {
                    h(v, u) += entry;
                }
            }
        }
    }
}

} // namespace springfit::detail
