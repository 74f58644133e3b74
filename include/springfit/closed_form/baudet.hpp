// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/closed_form/detail/braced_box.hpp>

namespace springfit {

/// Stiffness of rectangles with both diagonals after Baudet et al. [Baudet2007], per cell of sides l and w:
///
///     k_diagonal = E h (l^2 + w^2) / (4 l w (1 + nu)) ,   k_l = E h (w^2 (3 nu + 2) - l^2) / (4 l w (1 + nu)) ,
///
/// k_w likewise; an edge sums its cells. They follow from two conditions, for any nu: every shear has the modulus
/// E / (2 (1 + nu)), and a stretch eps with the contraction nu eps across has the stress E eps. (That contraction is
/// the network's own at nu = 1/3 alone, where every uniform strain is exact.) The form is given from memory of the
/// literature and confirmed by this derivation, which is ours. Long cells make k_l negative: clamped at 0. Plane
/// strain: E / (1 - nu^2) and nu / (1 - nu) in place of E and nu.
///
/// Throws InvalidArgument for a material out of range, a cell that is not a rectangle, and a missing edge or diagonal.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] ClosedForm<Scalar> baudet(const Mesh<Dim, Scalar, Quad4>& mesh, const NodePairs& springs,
                                        const IsotropicSolid& solid) {
    const auto constants = detail::constants<Dim, Quad4, Scalar>(solid);
    const SpringLookup lookup(springs);
    Values<Scalar> stiffness = Values<Scalar>::Zero(springs.cols());
    std::vector<bool> touched(static_cast<std::size_t>(springs.cols()), false);
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const Vector<2, Scalar> sides = detail::box_sides(mesh, c);
        const Scalar factor = constants.young / (4 * sides.prod() * (1 + constants.poisson));
        const auto add = [&](const std::array<int, 2>& ends, Scalar value) {
            const int spring = detail::spring_on_edge(lookup, mesh.cells(ends[0], c), mesh.cells(ends[1], c));
            stiffness(spring) += value;
            touched[static_cast<std::size_t>(spring)] = true;
        };
        for (std::size_t e = 0; e < Quad4::edges.size(); ++e) {
            const Scalar along = sides(e % 2) * sides(e % 2);
            const Scalar across = sides(1 - e % 2) * sides(1 - e % 2);
            add(Quad4::edges[e], factor * (across * (3 * constants.poisson + 2) - along));
        }
        for (const auto& diagonal : Quad4::diagonals) {
            add(diagonal, factor * sides.squaredNorm());
        }
    }
    return detail::close(std::move(stiffness), touched, detail::has_poisson(constants, 1. / 3),
                         "exact for Poisson's ratio 1/3 alone; in shear for any");
}

/// Braced hexahedral boxes in the manner of Baudet et al. [Baudet2009], by the two conditions of the rectangle: every
/// shear has the modulus mu = E / (2 (1 + nu)), and a stretch eps with the contraction nu eps across has the stress
/// E eps. The form is our derivation; no printed one is known to us. Diagonals as in `cubic_cell`, edges
///
///     k_edge,p = (1 + 2 nu) mu V / (2 a_p^2) - sum_q a_p^2 k_face,pq / (a_p^2 + a_q^2) - a_p^2 k_body / s ,
///
/// which at nu = 1/4, where every uniform strain is exact, is `cubic_cell`. Elsewhere the two differ: this one has the
/// stress of tension right where the contraction is that of the material, `cubic_cell` the solid with lambda = mu.
///
/// Throws InvalidArgument as `cubic_cell` does. O(cells log springs).
template <std::floating_point Scalar>
[[nodiscard]] ClosedForm<Scalar> baudet(const Mesh<3, Scalar, Hex8>& mesh, const NodePairs& springs,
                                        const IsotropicSolid& solid) {
    const auto constants = detail::constants<3, Hex8, Scalar>(solid);
    return detail::braced_boxes(mesh, springs, constants.mu, 2 + 4 * constants.poisson,
                                detail::has_poisson(constants, 0.25));
}

} // namespace springfit
