// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <type_traits>

#include <springfit/fem/model.hpp>
#include <springfit/mesh/detail/measure.hpp>
#include <springfit/mesh/topology.hpp>
#include <springfit/motion/scenario.hpp>

namespace springfit::fem {

namespace detail {

/// The element of a facet of each cell.
template <class Cell>
struct FacetCell {
    using type = std::conditional_t<
        Cell::dimension == 3,
        std::conditional_t<Cell::n_corners == 8, Quad4, std::conditional_t<Cell::n_nodes == 10, Tri6, Tri3>>,
        std::conditional_t<Cell::n_nodes == 6, Line3, Line2>>;
};

/// Nodes of a facet: corners, then the nodes on its edges where it is quadratic.
template <int Dim, std::floating_point Scalar, FiniteElementCell Cell>
auto facet_nodes(const Mesh<Dim, Scalar, Cell>& mesh, const Facet<Cell>& facet) {
    using Flat = typename FacetCell<Cell>::type;
    Eigen::Matrix<int, Flat::n_nodes, 1> nodes;
    const auto& corners = Cell::facets[std::size_t(facet.local)];
    for (std::size_t a = 0; a < corners.size(); ++a) {
        nodes(static_cast<Index>(a)) = mesh.cells(corners[a], facet.cell);
    }
    if constexpr (Flat::n_nodes > static_cast<int>(std::tuple_size_v<std::remove_cvref_t<decltype(corners)>>)) {
        for (std::size_t e = 0; e < Flat::edges.size(); ++e) {
            const int i = corners[std::size_t(Flat::edges[e][0])];
            const int j = corners[std::size_t(Flat::edges[e][1])];
            for (std::size_t c = 0; c < Cell::edges.size(); ++c) {
                const auto& edge = Cell::edges[c];
                if ((edge[0] == i && edge[1] == j) || (edge[0] == j && edge[1] == i)) {
                    nodes(static_cast<Index>(corners.size() + e)) =
                        mesh.cells(Cell::n_corners + static_cast<int>(c), facet.cell);
                }
            }
        }
    }
    return nodes;
}

/// Adds int N_a t dA over a flat or curved piece with these nodes; `traction(jacobian, measure)` is t dA per weight.
template <class Flat, int Dim, std::floating_point Scalar, class Nodes, class Traction>
void add_facet(const Points<Dim, Scalar>& points, const Nodes& nodes, const Traction& traction,
               std::map<int, Vector<Dim, double>>& forces) {
    Eigen::Matrix<Scalar, Dim, Flat::n_nodes> positions;
    for (int a = 0; a < Flat::n_nodes; ++a) {
        positions.col(a) = points.col(nodes(a));
    }
    for (const auto& point : Element<Flat>::mass_rule) {
        const auto values = Element<Flat>::values(point.xi);
        const auto j = jacobian<Flat>(positions, point.xi);
        const Vector<Dim, double> force = point.weight * traction(j);
        for (int a = 0; a < Flat::n_nodes; ++a) {
            const auto place = forces.try_emplace(nodes(a), Vector<Dim, double>::Zero()).first;
            place->second += values[std::size_t(a)] * force;
        }
    }
}

template <int Dim, std::floating_point Scalar>
NodalLoad<Dim, Scalar> nodal_load(const std::map<int, Vector<Dim, double>>& forces, Amplitude<Scalar> amplitude) {
    NodalLoad<Dim, Scalar> load;
    load.forces.resize(Dim, static_cast<Index>(forces.size()));
    load.amplitude = std::move(amplitude);
    for (const auto& [node, force] : forces) {
        load.forces.col(static_cast<Index>(load.nodes.size())) = force.template cast<Scalar>();
        load.nodes.push_back(node);
    }
    return load;
}

/// Area vector of a piece: along its normal, of the length of its measure.
template <int Dim>
Vector<Dim, double> area_vector(const Eigen::Matrix<double, Dim, Dim - 1>& jacobian) {
    if constexpr (Dim == 2) {
        return {jacobian(1, 0), -jacobian(0, 0)};
    } else {
        return Vector<3, double>(jacobian.col(0)).cross(Vector<3, double>(jacobian.col(1)));
    }
}

} // namespace detail

/// Nodal forces of a uniform traction t on facets of the boundary, f_a = int N_a t dA over the rest surface.
///
/// `traction` in N/m^2 on solids; in the plane and on the rim of a membrane facets are edges, and it is in N per m of
/// edge (the traction times the thickness). The force is dead: it does not follow the surface. O(facets log facets).
template <int Dim, std::floating_point Scalar, FiniteElementCell Cell>
[[nodiscard]] NodalLoad<Dim, Scalar> surface_traction(const Mesh<Dim, Scalar, Cell>& mesh,
                                                      const std::vector<Facet<Cell>>& facets,
                                                      const std::type_identity_t<Vector<Dim, Scalar>>& traction,
                                                      std::type_identity_t<Amplitude<Scalar>> amplitude = {}) {
    require(traction.allFinite(), "traction", "finite components", traction.transpose());
    std::map<int, Vector<Dim, double>> forces;
    for (const auto& facet : facets) {
        detail::add_facet<typename detail::FacetCell<Cell>::type>(
            mesh.nodes, detail::facet_nodes(mesh, facet),
            [&](const auto& j) -> Vector<Dim, double> {
                return traction.template cast<double>() * springfit::detail::measure(j);
            },
            forces);
    }
    return detail::nodal_load<Dim, Scalar>(forces, std::move(amplitude));
}

/// Nodal forces of a uniform pressure on facets of the boundary, against their outward normals at rest (dead: neither
/// normals nor areas follow the deformation). N/m^2 on solids, N per m of edge in the plane.
template <int Dim, std::floating_point Scalar, FiniteElementCell Cell>
    requires(Dim == Cell::dimension)
[[nodiscard]] NodalLoad<Dim, Scalar>
pressure(const Mesh<Dim, Scalar, Cell>& mesh, const std::vector<Facet<Cell>>& facets,
         std::type_identity_t<Scalar> value, std::type_identity_t<Amplitude<Scalar>> amplitude = {}) {
    require(std::isfinite(value), "pressure", "a finite value", value);
    std::map<int, Vector<Dim, double>> forces;
    for (const auto& facet : facets) {
        detail::add_facet<typename detail::FacetCell<Cell>::type>(
            mesh.nodes, detail::facet_nodes(mesh, facet),
            [&](const auto& j) -> Vector<Dim, double> { return -double(value) * detail::area_vector<Dim>(j); }, forces);
    }
    return detail::nodal_load<Dim, Scalar>(forces, std::move(amplitude));
}

/// Nodal forces of a uniform pressure on one side of a whole membrane, along the normals of its cells at rest (dead),
/// so that a sphere oriented outwards is blown up by a positive value, N/m^2.
template <std::floating_point Scalar, FiniteElementCell Cell>
    requires(Cell::dimension == 2)
[[nodiscard]] NodalLoad<3, Scalar> pressure(const Mesh<3, Scalar, Cell>& mesh, std::type_identity_t<Scalar> value,
                                            std::type_identity_t<Amplitude<Scalar>> amplitude = {}) {
    require(std::isfinite(value), "pressure", "a finite value", value);
    std::map<int, Vector<3, double>> forces;
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        detail::add_facet<Cell>(
            mesh.nodes, mesh.cells.col(c),
            [&](const auto& j) -> Vector<3, double> { return double(value) * detail::area_vector<3>(j); }, forces);
    }
    return detail::nodal_load<3, Scalar>(forces, std::move(amplitude));
}

