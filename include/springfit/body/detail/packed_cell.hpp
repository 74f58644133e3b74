// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include <springfit/mesh/simplex.hpp>
#include <springfit/network/spring_network.hpp>

namespace springfit::detail {

/// A cell that holds its volume, as a step reads it.
template <int Dim, std::floating_point Scalar>
struct PackedCell {
    static constexpr Scalar share = simplex_share<Dim, Scalar>;

    int corners[Dim + 1];
    Scalar stiffness;      ///< kappa
    Scalar inverse_volume; ///< 1 / V at rest

    [[nodiscard]] int lowest() const { return *std::min_element(corners, corners + Dim + 1); }
};

/// The cells of a network, sorted by their lowest corner; corners by what `number(node)` says.
template <int Dim, std::floating_point Scalar, class Number>
[[nodiscard]] std::vector<PackedCell<Dim, Scalar>> packed_cells(const SpringNetwork<Dim, Scalar>& network,
                                                                const Number& number) {
    std::vector<PackedCell<Dim, Scalar>> cells;
    cells.reserve(static_cast<std::size_t>(network.n_cells()));
    for (Index c = 0; c < network.n_cells(); ++c) {
        auto& cell = cells.emplace_back();
        for (int a = 0; a <= Dim; ++a) {
            cell.corners[a] = number(network.cells(a, c));
        }
        cell.stiffness = network.volume_stiffness(c);
        cell.inverse_volume = 1 / network.rest_volume(c);
    }
    std::sort(cells.begin(), cells.end(),
              [](const auto& first, const auto& second) { return first.lowest() < second.lowest(); });
    return cells;
}

} // namespace springfit::detail
