// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cgal/location.hpp>

namespace springfit::cgal {

template <int Dim, std::floating_point Scalar, CellType Cell>
Locator<Dim, Scalar, Cell>::Locator(const Mesh<Dim, Scalar, Cell>& mesh) : m_mesh(mesh) {
    validate(mesh);
    m_diameter = (mesh.nodes.rowwise().maxCoeff() - mesh.nodes.rowwise().minCoeff()).norm();
    detail::insert_boxes(mesh, m_tolerance * static_cast<double>(m_diameter), m_boxes);
    if constexpr (membrane) {
        for (Index c = 0; c < mesh.n_cells(); ++c) {
            std::vector<int> corners;
            for (int a = 0; a < Cell::n_corners; ++a) {
                corners.push_back(mesh.cells(a, c));
            }
            add_facet(static_cast<int>(c), -1, corners);
        }
    } else {
        for (const auto& facet : boundary_facets(mesh)) {
            add_facet(facet.cell, facet.local, std::vector<int>(facet.corners.begin(), facet.corners.end()));
        }
    }
    build_surface();
}

template <int Dim, std::floating_point Scalar, CellType Cell>
void Locator<Dim, Scalar, Cell>::add_facet(int cell, int local, const std::vector<int>& corners) {
    const int number = static_cast<int>(m_facets.size());
    SurfacePlace<Dim, Scalar> facet;
    facet.cell = cell;
    facet.facet = local;
    facet.nodes = Eigen::Map<const Eigen::VectorXi>(corners.data(), static_cast<Index>(corners.size()));
    m_facets.push_back(facet);
    if constexpr (n_piece_corners == 2) {
        m_pieces.push_back({number, {0, 1}});
    } else {
        for (int a = 2; a < static_cast<int>(corners.size()); ++a) {
            m_pieces.push_back({number, {0, a - 1, a}});
        }
    }
}

template <int Dim, std::floating_point Scalar, CellType Cell>
void Locator<Dim, Scalar, Cell>::build_surface() {
    std::vector<detail::NumberedShape<Piece>> shapes;
    shapes.reserve(m_pieces.size());
    for (std::size_t i = 0; i < m_pieces.size(); ++i) {
        const auto& nodes = m_facets[static_cast<std::size_t>(m_pieces[i].facet)].nodes;
        std::array<detail::PlainKernel::Point_3, n_piece_corners> p;
        for (std::size_t a = 0; a < p.size(); ++a) {
            p[a] = detail::plain_point(m_mesh.nodes.col(nodes(m_pieces[i].corners[a])));
        }
        shapes.emplace_back(static_cast<int>(i), std::make_from_tuple<Piece>(p), p[0]);
    }
    m_surface.insert(shapes.data(), shapes.data() + shapes.size());
    m_surface.build();
    m_surface.accelerate_distance_queries();
}

template <int Dim, std::floating_point Scalar, CellType Cell>
std::optional<CellPlace<Scalar, Cell>> Locator<Dim, Scalar, Cell>::cell_at(const Vector<Dim, Scalar>& point) const {
    if (!point.allFinite()) {
        return std::nullopt;
    }
    std::vector<int> candidates;
    m_boxes.all_intersected_primitives(detail::plain_point(point), std::back_inserter(candidates));
    std::sort(candidates.begin(), candidates.end());
    std::optional<CellPlace<Scalar, Cell>> deepest;
    double least_outside = m_tolerance;
    for (const int cell : candidates) {
        const auto at = detail::invert(m_mesh, cell, Vector<Dim, double>(point.template cast<double>()));
        if (!(at.found && at.outside <= least_outside) || (deepest && at.outside == least_outside)) {
            continue;
        }
        if constexpr (membrane) {
            const Vector<Dim, double> foot = m_mesh.cell_nodes(cell).template cast<double>() * at.weights;
            if (!((foot - point.template cast<double>()).norm() <= m_tolerance * static_cast<double>(m_diameter))) {
                continue;
            }
        }
        least_outside = at.outside;
        deepest = CellPlace<Scalar, Cell>{cell, at.weights.template cast<Scalar>()};
    }
    return deepest;
}

template <int Dim, std::floating_point Scalar, CellType Cell>
SurfacePlace<Dim, Scalar> Locator<Dim, Scalar, Cell>::nearest(const Vector<Dim, Scalar>& point) const {
    require(point.allFinite(), "point", "finite coordinates", text("(", point.transpose(), ")"));
    const auto [foot, number] = m_surface.closest_point_and_primitive(detail::plain_point(point));
    const FacetPiece& piece = m_pieces[static_cast<std::size_t>(number)];
    SurfacePlace<Dim, Scalar> place = m_facets[static_cast<std::size_t>(piece.facet)];

    // Coordinates of the foot on its segment or triangle, from the edges at the first corner.
    constexpr int n_edges = n_piece_corners - 1;
    const auto corner = [&](std::size_t a) -> Vector<Dim, double> {
        return m_mesh.nodes.col(place.nodes(piece.corners[a])).template cast<double>();
    };
    Vector<Dim, double> x;
    for (int d = 0; d < Dim; ++d) {
        x(d) = foot[d];
    }
    Eigen::Matrix<double, Dim, n_edges> sides;
    for (int e = 0; e < n_edges; ++e) {
        sides.col(e) = corner(static_cast<std::size_t>(e) + 1) - corner(0);
    }
    const Eigen::Matrix<double, n_edges, n_edges> normal = sides.transpose() * sides;
    const Eigen::Matrix<double, n_edges, 1> along =
        (normal.inverse() * (sides.transpose() * (x - corner(0)))).cwiseMax(0.).cwiseMin(1.);
    Eigen::Matrix<double, n_piece_corners, 1> share;
    share << std::max(0., 1 - along.sum()), along;
    share /= share.sum();

    place.weights.setZero(place.nodes.size());
    for (std::size_t a = 0; a < piece.corners.size(); ++a) {
        place.weights(piece.corners[a]) = static_cast<Scalar>(share(static_cast<Index>(a)));
    }
    place.point = x.template cast<Scalar>();
    place.distance = static_cast<Scalar>((x - point.template cast<double>()).norm());
    return place;
}

} // namespace springfit::cgal
