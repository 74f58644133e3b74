// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <utility>

#include <springfit/mesh/corner_mesh.hpp>
#include <springfit/mesh/simplex.hpp>
#include <springfit/network/spring_network.hpp>

namespace springfit {

namespace detail {

/// A cell as it stands: its corners and the relative change of its volume (V - V_c) / V_c.
template <int Dim, std::floating_point Scalar>
struct VolumeCell {
    SimplexCorners<Dim, Scalar> corners;
    Scalar volume;
    Scalar dilation;

    VolumeCell(const SpringNetwork<Dim, Scalar>& network, Index c, const Points<Dim, Scalar>& positions) {
        for (int a = 0; a <= Dim; ++a) {
            corners.col(a) = positions.col(network.cells(a, c));
        }
        volume = signed_volume<Dim, Scalar>(corners);
        dilation = (volume - network.rest_volume(c)) / network.rest_volume(c);
    }

    [[nodiscard]] SimplexCorners<Dim, Scalar> gradient() const { return volume_gradient<Dim, Scalar>(corners); }

    /// By each corner, a bound on the second derivative of V: the sum of the norms of its blocks.
    [[nodiscard]] Eigen::Matrix<Scalar, Dim + 1, 1> curvature() const {
        Eigen::Matrix<Scalar, Dim + 1, 1> sums;
        if constexpr (Dim == 2) {
            sums.setOnes(); // two blocks of norm 1/2
        } else {
            for (int a = 0; a < 4; ++a) {
                const Vector<3, Scalar> x = corners.col((a + 1) % 4);
                const Vector<3, Scalar> y = corners.col((a + 2) % 4);
                const Vector<3, Scalar> z = corners.col((a + 3) % 4);
                sums(a) = ((y - x).norm() + (z - y).norm() + (x - z).norm()) / 6;
            }
        }
        return sums;
    }
};

/// Splits a cell into simplices by pulling its corner of the lowest number: every facet away from it is cut likewise,
/// and each piece joined to it. Two cells cut a facet that they share along the same diagonal.
template <CellType Cell, class Visit>
void for_simplices(const std::array<int, static_cast<std::size_t>(Cell::n_corners)>& nodes, const Visit& visit) {
    const int apex = *std::min_element(nodes.begin(), nodes.end());
    if constexpr (SimplexCell<Cell>) {
        std::array<int, Cell::n_corners> corners;
        std::copy(nodes.begin(), nodes.end(), corners.begin());
        visit(corners);
    } else {
        for (auto facet : Cell::facets) {
            for (int& corner : facet) {
                corner = nodes[static_cast<std::size_t>(corner)];
            }
            if (std::find(facet.begin(), facet.end(), apex) != facet.end()) {
                continue;
            }
            if constexpr (Cell::dimension == 2) {
                visit(std::array<int, 3>{facet[0], facet[1], apex});
            } else {
                std::rotate(facet.begin(), std::min_element(facet.begin(), facet.end()), facet.end());
                visit(std::array<int, 4>{facet[0], facet[2], facet[1], apex});
                visit(std::array<int, 4>{facet[0], facet[3], facet[2], apex});
            }
        }
    }
}

} // namespace detail

/// Gives a network the cells of its mesh, at rest as they are, with volume stiffness 0 until a closed form or a fit
/// sets it. Cells that the network had are replaced.
///
/// Triangles and tetrahedra are taken as they are, those of a quadratic mesh between their corners. A quadrilateral is
/// split into two triangles and a hexahedron into six tetrahedra, from the corner of the lowest number, so that two
/// hexahedra cut the face between them alike and the pieces fill the body once; a volume stiffness belongs to each
/// piece.
///
/// Throws InvalidArgument for a membrane (its cells have no signed volume), for a mesh whose corners are not the
/// network's nodes, and for a piece without positive volume. O(cells).
template <int Dim, std::floating_point Scalar, CellType Cell>
void add_volume_cells(SpringNetwork<Dim, Scalar>& network, const Mesh<Dim, Scalar, Cell>& mesh) {
    if constexpr (is_membrane<Dim, Scalar, Cell>) {
        throw InvalidArgument("mesh", "cells that fill the plane or space", text("a membrane of cells ", Cell::name));
    } else {
        validate(mesh);
        const auto corners = corner_mesh(mesh);
        require(corners.n_nodes() == network.n_nodes(), "mesh",
                text(network.n_nodes(), " corners, the network's nodes"), corners.n_nodes());
        constexpr int most = Cell::n_corners == 4 && Dim == 2 ? 2 : Cell::n_corners == 8 ? 6 : 1;
        SimplexNodes<Dim> cells(Dim + 1, most * corners.n_cells());
        Values<Scalar> volumes(cells.cols());
        Index n = 0;
        for (Index c = 0; c < corners.n_cells(); ++c) {
            std::array<int, static_cast<std::size_t>(Cell::n_corners)> nodes;
            std::copy_n(corners.cells.col(c).data(), Cell::n_corners, nodes.begin());
            detail::for_simplices<Cell>(nodes, [&](const auto& simplex) {
                SimplexCorners<Dim, Scalar> x;
                for (int a = 0; a <= Dim; ++a) {
                    cells(a, n) = simplex[static_cast<std::size_t>(a)];
                    x.col(a) = corners.nodes.col(cells(a, n));
                }
                volumes(n) = signed_volume<Dim, Scalar>(x);
                if (!(volumes(n) > 0)) {
                    throw InvalidArgument("mesh", "cells of positive volume", text("cell ", c, ", inverted or flat"));
                }
                ++n;
            });
        }
        network.cells = std::move(cells);
        network.rest_volume = std::move(volumes);
        network.volume_stiffness = Values<Scalar>::Zero(n);
    }
}

/// Energy of the cells, sum_c 1/2 kappa_c (V - V_c)^2 / V_c at `positions` `[Dim x n_nodes]`, J. O(cells).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Scalar volume_energy(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions) {
    Scalar twice = 0;
    for (Index c = 0; c < network.n_cells(); ++c) {
        const detail::VolumeCell<Dim, Scalar> cell(network, c, positions);
        twice += network.volume_stiffness(c) * network.rest_volume(c) * cell.dilation * cell.dilation;
    }
    return twice / 2;
}

/// Adds the forces of the cells, -kappa_c (V - V_c) / V_c dV/dx_a on corner a, to `forces` `[Dim x n_nodes]`, N: a
/// uniform pressure in each cell. Finite at every position, inverted cells included. O(cells), no allocation.
template <int Dim, std::floating_point Scalar>
void add_volume_forces(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions,
                       Points<Dim, Scalar>& forces) {
    for (Index c = 0; c < network.n_cells(); ++c) {
        const detail::VolumeCell<Dim, Scalar> cell(network, c, positions);
        const SimplexCorners<Dim, Scalar> force = (-network.volume_stiffness(c) * cell.dilation) * cell.gradient();
        for (int a = 0; a <= Dim; ++a) {
            forces.col(network.cells(a, c)) += force.col(a);
        }
    }
}

} // namespace springfit