/// Nodal forces of a force per rest volume, f_a = int N_a b(X) dV: `field(X)` in N/m^3 at a rest position X.
template <class M, class Field>
    requires std::convertible_to<std::invoke_result_t<const Field&, const Vector<M::dimension, typename M::Scalar>&>,
                                 Vector<M::dimension, typename M::Scalar>>
[[nodiscard]] NodalLoad<M::dimension, typename M::Scalar>
body_force(const M& model, const Field& field, std::type_identity_t<Amplitude<typename M::Scalar>> amplitude = {}) {
    constexpr int dim = M::dimension;
    using Scalar = typename M::Scalar;
    const auto& mesh = model.mesh();
    std::map<int, Vector<dim, double>> forces;
    model.for_mass_points([&](Index cell, const auto& shape, double volume) {
        const Vector<dim, Scalar> at = mesh.cell_nodes(cell) * shape.template cast<Scalar>();
        const Vector<dim, Scalar> density = field(at);
        for (int a = 0; a < shape.size(); ++a) {
            const auto place = forces.try_emplace(mesh.cells(a, cell), Vector<dim, double>::Zero()).first;
            place->second += volume * shape(a) * density.template cast<double>();
        }
    });
    return detail::nodal_load<dim, Scalar>(forces, std::move(amplitude));
}

} // namespace springfit::fem
