// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fem/loads.hpp>
#include <springfit/fem/statics.hpp>
#include <springfit/mesh/structured.hpp>

namespace springfit::test {

/// A box of `cells` grid cells of one kind of cell.
template <class Cell, int Dim>
[[nodiscard]] auto grid(const GridSize<Dim>& cells, const Vector<Dim, double>& size) {
    if constexpr (std::same_as<Cell, Tri3>) {
        return triangle_grid<double>(cells, size);
    } else if constexpr (std::same_as<Cell, Tri6>) {
        return quadratic(triangle_grid<double>(cells, size));
    } else if constexpr (std::same_as<Cell, Quad4>) {
        return quad_grid<double>(cells, size);
    } else if constexpr (std::same_as<Cell, Tet4>) {
        return tetrahedron_grid<double>(cells, size);
    } else if constexpr (std::same_as<Cell, Tet10>) {
        return quadratic(tetrahedron_grid<double>(cells, size));
    } else {
        return hex_grid<double>(cells, size);
    }
}

/// The nodes where `where(position)` is true.
template <int Dim, class Cell, class Where>
[[nodiscard]] std::vector<int> nodes_where(const Mesh<Dim, double, Cell>& mesh, const Where& where) {
    std::vector<int> nodes;
    for (Index i = 0; i < mesh.n_nodes(); ++i) {
        if (where(Vector<Dim, double>(mesh.nodes.col(i)))) {
            nodes.push_back(static_cast<int>(i));
        }
    }
    return nodes;
}

/// The boundary facets whose corners are all where `where(position)` is true.
template <int Dim, class Cell, class Where>
[[nodiscard]] std::vector<Facet<Cell>> facets_where(const Mesh<Dim, double, Cell>& mesh, const Where& where) {
    auto facets = boundary_facets(mesh);
    std::erase_if(facets, [&](const Facet<Cell>& facet) {
        return !std::all_of(facet.corners.begin(), facet.corners.end(),
                            [&](int node) { return where(Vector<Dim, double>(mesh.nodes.col(node))); });
    });
    return facets;
}

/// The node nearest to a point.
template <int Dim, class Cell>
[[nodiscard]] Index node_at(const Mesh<Dim, double, Cell>& mesh, const Vector<Dim, double>& point) {
    Index node = 0;
    (mesh.nodes.colwise() - point).colwise().squaredNorm().minCoeff(&node);
    return node;
}

/// Cook's membrane: a trapezoid (0,0), (48,44), (48,60), (0,44), clamped at the left, shear force 1 on the right; inner
/// nodes `moved` by up to that part of an edge.
template <class Cell>
[[nodiscard]] Mesh<2, double, Cell> cook(int n, double moved) {
    auto mesh = grid<Cell, 2>({n, n}, {1., 1.});
    if (moved > 0) {
        jitter(mesh, moved, 2);
    }
    for (Index i = 0; i < mesh.n_nodes(); ++i) {
        const double s = mesh.nodes(0, i);
        const double t = mesh.nodes(1, i);
        mesh.nodes.col(i) << 48 * s, 44 * s + t * (44 - 28 * s);
    }
    return mesh;
}

/// Vertical displacement of the middle of the right edge of Cook's membrane.
template <class Cell>
[[nodiscard]] double cook_tip(int n, double poisson, const fem::ModelOptions<double>& options, double moved = 0) {
    const auto mesh = cook<Cell>(n, moved);
    const fem::Model model{mesh, fem::LinearElastic{1., poisson}, 1., options};
    Scenario<2, double> scenario;
    scenario.clamps = {{nodes_where(mesh, [](const auto& x) { return x(0) < 1e-9; }), {}}};
    scenario.loads = {
        fem::surface_traction(mesh, facets_where(mesh, [](const auto& x) { return x(0) > 48 - 1e-9; }), {0., 1. / 16})};
    const auto report = fem::equilibrium(model, scenario, 0., {.tolerance = 1e-9});
    const Index tip = node_at<2, Cell>(mesh, {48., 52.});
    return report.status == Status::converged ? report.state.positions(1, tip) - mesh.nodes(1, tip) : std::nan("");
}

/// Tip deflection of a clamped beam of length 10 and a square section of side 1 under a shear force P at its end, over
/// Timoshenko's P L^3 / (3 E I) + P L / (5/6 G A). `n` cells through the section, `along` the beam.
template <class Cell>
[[nodiscard]] double beam_tip(int n, double poisson, const fem::ModelOptions<double>& options, int along) {
    constexpr int dim = Cell::dimension;
    const double young = 1e4;
    const double force = 1e-3;
    const double length = 10;
    Vector<dim, double> size = Vector<dim, double>::Ones();
    GridSize<dim> cells;
    cells.fill(n);
    size(0) = length;
    cells[0] = along;
    const auto mesh = grid<Cell, dim>(cells, size);
    const fem::Model model{mesh, fem::LinearElastic{young, poisson}, 1., options};
    Scenario<dim, double> scenario;
    scenario.clamps = {{nodes_where(mesh, [](const auto& x) { return x(0) < 1e-9; }), {}}};
    Vector<dim, double> traction = Vector<dim, double>::Zero();
    traction(1) = force;
    scenario.loads = {
        fem::surface_traction(mesh, facets_where(mesh, [&](const auto& x) { return x(0) > length - 1e-9; }), traction)};
    const auto report = fem::equilibrium(model, scenario, 0., {.tolerance = 1e-8});
    Vector<dim, double> end = Vector<dim, double>::Constant(0.5);
    end(0) = length;
    const Index tip = node_at<dim, Cell>(mesh, end);
    const double plane_strain = options.plane == fem::Plane::strain ? 1 - poisson * poisson : 1.;
    const double bending = force * length * length * length / (3 * young / plane_strain / 12);
    const double shear = force * length / (5. / 6 * young / (2 * (1 + poisson)));
    return report.status == Status::converged
               ? (report.state.positions(1, tip) - mesh.nodes(1, tip)) / (bending + shear)
               : std::nan("");
}

} // namespace springfit::test
