// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <random>

#include <springfit/mesh/element.hpp>

using namespace springfit;

namespace {

template <class Cell>
constexpr bool is_box = (Cell::n_corners == (1 << Cell::dimension));

/// Reference coordinates of a corner.
template <class Cell>
std::array<double, std::size_t(Cell::dimension)> corner(int a) {
    std::array<double, std::size_t(Cell::dimension)> xi{};
    if constexpr (is_box<Cell>) {
        constexpr double square[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        xi[0] = square[a % 4][0];
        xi[1] = square[a % 4][1];
        if constexpr (Cell::dimension == 3) {
            xi[2] = a < 4 ? -1 : 1;
        }
    } else if (a > 0) {
        xi[std::size_t(a - 1)] = 1;
    }
    return xi;
}

template <class Cell>
std::array<double, std::size_t(Cell::dimension)> node(int a) {
    if (a < Cell::n_corners) {
        return corner<Cell>(a);
    }
    const auto& edge = Cell::edges[std::size_t(a - Cell::n_corners)];
    auto xi = corner<Cell>(edge[0]);
    const auto other = corner<Cell>(edge[1]);
    for (std::size_t d = 0; d < xi.size(); ++d) {
        xi[d] = (xi[d] + other[d]) / 2;
    }
    return xi;
}

double factorial(int k) {
    return k <= 1 ? 1. : k * factorial(k - 1);
}

/// Integral of the monomial with exponents p over the reference element.
template <class Cell>
double exact(const std::array<int, 3>& p) {
    double value = 1;
    int degree = 0;
    for (int d = 0; d < Cell::dimension; ++d) {
        const int e = p[std::size_t(d)];
        value *= is_box<Cell> ? (e % 2 == 0 ? 2. / (e + 1) : 0.) : factorial(e);
        degree += e;
    }
    return is_box<Cell> ? value : value / factorial(degree + Cell::dimension);
}

template <class Cell, class Rule>
void check_rule(const Rule& rule, int degree) {
    for (int i = 0; i <= degree; ++i) {
        for (int j = 0; j <= degree; ++j) {
            for (int k = 0; k <= (Cell::dimension == 3 ? degree : 0); ++k) {
                if (!is_box<Cell> && i + j + k > degree) {
                    continue;
                }
                double sum = 0;
                for (const auto& q : rule) {
                    sum += q.weight * std::pow(q.xi[0], i) * std::pow(q.xi[1], j) *
                           (Cell::dimension == 3 ? std::pow(q.xi.back(), k) : 1.);
                }
                CHECK(std::abs(sum - exact<Cell>({i, j, k})) < 1e-15 * 8);
            }
        }
    }
}

} // namespace

TEST_CASE_TEMPLATE("shape functions are 1 at their node and 0 at the others, add up to 1, and match their gradients",
                   Cell, Tri3, Tri6, Quad4, Tet4, Tet10, Hex8) {
    using Element = fem::Element<Cell>;
    for (int a = 0; a < Cell::n_nodes; ++a) {
        const auto values = Element::values(node<Cell>(a));
        for (int b = 0; b < Cell::n_nodes; ++b) {
            CHECK(std::abs(values[std::size_t(b)] - (a == b ? 1. : 0.)) < 1e-15);
        }
    }
    std::mt19937 random(5);
    std::uniform_real_distribution<double> coordinate(0.05, 0.3);
    for (int trial = 0; trial < 5; ++trial) {
        std::array<double, std::size_t(Cell::dimension)> xi{};
        for (double& x : xi) {
            x = coordinate(random);
        }
        const auto values = Element::values(xi);
        const auto gradients = Element::gradients(xi);
        double sum = 0;
        for (double v : values) {
            sum += v;
        }
        CHECK(std::abs(sum - 1) < 1e-14);
        const double h = 1e-5;
        for (std::size_t d = 0; d < xi.size(); ++d) {
            auto ahead = xi;
            auto behind = xi;
            ahead[d] += h;
            behind[d] -= h;
            const auto plus = Element::values(ahead);
            const auto minus = Element::values(behind);
            for (std::size_t a = 0; a < values.size(); ++a) {
                CHECK(std::abs((plus[a] - minus[a]) / (2 * h) - gradients[a][d]) < 1e-9);
            }
        }
    }
}

TEST_CASE("quadrature rules are exact to their degree") {
    check_rule<Tri3>(fem::Element<Tri3>::stiffness_rule, 1);
    check_rule<Tri3>(fem::Element<Tri3>::mass_rule, 2);
    check_rule<Tri6>(fem::Element<Tri6>::stiffness_rule, 2);
    check_rule<Tri6>(fem::Element<Tri6>::mass_rule, 4);
    check_rule<Tet4>(fem::Element<Tet4>::stiffness_rule, 1);
    check_rule<Tet4>(fem::Element<Tet4>::mass_rule, 2);
    check_rule<Tet10>(fem::Element<Tet10>::stiffness_rule, 2);
    check_rule<Tet10>(fem::Element<Tet10>::mass_rule, 4);
    check_rule<Quad4>(fem::Element<Quad4>::stiffness_rule, 3);
    check_rule<Hex8>(fem::Element<Hex8>::mass_rule, 3);
}

// Everything is there at compile time.
static_assert(fem::Element<Tet4>::values({0.25, 0.25, 0.25})[0] == 0.25);
static_assert(fem::Element<Quad4>::gradients({0., 0.})[2][0] == 0.25);
