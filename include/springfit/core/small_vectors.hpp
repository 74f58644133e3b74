// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <type_traits>

#include <springfit/core/lanes.hpp>
#include <springfit/core/types.hpp>

/// Operations on vectors of the plane and of space whose components are numbers or lanes: `Vector<Dim, Scalar>`,
/// `std::array<Lanes, Dim>`, and what overloads them for a layout of its own.
namespace springfit::detail {

template <int Dim, class Vec>
auto dot(const Vec& a, const Vec& b) {
    auto sum = a[0] * b[0];
    for (int d = 1; d < Dim; ++d) {
        sum += a[d] * b[d];
    }
    return sum;
}

template <class Vec>
Vec cross(const Vec& a, const Vec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A vector of the plane turned by a quarter, clockwise: (y, -x).
template <class Vec>
Vec clockwise(const Vec& a) {
    return {a[1], -a[0]};
}

/// (-y, x)
template <class Vec>
Vec counter_clockwise(const Vec& a) {
    return {-a[1], a[0]};
}

template <int Dim, class Real>
std::array<Real, Dim> scaled(const std::type_identity_t<Real>& factor, const std::array<Real, Dim>& v) {
    std::array<Real, Dim> result;
    for (int d = 0; d < Dim; ++d) {
        result[d] = factor * v[d];
    }
    return result;
}

} // namespace springfit::detail
