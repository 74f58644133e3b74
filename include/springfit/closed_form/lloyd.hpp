// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/closed_form/detail/box_cell.hpp>

namespace springfit {

/// Stiffness of the edges of triangles or tetrahedra after Lloyd, Szekely and Harders [Lloyd2007]:
///
///     2D, membranes: k = sum sqrt(3)/4 E h ,     3D: k = sum 2 sqrt(2)/25 E l ,   l = (12 V / sqrt(2))^(1/3) ,
///
/// sums over the cells at the edge; l is the edge of the regular tetrahedron of the same volume. nu does not enter.
/// Equilateral triangles at nu = 1/3 have the stiffness matrix of the finite elements exactly; for regular tetrahedra
/// at nu = 1/4 the value is the nearest one in the Frobenius norm, 1/5 of the matrix away. In plane strain E is
/// replaced by E / (1 - nu^2). The springs join the nodes of `corner_mesh(mesh)`.
///
/// Throws InvalidArgument for a material out of range, an inverted cell, an edge without a spring. O(cells log
/// springs).
template <int Dim, std::floating_point Scalar, SimplexCell Cell>
[[nodiscard]] ClosedForm<Scalar> lloyd(const Mesh<Dim, Scalar, Cell>& mesh, const NodePairs& springs,
                                       const IsotropicSolid& solid) {
    const auto constants = detail::constants<Dim, Cell, Scalar>(solid);
    return detail::sum_over_simplices(
        mesh, springs, constants,
        [&](const detail::SimplexEdge<Scalar>& edge) {
            if constexpr (Cell::dimension == 2) {
                return std::sqrt(Scalar(3)) / 4 * constants.young;
            } else {
                const Scalar length = std::cbrt(12 * edge.volume / std::sqrt(Scalar(2)));
                return 2 * std::sqrt(Scalar(2)) / 25 * constants.young * length;
            }
        },
        "exact for no tetrahedra; the nearest value for regular ones with Poisson's ratio 1/4");
}

/// Squares with both diagonals after the same authors [Lloyd2007], per cell of side l:
///
///     k_edge = 5/16 E h ,  rest length 6/5 l ;     k_diagonal = 7/16 E h ,  rest length 6/7 sqrt(2) l ,
///
/// an edge sums its cells. At nu = 1/3 the tangent stiffness at rest, with the part that the preload makes, is that of
/// the bilinear finite element exactly, the bending of the cell included. The edges push and the diagonals pull, so the
/// form is one of plane bodies: out of the plane it would buckle. Plane strain: E / (1 - nu^2) in place of E.
///
/// Throws InvalidArgument for a material out of range, a cell that is not a square, and a missing edge or diagonal.
template <std::floating_point Scalar>
[[nodiscard]] ClosedForm<Scalar> lloyd(const Mesh<2, Scalar, Quad4>& mesh, const NodePairs& springs,
                                       const IsotropicSolid& solid) {
    const auto constants = detail::constants<2, Quad4, Scalar>(solid);
    const SpringLookup lookup(springs);
    Values<Scalar> stiffness = Values<Scalar>::Zero(springs.cols());
    Values<Scalar> rest_length(springs.cols());
    for (Index e = 0; e < springs.cols(); ++e) {
        rest_length(e) = (mesh.nodes.col(springs(1, e)) - mesh.nodes.col(springs(0, e))).norm();
    }
    std::vector<bool> touched(static_cast<std::size_t>(springs.cols()), false);
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const Vector<2, Scalar> sides = detail::box_sides(mesh, c);
        if (!detail::all_equal(sides.cwiseAbs2())) {
            throw InvalidArgument("mesh", "square cells (baudet takes rectangles)",
                                  text("cell ", c, " with sides ", sides.transpose()));
        }
        // Cells that share an edge have the same side there, so their preloads add up to the same rest length.
        const auto add = [&](const std::array<int, 2>& ends, Scalar value, Scalar at_rest) {
            const int spring = detail::spring_on_edge(lookup, mesh.cells(ends[0], c), mesh.cells(ends[1], c));
            stiffness(spring) += value * constants.young;
            rest_length(spring) = at_rest;
            touched[static_cast<std::size_t>(spring)] = true;
        };
        const Scalar side = sides.mean();
        for (const auto& edge : Quad4::edges) {
            add(edge, Scalar(5) / 16, Scalar(6) / 5 * side);
        }
        for (const auto& diagonal : Quad4::diagonals) {
            add(diagonal, Scalar(7) / 16, Scalar(6) / 7 * std::sqrt(Scalar(2)) * side);
        }
    }
    auto result = detail::close(std::move(stiffness), touched, detail::has_poisson(constants, 1. / 3),
                                "exact for Poisson's ratio 1/3 alone");
    result.rest_length = std::move(rest_length);
    return result;
}

} // namespace springfit
