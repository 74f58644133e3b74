// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <springfit/core/error.hpp>
#include <springfit/core/types.hpp>

/// Meshers work on bodies of size 1, on a grid: a body has the same mesh in any unit.
namespace springfit::cgal::detail {

/// Throws InvalidArgument, naming `name`, for a body so large or so small that sharp angles in it cannot be computed
/// (powers of its size leave the range of numbers). 0 is left to those who ask for an area.
inline void check_extent(double extent, std::string_view name) {
    constexpr double smallest = 1e-30;
    constexpr double largest = 1e30;
    require(extent == 0 || (extent >= smallest && extent <= largest), name,
            text("a body of a size from ", smallest, " to ", largest), extent);
}

/// The largest extent of points, m; 1 where they have none.
template <int Dim>
[[nodiscard]] double body_unit(const Points<Dim, double>& points) {
    const double extent =
        points.cols() > 0 ? (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff() : 0.;
    return extent > 0 && std::isfinite(extent) ? extent : 1.;
}

/// A coordinate in a unit, to 2^-40 of it.
[[nodiscard]] inline double in_unit(double coordinate, double unit) {
    constexpr double grid = 1099511627776.; // 2^40
    return std::round(coordinate / unit * grid) / grid;
}

template <int Dim>
[[nodiscard]] Points<Dim, double> in_unit(const Points<Dim, double>& points, double unit) {
    return points.unaryExpr([unit](double coordinate) { return in_unit(coordinate, unit); });
}

} // namespace springfit::cgal::detail
