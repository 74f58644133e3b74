// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/closed_form/detail/braced_box.hpp>

namespace springfit {

/// Stiffness of braced hexahedral boxes: edges with face diagonals, with body diagonals, or with both; which, the
/// network's springs tell. Per cell of sides a_p, with V the volume and s = a_1^2 + a_2^2 + a_3^2,
///
///     k_body    = b mu s V / (4 max a_p^2 a_q^2) ,
///     k_face,pq = (a_p^2 + a_q^2) (mu V / (4 a_p^2 a_q^2) - k_body / s) ,
///     k_edge,p  = 3 mu V / (4 a_p^2) - sum_q a_p^2 k_face,pq / (a_p^2 + a_q^2) - a_p^2 k_body / s ,
///
/// where b, the share of the body diagonals in the shear, is 0, 1 (cubes alone) or, with both, 1/2 (our choice). It
/// gives every uniform strain the energy of a solid with lambda = mu = E / (2 (1 + nu)): exact at nu = 1/4, and in
/// shear at any nu. For cubes of side a, face diagonals at nu = 1/4: k_edge = a E / 10, k_face = a E / 5 (Kot et al.);
/// body diagonals: k_edge = a E / (4 (1 + nu)), k_body = 3 a E / (8 (1 + nu)). The derivation for boxes is ours. Long
/// boxes make k_edge negative: clamped at 0.
///
/// Throws InvalidArgument for a material out of range, a cell that is no box, body diagonals alone on a box that is no
/// cube, and springs that leave an edge, or one of the diagonals of a kind, without a spring. O(cells log springs).
template <std::floating_point Scalar>
[[nodiscard]] ClosedForm<Scalar> cubic_cell(const Mesh<3, Scalar, Hex8>& mesh, const NodePairs& springs,
                                            const IsotropicSolid& solid) {
    const auto constants = detail::constants<3, Hex8, Scalar>(solid);
    return detail::braced_boxes(mesh, springs, constants.mu, Scalar(3), detail::has_poisson(constants, 0.25));
}

} // namespace springfit
