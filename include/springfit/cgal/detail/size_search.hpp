// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <springfit/core/error.hpp>
#include <springfit/core/types.hpp>

namespace springfit::cgal::detail {

/// More nodes than this are refused before work begins.
inline constexpr Index most_nodes = 20000000;

/// Meshing ends at so many nodes, and so many times the wanted ones: at sharp edges that nearly meet there is no end.
inline constexpr double few_nodes = 2000;
inline constexpr double far_more_nodes = 10;

/// Throws InvalidArgument for a cell size, in units of `unit` (m), at which there would be too many nodes; 0 is none.
template <class NodesAt>
void check_cell_size(double cell_size, double unit, const NodesAt& nodes_at) {
    const double n = cell_size > 0 ? nodes_at(cell_size) : 0;
    require(n <= static_cast<double>(most_nodes), "cell_size",
            text("a length at which the body has at most ", most_nodes, " nodes"),
            text(cell_size * unit, ", at which it has some ", n));
}

/// Finds the cell size at which a mesher gives about `wanted` nodes: nodes go with size^-order, then the secant in
/// logarithms between the nearest size too coarse and the nearest too fine.
///
/// `mesh_at(size)` meshes, `count(mesh)` counts its nodes, `go_on(share)` may end the search. Returns the mesh whose
/// count is nearest, within 5 % unless shape and sharp edges do not allow it.
template <class MeshAt, class Count, class GoOn>
[[nodiscard]] auto mesh_with_nodes(Index wanted, double first_size, int order, const MeshAt& mesh_at,
                                   const Count& count, const GoOn& go_on) {
    constexpr int max_trials = 10;
    constexpr double enough = 0.05;
    double size = first_size;
    double coarse_size = 0; // largest log count below the wanted one, and its log size; 0: none yet
    double fine_size = 0;
    double coarse_error = 0;
    double fine_error = 0;
    auto best = mesh_at(size);
    double best_error = std::numeric_limits<double>::infinity();
    for (int trial = 0; trial < max_trials; ++trial) {
        auto mesh = trial == 0 ? std::move(best) : mesh_at(size);
        const auto n = static_cast<double>(std::max<Index>(count(mesh), 1));
        const double error = std::log(n / static_cast<double>(wanted)); // > 0: too fine
        if (std::abs(error) < best_error || trial == 0) {
            best = std::move(mesh);
            best_error = std::abs(error);
        }
        if (best_error < enough || !go_on(1 - std::pow(0.6, trial + 1))) {
            break;
        }
        (error > 0 ? fine_size : coarse_size) = size;
        (error > 0 ? fine_error : coarse_error) = error;
        if (fine_size > 0 && coarse_size > 0) {
            const double share = std::clamp(fine_error / (fine_error - coarse_error), 0.1, 0.9);
            size = fine_size * std::pow(coarse_size / fine_size, share);
        } else {
            size *= std::clamp(std::exp(error / order), 0.25, 4.);
        }
    }
    return best;
}

/// The size h at which n(h), falling in h, is `wanted`; by bisection in logarithms around `scale`.
template <class NodesAt>
[[nodiscard]] double size_where(const NodesAt& n, double wanted, double scale) {
    double low = std::log(scale) - 20;
    double high = std::log(scale) + 20;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (n(std::exp(middle)) > wanted ? low : high) = middle;
    }
    return std::exp(low);
}

} // namespace springfit::cgal::detail
