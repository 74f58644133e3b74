// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/mesh/cell.hpp>
#include <springfit/mesh/detail/quadrature.hpp>

namespace springfit::fem {

/// The reference element of a cell: shape functions N_a(xi), their gradients, and quadrature rules.
///
/// Simplices live on xi_d >= 0, sum xi <= 1; boxes on [-1, 1]^dimension. Nodes are ordered as in `mesh/cell.hpp`.
/// `stiffness_rule` is exact for the stiffness of a linear material on a cell with straight edges (and plane faces in
/// boxes: parallelepipeds), `mass_rule` for its consistent mass.
///
///     constexpr auto n = fem::Element<Tet10>::values({0.25, 0.25, 0.25});
template <class Cell>
struct Element;

namespace detail {

/// Edges of the linear simplex with the same corners; node `n_corners + e` of a quadratic simplex lies on edge e.
template <class Cell>
struct SimplexElement {
    static constexpr int dimension = Cell::dimension;
    static constexpr int n_nodes = Cell::n_nodes;
    static constexpr bool is_quadratic = n_nodes > dimension + 1;
    using Coordinates = std::array<double, std::size_t(dimension)>;

    /// N_a at xi.
    [[nodiscard]] static constexpr std::array<double, std::size_t(n_nodes)> values(const Coordinates& xi) {
        const auto l = barycentric(xi);
        std::array<double, std::size_t(n_nodes)> n{};
        for (std::size_t a = 0; a < n_corners; ++a) {
            n[a] = is_quadratic ? l[a] * (2 * l[a] - 1) : l[a];
        }
        if constexpr (is_quadratic) {
            for (std::size_t e = 0; e < Cell::edges.size(); ++e) {
                n[n_corners + e] = 4 * l[std::size_t(Cell::edges[e][0])] * l[std::size_t(Cell::edges[e][1])];
            }
        }
        return n;
    }

    /// dN_a / dxi_d at xi.
    [[nodiscard]] static constexpr std::array<Coordinates, std::size_t(n_nodes)> gradients(const Coordinates& xi) {
        const auto l = barycentric(xi);
        std::array<Coordinates, std::size_t(n_nodes)> g{};
        for (std::size_t d = 0; d < std::size_t(dimension); ++d) {
            for (std::size_t a = 0; a < n_corners; ++a) {
                g[a][d] = slope(a, d) * (is_quadratic ? 4 * l[a] - 1 : 1);
            }
            if constexpr (is_quadratic) {
                for (std::size_t e = 0; e < Cell::edges.size(); ++e) {
                    const auto i = std::size_t(Cell::edges[e][0]);
                    const auto j = std::size_t(Cell::edges[e][1]);
                    g[n_corners + e][d] = 4 * (slope(i, d) * l[j] + l[i] * slope(j, d));
                }
            }
        }
        return g;
    }

private:
    static constexpr std::size_t n_corners = std::size_t(dimension) + 1;

    static constexpr std::array<double, n_corners> barycentric(const Coordinates& xi) {
        std::array<double, n_corners> l{};
        l[0] = 1;
        for (std::size_t d = 0; d < std::size_t(dimension); ++d) {
            l[d + 1] = xi[d];
            l[0] -= xi[d];
        }
        return l;
    }

    /// Derivative of barycentric coordinate `a` along xi_d.
    static constexpr double slope(std::size_t a, std::size_t d) { return a == 0 ? -1 : (a == d + 1 ? 1 : 0); }
};

/// N_a = prod_d (1 + s_ad xi_d) / 2 with the corner's signs s_a.
template <class Cell>
struct BoxElement {
    static constexpr int dimension = Cell::dimension;
    static constexpr int n_nodes = Cell::n_nodes;
    using Coordinates = std::array<double, std::size_t(dimension)>;

    /// N_a at xi.
    [[nodiscard]] static constexpr std::array<double, std::size_t(n_nodes)> values(const Coordinates& xi) {
        std::array<double, std::size_t(n_nodes)> n{};
        for (std::size_t a = 0; a < n.size(); ++a) {
            n[a] = product(a, xi, std::size_t(dimension));
        }
        return n;
    }

    /// dN_a / dxi_d at xi.
    [[nodiscard]] static constexpr std::array<Coordinates, std::size_t(n_nodes)> gradients(const Coordinates& xi) {
        std::array<Coordinates, std::size_t(n_nodes)> g{};
        for (std::size_t a = 0; a < g.size(); ++a) {
            for (std::size_t d = 0; d < std::size_t(dimension); ++d) {
                g[a][d] = sign(a, d) / 2 * product(a, xi, d);
            }
        }
        return g;
    }

private:
    /// Corner signs: counter-clockwise in the plane, the same again one layer up.
    static constexpr double sign(std::size_t a, std::size_t d) {
        if (d == 0) {
            return (a % 4 == 1 || a % 4 == 2) ? 1 : -1;
        }
        return d == 1 ? (a % 4 >= 2 ? 1 : -1) : (a >= 4 ? 1 : -1);
    }

    static constexpr double product(std::size_t a, const Coordinates& xi, std::size_t left_out) {
        double value = 1;
        for (std::size_t d = 0; d < std::size_t(dimension); ++d) {
            value *= d == left_out ? 1 : (1 + sign(a, d) * xi[d]) / 2;
        }
        return value;
    }
};

/// Straight and quadratic edge of a plane cell: facets that loads act on.
struct Line2 {
    static constexpr int dimension = 1;
    static constexpr int n_nodes = 2;
};
struct Line3 {
    static constexpr int dimension = 1;
    static constexpr int n_nodes = 3;
    static constexpr std::array<std::array<int, 2>, 1> edges{{{0, 1}}};
};

} // namespace detail

template <>
struct Element<Tri3> : detail::SimplexElement<Tri3> {
    static constexpr auto stiffness_rule = detail::centroid_rule<2>();
    static constexpr auto mass_rule = detail::triangle_rule_degree_2();
};
template <>
struct Element<Tri6> : detail::SimplexElement<Tri6> {
    static constexpr auto stiffness_rule = detail::triangle_rule_degree_2();
    static constexpr auto mass_rule = detail::conical_triangle_rule();
};
template <>
struct Element<Tet4> : detail::SimplexElement<Tet4> {
    static constexpr auto stiffness_rule = detail::centroid_rule<3>();
    static constexpr auto mass_rule = detail::tetrahedron_rule_degree_2();
};
template <>
struct Element<Tet10> : detail::SimplexElement<Tet10> {
    static constexpr auto stiffness_rule = detail::tetrahedron_rule_degree_2();
    static constexpr auto mass_rule = detail::conical_tetrahedron_rule();
};
template <>
struct Element<Quad4> : detail::BoxElement<Quad4> {
    static constexpr auto stiffness_rule = detail::box_rule<2>();
    static constexpr auto mass_rule = detail::box_rule<2>();
};
template <>
struct Element<Hex8> : detail::BoxElement<Hex8> {
    static constexpr auto stiffness_rule = detail::box_rule<3>();
    static constexpr auto mass_rule = detail::box_rule<3>();
};
template <>
struct Element<detail::Line2> : detail::SimplexElement<detail::Line2> {
    static constexpr auto mass_rule = detail::line_rule();
};
template <>
struct Element<detail::Line3> : detail::SimplexElement<detail::Line3> {
    static constexpr auto mass_rule = detail::line_rule();
};

/// Cells that have a reference element.
template <class Cell>
concept FiniteElementCell = requires { Element<Cell>::stiffness_rule; };

} // namespace springfit::fem
