// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/network/spring_network.hpp>

namespace springfit::detail {

/// The cells of a network alone, their corners by what `number(node)` says.
template <int Dim, std::floating_point Scalar, class Number>
[[nodiscard]] SpringNetwork<Dim, Scalar> renumbered_cells(const SpringNetwork<Dim, Scalar>& network,
                                                          const Number& number) {
    SpringNetwork<Dim, Scalar> result;
    result.cells = network.cells.unaryExpr([&](int node) { return number(node); });
    result.rest_volume = network.rest_volume;
    result.volume_stiffness = network.volume_stiffness;
    return result;
}

} // namespace springfit::detail
