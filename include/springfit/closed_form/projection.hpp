// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/closed_form/detail/simplex_edges.hpp>

namespace springfit {

/// The linear finite element seen along each edge, for any simplex and any nu:
///
///     k = -n' K_ij n = sum V [ (lambda + mu) / l^2 - mu grad N_i . grad N_j ] ,
///
/// K the stiffness of the constant-strain element, n the direction of the edge; in the plane V = A h and lambda is that
/// of plane stress, E nu / (1 - nu^2), or of plane strain, and the second term is (mu h / 2) cot(theta), theta opposite
/// the edge. Our derivation, exact as stated; what it leaves out is the part of K_ij across the edge. Negative at
/// obtuse angles: clamped at 0. The springs join the nodes of `corner_mesh(mesh)`.
///
/// Throws InvalidArgument for a material out of range, an inverted cell, an edge without a spring. O(cells log
/// springs).
template <int Dim, std::floating_point Scalar, SimplexCell Cell>
[[nodiscard]] ClosedForm<Scalar> projection(const Mesh<Dim, Scalar, Cell>& mesh, const NodePairs& springs,
                                            const IsotropicSolid& solid) {
    const auto constants = detail::constants<Dim, Cell, Scalar>(solid);
    return detail::sum_over_simplices(mesh, springs, constants, [&](const detail::SimplexEdge<Scalar>& edge) {
        return edge.volume * ((constants.lambda + constants.mu) / edge.squared_length - constants.mu * edge.gradients);
    });
}

} // namespace springfit
