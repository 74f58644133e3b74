// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>

#include <springfit/core/error.hpp>
#include <springfit/mesh/mesh.hpp>

namespace springfit::io {

/// The kinds of cell that files can hold, known at run time only.
enum class CellKind { triangle, quadratic_triangle, quadrilateral, tetrahedron, quadratic_tetrahedron, hexahedron };

inline constexpr std::array<CellKind, 6> cell_kinds{
    CellKind::triangle,    CellKind::quadratic_triangle,    CellKind::quadrilateral,
    CellKind::tetrahedron, CellKind::quadratic_tetrahedron, CellKind::hexahedron};

/// Calls `call(Cell{})` with the cell type of a kind and returns what it returns.
template <class Call>
constexpr auto with_cell(CellKind kind, const Call& call) {
    switch (kind) {
    case CellKind::triangle: return call(Tri3{});
    case CellKind::quadratic_triangle: return call(Tri6{});
    case CellKind::quadrilateral: return call(Quad4{});
    case CellKind::tetrahedron: return call(Tet4{});
    case CellKind::quadratic_tetrahedron: return call(Tet10{});
    case CellKind::hexahedron: break;
    }
    return call(Hex8{});
}

/// The kind of a cell type.
template <CellType Cell>
[[nodiscard]] constexpr CellKind cell_kind() {
    for (const CellKind kind : cell_kinds) {
        if (with_cell(kind, []<CellType C>(C) { return std::is_same_v<C, Cell>; })) {
            return kind;
        }
    }
    throw InvalidArgument("cell", "a cell type that files can hold", Cell::name);
}

/// Its name in words, as in `Cell::name`: "quadratic tetrahedron".
[[nodiscard]] constexpr std::string_view name(CellKind kind) {
    return with_cell(kind, []<CellType C>(C) { return C::name; });
}

/// The kind of this name, where there is one.
[[nodiscard]] inline std::optional<CellKind> cell_kind_of_name(std::string_view wanted) {
    for (const CellKind kind : cell_kinds) {
        if (name(kind) == wanted) {
            return kind;
        }
    }
    return std::nullopt;
}

/// 2 for surface cells, 3 for solid ones.
[[nodiscard]] constexpr int dimension(CellKind kind) {
    return with_cell(kind, []<CellType C>(C) { return int(C::dimension); });
}

[[nodiscard]] constexpr int n_nodes(CellKind kind) {
    return with_cell(kind, []<CellType C>(C) { return int(C::n_nodes); });
}

[[nodiscard]] constexpr int n_corners(CellKind kind) {
    return with_cell(kind, []<CellType C>(C) { return int(C::n_corners); });
}

} // namespace springfit::io
