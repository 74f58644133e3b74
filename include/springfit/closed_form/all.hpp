// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/closed_form/baudet.hpp>
#include <springfit/closed_form/cubic_cell.hpp>
#include <springfit/closed_form/lloyd.hpp>
#include <springfit/closed_form/natsupakpong.hpp>
#include <springfit/closed_form/projection.hpp>
#include <springfit/closed_form/san_vicente.hpp>
#include <springfit/closed_form/van_gelder.hpp>

namespace springfit {

/// Every closed form of springs that holds for the cells of a mesh, the most common one first: `van_gelder` of
/// simplices, `baudet` of quadrilaterals, `cubic_cell` of hexahedra. A form is named as its function, but
/// `van_gelder_nu` for `van_gelder_any_poisson`.
///
/// Those whose cells have another shape, as squares, or for which an edge or diagonal has no spring, are left out;
/// `ClosedForm::caveat` tells of each of the others for what it is exact.
///
///     for (const auto& [name, form] : closed_forms(mesh, network.springs, {.young = 5e4, .poisson = 0.3})) ...
///
/// Throws InvalidArgument for a material out of range and an inverted cell.
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] std::vector<NamedClosedForm<Scalar>> closed_forms(const Mesh<Dim, Scalar, Cell>& mesh,
                                                                const NodePairs& springs, const IsotropicSolid& solid) {
    (void)detail::constants<Dim, Cell, Scalar>(solid);
    (void)cell_volumes(mesh);
    std::vector<NamedClosedForm<Scalar>> forms;
    const auto add = [&](const char* name, const auto& formula) {
        try {
            forms.push_back({name, formula()});
        } catch (const InvalidArgument& refusal) {
            if (refusal.argument() != "mesh" && refusal.argument() != "springs") {
                throw;
            }
        }
    };
    if constexpr (SimplexCell<Cell>) {
        add("van_gelder", [&] { return van_gelder(mesh, springs, solid); });
        if constexpr (Cell::dimension == 2) {
            add("van_gelder_nu", [&] { return van_gelder_any_poisson(mesh, springs, solid); });
        }
        add("projection", [&] { return projection(mesh, springs, solid); });
    } else {
        if constexpr (std::same_as<Cell, Hex8>) {
            add("cubic_cell", [&] { return cubic_cell(mesh, springs, solid); });
        }
        add("baudet", [&] { return baudet(mesh, springs, solid); });
    }
    if constexpr (std::same_as<Cell, Hex8>) {
        add("san_vicente", [&] { return san_vicente(mesh, springs, solid); });
    } else if constexpr (SimplexCell<Cell> || Dim == 2) { // its preload does not suit membranes of squares
        add("lloyd", [&] { return lloyd(mesh, springs, solid); });
    }
    add("natsupakpong", [&] { return natsupakpong(mesh, springs, solid); });
    return forms;
}

} // namespace springfit
