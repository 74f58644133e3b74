// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <springfit/cgal/detail/pieces.hpp>
#include <springfit/mesh/simplex.hpp>

namespace springfit::cgal::detail {

using Solid = Mesh<3, double, Tet4>;

inline double cell_volume(const Solid& mesh, Index cell) {
    return signed_volume<3, double>(mesh.cell_nodes(cell));
}

/// Smallest angle between two faces of a cell, degrees.
inline double smallest_dihedral(const Solid& mesh, Index cell) {
    const auto x = mesh.cell_nodes(cell);
    std::array<Vector<3, double>, 4> normals;
    for (std::size_t f = 0; f < 4; ++f) {
        const auto& corner = Tet4::facets[f];
        normals[f] = (x.col(corner[1]) - x.col(corner[0])).cross(x.col(corner[2]) - x.col(corner[0])).normalized();
    }
    double largest_cosine = -1;
    for (std::size_t f = 0; f < 4; ++f) {
        for (std::size_t g = 0; g < f; ++g) {
            largest_cosine = std::max(largest_cosine, -normals[f].dot(normals[g]));
        }
    }
    return std::acos(std::min(1., largest_cosine)) * 180 / EIGEN_PI;
}

/// Takes off flakes: cells with a dihedral angle below `angle` (degrees) and two faces or more on the surface, again
/// and again. They hold next to no volume, and the mesher can neither move nor reweight nodes on sharp edges to mend
/// them.
[[nodiscard]] inline Solid without_flakes(Solid mesh, double angle) {
    while (true) {
        std::vector<int> on_surface(static_cast<std::size_t>(mesh.n_cells()), 0);
        for (const auto& facet : boundary_facets(mesh)) {
            ++on_surface[static_cast<std::size_t>(facet.cell)];
        }
        std::vector<bool> keep(on_surface.size());
        for (std::size_t c = 0; c < keep.size(); ++c) {
            keep[c] = on_surface[c] < 2 || smallest_dihedral(mesh, static_cast<Index>(c)) >= angle;
        }
        if (std::find(keep.begin(), keep.end(), false) == keep.end() ||
            std::find(keep.begin(), keep.end(), true) == keep.end()) {
            return mesh;
        }
        mesh = kept_cells(mesh, keep);
    }
}

/// Takes off crumbs: pieces that no face joins to the rest and that hold less than `share` of the volume.
[[nodiscard]] inline Solid without_crumbs(const Solid& mesh, double share) {
    const std::vector<int> piece = pieces(mesh);
    std::vector<double> volume(piece.size(), 0);
    double total = 0;
    for (std::size_t c = 0; c < piece.size(); ++c) {
        volume[static_cast<std::size_t>(piece[c])] += cell_volume(mesh, static_cast<Index>(c));
        total += cell_volume(mesh, static_cast<Index>(c));
    }
    std::vector<bool> keep(piece.size());
    for (std::size_t c = 0; c < keep.size(); ++c) {
        keep[c] = volume[static_cast<std::size_t>(piece[c])] >= share * total;
    }
    return std::find(keep.begin(), keep.end(), false) == keep.end() ? mesh : kept_cells(mesh, keep);
}

} // namespace springfit::cgal::detail
