// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

namespace springfit::fem {

/// A point of a reference element with the weight of its surroundings; the weights add up to the element's measure.
template <int Dim>
struct QuadraturePoint {
    std::array<double, std::size_t(Dim)> xi{};
    double weight = 0;
};

namespace detail {

template <int Dim, int N>
using QuadratureRule = std::array<QuadraturePoint<Dim>, std::size_t(N)>;

// Gauss-Legendre on [0, 1]: exact for degree 2 n - 1.
inline constexpr std::array<QuadraturePoint<1>, 3> gauss_3{
    {{{0.5 - 0.38729833462074168852}, 5. / 18}, {{0.5}, 4. / 9}, {{0.5 + 0.38729833462074168852}, 5. / 18}}};
inline constexpr std::array<QuadraturePoint<1>, 4> gauss_4{{{{0.5 - 0.43056815579702628761}, 0.17392742256872692869},
                                                            {{0.5 - 0.16999052179242813240}, 0.32607257743127307131},
                                                            {{0.5 + 0.16999052179242813240}, 0.32607257743127307131},
                                                            {{0.5 + 0.43056815579702628761}, 0.17392742256872692869}}};

/// The centroid of a simplex: degree 1.
template <int Dim>
constexpr QuadratureRule<Dim, 1> centroid_rule() {
    QuadratureRule<Dim, 1> rule{};
    rule[0].xi.fill(1. / (Dim + 1));
    rule[0].weight = Dim == 2 ? 1. / 2 : 1. / 6;
    return rule;
}

constexpr QuadratureRule<2, 3> triangle_rule_degree_2() {
    return {{{{1. / 6, 1. / 6}, 1. / 6}, {{2. / 3, 1. / 6}, 1. / 6}, {{1. / 6, 2. / 3}, 1. / 6}}};
}

constexpr QuadratureRule<3, 4> tetrahedron_rule_degree_2() {
    constexpr double a = 0.58541019662496845446; // (5 + 3 sqrt 5) / 20
    constexpr double b = 0.13819660112501051518; // (5 - sqrt 5) / 20
    return {{{{b, b, b}, 1. / 24}, {{a, b, b}, 1. / 24}, {{b, a, b}, 1. / 24}, {{b, b, a}, 1. / 24}}};
}

/// Gauss points of a square collapsed onto the triangle, xi = (u, v (1 - u)): degree 4.
constexpr QuadratureRule<2, 9> conical_triangle_rule() {
    QuadratureRule<2, 9> rule{};
    std::size_t q = 0;
    for (const auto& u : gauss_3) {
        for (const auto& v : gauss_3) {
            const double rest = 1 - u.xi[0];
            rule[q++] = {{u.xi[0], v.xi[0] * rest}, u.weight * v.weight * rest};
        }
    }
    return rule;
}

/// Gauss points of a cube collapsed onto the tetrahedron, xi = (u, v (1 - u), w (1 - u)(1 - v)): degree 4.
constexpr QuadratureRule<3, 36> conical_tetrahedron_rule() {
    QuadratureRule<3, 36> rule{};
    std::size_t q = 0;
    for (const auto& u : gauss_4) {
        for (const auto& v : gauss_3) {
            for (const auto& w : gauss_3) {
                const double rest = 1 - u.xi[0];
                const double last = rest * (1 - v.xi[0]);
                rule[q++] = {{u.xi[0], v.xi[0] * rest, w.xi[0] * last}, u.weight * v.weight * w.weight * rest * last};
            }
        }
    }
    return rule;
}

/// Two Gauss points along each axis of [-1, 1]^Dim: degree 3 along each.
template <int Dim>
constexpr QuadratureRule<Dim, (1 << Dim)> box_rule() {
    QuadratureRule<Dim, (1 << Dim)> rule{};
    for (std::size_t q = 0; q < rule.size(); ++q) {
        for (std::size_t d = 0; d < std::size_t(Dim); ++d) {
            rule[q].xi[d] = (q >> d) % 2 == 0 ? -0.57735026918962576451 : 0.57735026918962576451;
        }
        rule[q].weight = 1;
    }
    return rule;
}

/// Three Gauss points on [0, 1]: degree 5.
constexpr QuadratureRule<1, 3> line_rule() {
    return gauss_3;
}

} // namespace detail
} // namespace springfit::fem
