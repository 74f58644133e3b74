// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/mesh/corner_mesh.hpp>
#include <springfit/mesh/detail/corner_volumes.hpp>

namespace springfit {

/// Volume of each cell between its corners `[n_cells]`, m^3; in the plane and on membranes area times `thickness`.
///
/// Throws InvalidArgument for a cell without positive volume (inverted or flat). O(cells).
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] Values<Scalar> cell_volumes(const Mesh<Dim, Scalar, Cell>& mesh, Scalar thickness = 1) {
    Values<Scalar> volumes(mesh.n_cells());
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        volumes(c) = detail::corner_volumes(mesh, c).sum();
    }
    return volumes * detail::thickness_factor<Cell>(thickness);
}

/// Masses of the network's nodes, the corners of the cells `[n_corner_nodes]`, kg:
///
///     m_i = sum over cells of rho h integral N_i dV ,
///
/// N_i linear in simplices (each corner gets V / n_corners), bilinear in quadrilaterals, trilinear in hexahedra. The
/// total is rho times the volume exactly; `thickness` h counts in the plane and on membranes alone.
///
/// Throws InvalidArgument unless density and thickness are positive, and for an inverted cell. O(cells).
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] Values<Scalar> node_masses(const Mesh<Dim, Scalar, Cell>& mesh, Scalar density, Scalar thickness = 1) {
    require(density > 0 && std::isfinite(density), "density", "a positive density", density);
    const auto corners = corner_mesh(mesh);
    const Scalar factor = density * detail::thickness_factor<Cell>(thickness);
    Values<Scalar> masses = Values<Scalar>::Zero(corners.n_nodes());
    for (Index c = 0; c < corners.n_cells(); ++c) {
        const auto volumes = detail::corner_volumes(corners, c);
        for (int a = 0; a < Cell::n_corners; ++a) {
            masses(corners.cells(a, c)) += factor * volumes(a);
        }
    }
    return masses;
}

} // namespace springfit
