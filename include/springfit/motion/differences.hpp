// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include <springfit/core/error.hpp>
#include <springfit/core/types.hpp>

namespace springfit {

namespace detail {

/// Weights w with sum_j w_j f(times[first + j]) = the derivative of that order at times[at], exact for polynomials of
/// degree below `count`: sum_j w_j (t_j - t)^p = order! where p = order, else 0.
template <std::same_as<double> Time>
[[nodiscard]] Values<double> difference_weights(const std::vector<Time>& times, std::size_t first, std::size_t count,
                                                std::size_t at, int order) {
    const double scale = times[first + count - 1] - times[first];
    const auto n = static_cast<Index>(count);
    DenseMatrix<double> powers(n, n);
    for (Index j = 0; j < n; ++j) {
        const double offset = (times[first + static_cast<std::size_t>(j)] - times[at]) / scale;
        for (Index p = 0; p < n; ++p) {
            powers(p, j) = std::pow(offset, static_cast<double>(p));
        }
    }
    Values<double> moments = Values<double>::Zero(n);
    moments(order) = order; // 1! and 2!
    return powers.partialPivLu().solve(moments) / std::pow(scale, order);
}

} // namespace detail

/// Derivatives in time of frames at increasing, not necessarily even times, by differences that are exact for
/// polynomials of degree order + 3: fourth-order accurate at every frame, the ends included.
///
/// `order` is 1 or 2. Uses the order + 4 frames nearest to each frame, or all where there are fewer; with no more
/// frames than `order` the derivative is zero. O(frames x nodes).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] std::vector<Points<Dim, Scalar>>
differentiate(const std::vector<Scalar>& times, const std::vector<Points<Dim, Scalar>>& frames, int order) {
    require(order == 1 || order == 2, "order", "1 or 2", order);
    require(times.size() == frames.size(), "times", text(frames.size(), " values, one per frame"), times.size());
    const std::vector<double> t(times.begin(), times.end());
    const std::size_t count = std::min(t.size(), static_cast<std::size_t>(order) + 4);
    std::vector<Points<Dim, Scalar>> result;
    result.reserve(frames.size());
    std::size_t first = 0;
    for (std::size_t at = 0; at < frames.size(); ++at) {
        result.push_back(Points<Dim, Scalar>::Zero(Dim, frames[at].cols()));
        if (count <= static_cast<std::size_t>(order)) {
            continue;
        }
        // At least one frame on either side where there is one; beyond that, the nearer frames.
        while (first + count < t.size() &&
               (first + count <= at + 1 || (first + 1 < at && t[first + count] - t[at] < t[at] - t[first]))) {
            ++first;
        }
        const Values<double> weights = detail::difference_weights(t, first, count, at, order);
        for (std::size_t j = 0; j < count; ++j) {
            result.back() += static_cast<Scalar>(weights(static_cast<Index>(j))) * frames[first + j];
        }
    }
    return result;
}

} // namespace springfit
