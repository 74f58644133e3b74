// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <concepts>
#include <string_view>

namespace springfit {

/// A kind of cell: its nodes, corners first, then one node in the middle of each edge where it is quadratic.
///
/// `edges` joins corners; `diagonals` joins the corners that no edge joins (none in simplices); `facets` lists the
/// corners of each boundary part (edges in the plane, faces in space), ordered so that its normal points outwards.
template <class C>
concept CellType = requires {
    { C::name } -> std::convertible_to<std::string_view>;
    { C::dimension } -> std::convertible_to<int>; // 2: surface cell, 3: solid cell
    { C::n_nodes } -> std::convertible_to<int>;
    { C::n_corners } -> std::convertible_to<int>;
    C::edges;
    C::diagonals;
    C::facets;
};

/// Triangle, corners counter-clockwise.
struct Tri3 {
    static constexpr std::string_view name = "triangle";
    static constexpr int dimension = 2;
    static constexpr int n_nodes = 3;
    static constexpr int n_corners = 3;
    static constexpr std::array<std::array<int, 2>, 3> edges{{{0, 1}, {1, 2}, {2, 0}}};
    static constexpr std::array<std::array<int, 2>, 0> diagonals{};
    static constexpr std::array<std::array<int, 2>, 3> facets{{{0, 1}, {1, 2}, {2, 0}}};
};

/// Quadratic triangle: node 3 + e lies on edge e of Tri3.
struct Tri6 : Tri3 {
    static constexpr std::string_view name = "quadratic triangle";
    static constexpr int n_nodes = 6;
};

/// Quadrilateral, corners counter-clockwise.
struct Quad4 {
    static constexpr std::string_view name = "quadrilateral";
    static constexpr int dimension = 2;
    static constexpr int n_nodes = 4;
    static constexpr int n_corners = 4;
    static constexpr std::array<std::array<int, 2>, 4> edges{{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
    static constexpr std::array<std::array<int, 2>, 2> diagonals{{{0, 2}, {1, 3}}};
    static constexpr std::array<std::array<int, 2>, 4> facets{{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
};

/// Tetrahedron: corner 3 lies on the side that the normal of (0, 1, 2) points to.
struct Tet4 {
    static constexpr std::string_view name = "tetrahedron";
    static constexpr int dimension = 3;
    static constexpr int n_nodes = 4;
    static constexpr int n_corners = 4;
    static constexpr std::array<std::array<int, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
    static constexpr std::array<std::array<int, 2>, 0> diagonals{};
    static constexpr std::array<std::array<int, 3>, 4> facets{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
};

/// Quadratic tetrahedron: node 4 + e lies on edge e of Tet4 (the order of VTK).
struct Tet10 : Tet4 {
    static constexpr std::string_view name = "quadratic tetrahedron";
    static constexpr int n_nodes = 10;
};

/// Hexahedron: corners 0 to 3 counter-clockwise seen from above, 4 to 7 above them (the order of VTK).
struct Hex8 {
    static constexpr std::string_view name = "hexahedron";
    static constexpr int dimension = 3;
    static constexpr int n_nodes = 8;
    static constexpr int n_corners = 8;
    static constexpr std::array<std::array<int, 2>, 12> edges{
        {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
    /// The twelve face diagonals, then the four body diagonals.
    static constexpr std::array<std::array<int, 2>, 16> diagonals{{{0, 2},
                                                                   {1, 3},
                                                                   {4, 6},
                                                                   {5, 7},
                                                                   {0, 5},
                                                                   {1, 4},
                                                                   {1, 6},
                                                                   {2, 5},
                                                                   {2, 7},
                                                                   {3, 6},
                                                                   {3, 4},
                                                                   {0, 7},
                                                                   {0, 6},
                                                                   {1, 7},
                                                                   {2, 4},
                                                                   {3, 5}}};
    static constexpr std::array<std::array<int, 4>, 6> facets{
        {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
};

/// Cells whose edges join every pair of corners.
template <class C>
concept SimplexCell = CellType<C> && (C::n_corners == C::dimension + 1);

/// The cell with the same corners and no nodes on its edges.
template <CellType C>
struct LinearCellOf {
    using type = C;
};
template <>
struct LinearCellOf<Tri6> {
    using type = Tri3;
};
template <>
struct LinearCellOf<Tet10> {
    using type = Tet4;
};
template <CellType C>
using LinearCell = typename LinearCellOf<C>::type;

} // namespace springfit
