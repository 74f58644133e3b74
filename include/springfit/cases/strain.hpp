// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>
#include <utility>

#include <springfit/cases/load_cases.hpp>
#include <springfit/core/maximum.hpp>

namespace springfit {

/// How much a set of edges is strained, over their magnitudes |eps_e|.
template <std::floating_point Scalar>
struct EdgeStrain {
    Scalar rms = 0;
    Scalar max = 0;
    Scalar percentile_95 = 0; ///< 95 % of the edges are strained less
};

namespace detail {

/// Summary of the strains `strain(e)` of the edges. The percentile is the entry ceil(0.95 n) in ascending order.
template <std::floating_point Scalar, class Strain>
EdgeStrain<Scalar> summary(Index n_edges, const Strain& strain) {
    EdgeStrain<Scalar> result;
    if (n_edges == 0) {
        return result;
    }
    Values<Scalar> size(n_edges);
    for (Index e = 0; e < n_edges; ++e) {
        size(e) = std::abs(strain(e));
    }
    result.rms = size.norm() / std::sqrt(static_cast<Scalar>(n_edges));
    result.max = max_norm(size);
    const Index rank = (19 * n_edges + 19) / 20 - 1;
    std::nth_element(size.begin(), size.begin() + rank, size.end());
    result.percentile_95 = size(rank);
    return result;
}

/// The strain by which loads are scaled: that of 95 % of the edges, or a quarter of the largest.
template <std::floating_point Scalar>
Scalar scaled_strain(const EdgeStrain<Scalar>& strain) {
    return std::max(strain.percentile_95, strain.max / 4);
}

/// Difference of two columns along an edge.
template <int Dim, std::floating_point Scalar>
Vector<Dim, Scalar> along(const NodePairs& pairs, Index e, const Points<Dim, Scalar>& points) {
    return points.col(pairs(1, e)) - points.col(pairs(0, e));
}

template <int Dim, std::floating_point Scalar>
void check_edges(const NodePairs& pairs, const Points<Dim, Scalar>& rest, const Points<Dim, Scalar>& other,
                 std::string_view name) {
    require(other.cols() == rest.cols(), name, text(rest.cols(), " columns, one per node"), other.cols());
    for (Index e = 0; e < pairs.cols(); ++e) {
        const int low = pairs.col(e).minCoeff();
        const int high = pairs.col(e).maxCoeff();
        require(low >= 0 && high < rest.cols(), "pairs", text("node numbers in [0, ", rest.cols(), ")"),
                low < 0 ? low : high);
        require(along<Dim, Scalar>(pairs, e, rest).norm() > 0, "pairs", "a positive rest length",
                text("none at pair ", e));
    }
}

} // namespace detail

/// Engineering strain L / l - 1 of the pairs of nodes `[2 x n_pairs]` (edges of a mesh, springs), l their lengths in
/// `rest`, L in `positions` `[Dim x n_nodes]`. Throws InvalidArgument for arrays that do not fit. O(pairs).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] EdgeStrain<Scalar> edge_strain(const NodePairs& pairs, const Points<Dim, Scalar>& rest,
                                             const std::type_identity_t<Points<Dim, Scalar>>& positions) {
    detail::check_edges<Dim, Scalar>(pairs, rest, positions, "positions");
    return detail::summary<Scalar>(pairs.cols(), [&](Index e) {
        const Scalar length = detail::along<Dim, Scalar>(pairs, e, rest).norm();
        return detail::along<Dim, Scalar>(pairs, e, positions).norm() / length - 1;
    });
}

/// The part of that strain that is linear in the displacement u `[Dim x n_nodes]`, n . (u_j - u_i) / l: rotations,
/// which a linear response blows up, do not count.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] EdgeStrain<Scalar> linear_edge_strain(const NodePairs& pairs, const Points<Dim, Scalar>& rest,
                                                    const std::type_identity_t<Points<Dim, Scalar>>& displacement) {
    detail::check_edges<Dim, Scalar>(pairs, rest, displacement, "displacement");
    return detail::summary<Scalar>(pairs.cols(), [&](Index e) {
        const Vector<Dim, Scalar> r = detail::along<Dim, Scalar>(pairs, e, rest);
        return r.dot(detail::along<Dim, Scalar>(pairs, e, displacement)) / r.squaredNorm();
    });
}

/// Scales the loads of scenarios such that the linear response strains 95 % of the pairs of nodes by no more than
/// `strain` and none by more than four times that, which local loads reach first, and displaces no node by more than
/// `displacement`, m, which slender bodies reach first; returns the factors. Where a case has no response or one
/// without strain, its loads stay as they are and its factor is 0.
///
///     scale_to_strain(cases, edges(mesh), mesh.nodes, 0.15,
///                     [&](const auto& scenarios) { return linear_responses(model, scenarios); });
///
/// `respond(scenarios)` gives a displacement `[Dim x n_nodes]` per scenario, empty where there is none. The strain that
/// comes about is another where the body answers nonlinearly, by some tens of percent at 0.15. Clamps that move add to
/// the response but are not scaled: record them as they are. Throws InvalidArgument for arrays that do not fit and for
/// limits out of range.
template <int Dim, std::floating_point Scalar, class Respond>
    requires std::convertible_to<std::invoke_result_t<const Respond&, const std::vector<Scenario<Dim, Scalar>>&>,
                                 std::vector<Points<Dim, Scalar>>>
std::vector<Scalar>
scale_to_strain(std::vector<Scenario<Dim, Scalar>>& scenarios, const NodePairs& pairs, const Points<Dim, Scalar>& rest,
                std::type_identity_t<Scalar> strain, const Respond& respond,
                std::type_identity_t<Scalar> displacement = std::numeric_limits<Scalar>::infinity()) {
    require(displacement > 0, "displacement", "a length above 0", displacement);
    require(strain > 0 && strain < 1, "strain", "a value in (0, 1)", strain);
    const std::vector<Points<Dim, Scalar>> responses = respond(std::as_const(scenarios));
    require(responses.size() == scenarios.size(), "respond", text(scenarios.size(), " displacements, one per scenario"),
            responses.size());
    std::vector<Scalar> factors(scenarios.size(), Scalar(0));
    for (std::size_t c = 0; c < scenarios.size(); ++c) {
        if (responses[c].cols() == 0) {
            continue;
        }
        const EdgeStrain<Scalar> response = linear_edge_strain(pairs, rest, responses[c]);
        const Scalar found = detail::scaled_strain(response);
        const Scalar factor = std::min(strain / found, displacement / responses[c].colwise().norm().maxCoeff());
        if (found > 0 && std::isfinite(factor)) {
            scale_loads(scenarios[c], factor);
            factors[c] = factor;
        }
    }
    return factors;
}

} // namespace springfit
