// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/closed_form/detail/simplex_edges.hpp>

namespace springfit {

struct CauchySplitOptions {
    bool signed_volume = false; ///< keep kappa < 0, where Poisson's ratio is below 1/4 (plane stress: 1/3); else 0
};

/// The values that `cauchy_split` gives to springs and cells.
template <std::floating_point Scalar>
struct CauchySplit {
    ClosedForm<Scalar> springs;      ///< as of any closed form; its caveat is that of springs and cells together
    Values<Scalar> volume_stiffness; ///< kappa_c [n_cells], Pa; in the plane N/m
};

/// Springs that carry the Cauchy part (lambda = mu) of the material and cells that carry the rest:
///
///     3D: k = 5/2 mu sum V / l^2 ,      kappa = lambda - mu ,
///     2D: k = 8/3 h mu sum A / l^2 ,    kappa = h (lambda_2 - mu) ,
///
/// lambda_2 the plane lambda. Our definition, after the idea of Golec's hybrid model. The springs are Van Gelder's
/// [VanGelder1998] with Young's modulus mu (3 lambda + 2 mu) / (lambda + mu), in the plane
/// 4 mu (lambda_2 + mu) / (lambda_2 + 2 mu), of the solid with lambda = mu. The cells are the lambda - mu of the linear
/// finite element to the letter, so what is left between network and element does not depend on lambda: nothing at all
/// for equilateral triangles, and nothing for a uniform dilation of any mesh.
///
/// For a network with one cell per cell of the mesh (`add_volume_cells`); springs join the nodes of
/// `corner_mesh(mesh)`. Throws InvalidArgument for a material out of range, an inverted cell, an edge without a spring.
/// O(cells log springs).
template <int Dim, std::floating_point Scalar, SimplexCell Cell>
    requires(Cell::dimension == Dim)
[[nodiscard]] CauchySplit<Scalar> cauchy_split(const Mesh<Dim, Scalar, Cell>& mesh, const NodePairs& springs,
                                               const IsotropicSolid& solid, const CauchySplitOptions& options = {}) {
    const auto constants = detail::constants<Dim, Cell, Scalar>(solid);
    const Scalar mu = constants.mu;
    const Scalar young = (Dim == 2 ? Scalar(8) / 3 : Scalar(5) / 2) * mu;
    const detail::ElasticConstants<Scalar> cauchy{mu, mu, young, Dim == 2 ? Scalar(1) / 3 : Scalar(1) / 4};
    CauchySplit<Scalar> split;
    split.springs = detail::sum_over_simplices(mesh, springs, cauchy, [&](const detail::SimplexEdge<Scalar>& edge) {
        return young * edge.volume / edge.squared_length;
    });
    const Scalar kappa = constants.lambda - mu;
    const bool set_to_0 = kappa < 0 && !options.signed_volume;
    split.volume_stiffness = Values<Scalar>::Constant(mesh.n_cells(), set_to_0 ? Scalar(0) : kappa);
    if (set_to_0 && !detail::has_poisson(constants, static_cast<double>(cauchy.poisson))) {
        split.springs.caveat = "not exact where a negative volume stiffness was set to 0";
    } else if (!split.springs.caveat.empty()) {
        split.springs.caveat = "exact for uniform dilation alone";
    }
    return split;
}

/// Gives a network the stiffness of its springs and its cells. Throws InvalidArgument for another number of either.
template <int Dim, std::floating_point Scalar>
void apply(const CauchySplit<Scalar>& split, SpringNetwork<Dim, Scalar>& network) {
    require(split.volume_stiffness.size() == network.n_cells(), "split",
            text(network.n_cells(), " values, one per cell"), split.volume_stiffness.size());
    apply(split.springs, network);
    network.volume_stiffness = split.volume_stiffness;
}

} // namespace springfit
