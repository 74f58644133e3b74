// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/closed_form/detail/box_cell.hpp>

namespace springfit {

/// Stiffness of rectangles with both diagonals after Baudet et al., per cell of sides l and w:
///
///     k_diagonal = E h (l^2 + w^2) / (4 l w (1 + nu)) ,   k_l = E h (w^2 (3 nu + 2) - l^2) / (4 l w (1 + nu)) ,
///
/// k_w likewise; an edge sums its cells. Shear is exact at any nu, every uniform strain at nu = 1/3. (k_diagonal is
/// derived here from shear; k_l is given from memory of the literature and checked at nu = 1/3.) Long cells make k_l
/// negative: clamped at 0. Plane strain: E / (1 - nu^2) and nu / (1 - nu) in place of E and nu.
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

} // namespace springfit
