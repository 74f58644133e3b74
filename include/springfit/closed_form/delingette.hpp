// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/closed_form/isotropic_solid.hpp>
#include <springfit/network/biquadratic_network.hpp>

namespace springfit {

/// The coefficients of biquadratic springs.
template <std::floating_point Scalar>
struct BiquadraticCoefficients {
    TriangleValues<Scalar> tensile; ///< k_i [3 x n_triangles], N/m^3
    TriangleValues<Scalar> angular; ///< c_i [3 x n_triangles], N/m^3
};

/// Delingette's coefficients of triangles in the plane or in space, for any shape and any nu [Delingette2008]:
///
///     k_i = h [2 cot^2(a_i) (L + M) + M] / (16 A) ,   c_i = h [2 cot(a_j) cot(a_m) (L + M) - M] / (16 A) ,
///
/// a_i the angle at corner i, L = E nu / (1 - nu^2), M = E / (1 + nu); in plane strain L is lambda. The energy of the
/// network is that of linear triangles of a St Venant-Kirchhoff material exactly, at every deformation.
///
/// Throws InvalidArgument for a material out of range and an inverted triangle. O(triangles).
template <int Dim, std::floating_point Scalar, SimplexCell Cell>
    requires(Cell::dimension == 2)
[[nodiscard]] BiquadraticCoefficients<Scalar> delingette(const Mesh<Dim, Scalar, Cell>& mesh,
                                                         const IsotropicSolid& solid) {
    const auto constants = detail::constants<Dim, Cell, Scalar>(solid);
    const Scalar l = constants.lambda;
    const Scalar m = 2 * constants.mu;
    const auto corners = corner_mesh(mesh);
    BiquadraticCoefficients<Scalar> result;
    result.tensile.resize(3, corners.n_cells());
    result.angular.resize(3, corners.n_cells());
    for (Index t = 0; t < corners.n_cells(); ++t) {
        const Scalar area = detail::corner_volumes(corners, t).sum();
        const auto x = corners.cell_nodes(t);
        Vector<3, Scalar> cot;
        for (int i = 0; i < 3; ++i) {
            cot(i) = (x.col((i + 1) % 3) - x.col(i)).dot(x.col((i + 2) % 3) - x.col(i)) / (2 * area);
        }
        for (int i = 0; i < 3; ++i) {
            result.tensile(i, t) = (2 * cot(i) * cot(i) * (l + m) + m) / (16 * area);
            result.angular(i, t) = (2 * cot((i + 1) % 3) * cot((i + 2) % 3) * (l + m) - m) / (16 * area);
        }
    }
    return result;
}

/// Gives a network its coefficients. Throws InvalidArgument for another number of triangles.
template <int Dim, std::floating_point Scalar>
void apply(const BiquadraticCoefficients<Scalar>& coefficients, BiquadraticNetwork<Dim, Scalar>& network) {
    require(coefficients.tensile.cols() == network.n_triangles(), "coefficients",
            text(network.n_triangles(), " columns, one per triangle"), coefficients.tensile.cols());
    network.tensile = coefficients.tensile;
    network.angular = coefficients.angular;
}

} // namespace springfit
