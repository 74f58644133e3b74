// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/closed_form/detail/simplex_edges.hpp>

namespace springfit {

/// Van Gelder's stiffness of the edges of triangles or tetrahedra [VanGelder1998]:
///
///     2D, membranes: k = E h sum A / l^2 ,     3D: k = E sum V / l^2 ,
///
/// sums over the cells at the edge. nu does not enter. Exact for equilateral triangles with nu = 1/3 alone. In plane
/// strain E is replaced by E / (1 - nu^2). The springs join the nodes of `corner_mesh(mesh)`.
///
/// Throws InvalidArgument for a material out of range, an inverted cell, an edge without a spring. O(cells log
/// springs).
template <int Dim, std::floating_point Scalar, SimplexCell Cell>
[[nodiscard]] ClosedForm<Scalar> van_gelder(const Mesh<Dim, Scalar, Cell>& mesh, const NodePairs& springs,
                                            const IsotropicSolid& solid) {
    const auto constants = detail::constants<Dim, Cell, Scalar>(solid);
    return detail::sum_over_simplices(mesh, springs, constants, [&](const detail::SimplexEdge<Scalar>& edge) {
        return constants.young * edge.volume / edge.squared_length;
    });
}

/// The variant for triangles and any nu, in plane stress
///
///     k = sum [ E h / (1 + nu) A / l^2 + E h nu / (1 - nu^2) cot(theta) / 2 ] ,
///
/// theta the angle opposite the edge (the form is given from memory of the literature; at nu = 1/3 it is the
/// projection). Can be negative: clamped at 0. Plane strain: E / (1 - nu^2) and nu / (1 - nu) in place of E and nu.
template <int Dim, std::floating_point Scalar, SimplexCell Cell>
    requires(Cell::dimension == 2)
[[nodiscard]] ClosedForm<Scalar> van_gelder_any_poisson(const Mesh<Dim, Scalar, Cell>& mesh, const NodePairs& springs,
                                                        const IsotropicSolid& solid) {
    const auto constants = detail::constants<Dim, Cell, Scalar>(solid);
    const Scalar e = constants.young;
    const Scalar nu = constants.poisson;
    return detail::sum_over_simplices(mesh, springs, constants, [&](const detail::SimplexEdge<Scalar>& edge) {
        return e / (1 + nu) * edge.volume / edge.squared_length - e * nu / (1 - nu * nu) * edge.volume * edge.gradients;
    });
}

} // namespace springfit
