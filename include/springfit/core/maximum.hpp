// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/types.hpp>

namespace springfit {

/// The larger of two values, NaN where one of them is: the `maximum` of IEEE 754. (`std::max` may drop a NaN, and what
/// is certified by a largest value would then look better than it is.)
template <std::floating_point Scalar>
[[nodiscard]] constexpr Scalar maximum(Scalar a, Scalar b) {
    return a >= b || a != a ? a : b;
}

/// The largest absolute value, 0 of none, NaN where any is.
template <class Derived>
[[nodiscard]] typename Derived::Scalar max_norm(const Eigen::MatrixBase<Derived>& values) {
    using Scalar = typename Derived::Scalar;
    return values.size() > 0 ? values.cwiseAbs().template maxCoeff<Eigen::PropagateNaN>() : Scalar(0);
}

} // namespace springfit
