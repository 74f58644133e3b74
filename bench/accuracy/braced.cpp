// SPDX-License-Identifier: BSD-3-Clause
#include <springfit/mesh/structured.hpp>
#include <springfit/network/builders.hpp>

#include "solid.hpp"

namespace study {

namespace {

/// A box of hexahedra with springs along all edges and diagonals.
Row hexahedra_row(const std::array<int, 3>& cells, double poisson, const Settings& settings) {
    const auto mesh = hex_grid<double>(cells, {box_size[0], box_size[1], box_size[2]});
    const auto network = springs_along_edges(mesh, {.diagonals = true, .density = density});
    const fem::LinearElastic material{young, poisson};
    auto body = specimen_of(mesh, density);
    body.clamps = {{side_nodes<3, double>(mesh.nodes, {0, false}, 0.02), {}}};
    const auto cases =
        equilibria(fem_recorder(mesh, material, density), body, load_cases(60, settings), small_strain, settings);
    Row row;
    row.mesh = "box, hexahedra";
    row.material = std::string(fem::LinearElastic::name);
    row.poisson = poisson;
    row.network = "edges, diagonals";
    row.setup = strain_text(small_strain);
    add_scores(row, closed_form_networks(mesh, network, {.young = young, .poisson = poisson}), cases,
               fit_options(false, settings));
    return row;
}

/// A flat sheet in space, stretched by 4 % by its rim and loaded within its plane.
Row membrane_row(double poisson, const Settings& settings) {
    const auto mesh = membrane(rectangle_mesh(0.8, 0.4, 150));
    const auto network = springs_along_edges(mesh, {.density = density});
    const fem::StVenantKirchhoff material{young, poisson};
    auto body = specimen_of(mesh, density);
    body.clamps = {
        {boundary_nodes(mesh), [](const Vector<3, double>& rest, double) -> Vector<3, double> { return 1.04 * rest; }}};
    auto loads = load_cases(60, settings);
    loads.clamps = 1;
    loads.held_out_clamp = 0;
    const auto cases = equilibria(fem_recorder(mesh, material, density), body, loads, 0.1, settings);
    Row row;
    row.mesh = "membrane";
    row.material = std::string(fem::StVenantKirchhoff::name);
    row.poisson = poisson;
    row.network = name_of(edges_alone);
    row.setup = "rim stretched by 4 %, loads in the plane";
    add_scores(row, closed_form_networks(mesh, network, {.young = young, .poisson = poisson}), cases,
               fit_options(false, settings));
    return row;
}

} // namespace

void add_braced_rows(Report& report, const Settings& settings) {
    report.add(hexahedra_row({6, 2, 2}, 0.25, settings));
    if (settings.quick) {
        return;
    }
    report.add(hexahedra_row({6, 2, 2}, 0.45, settings));
    report.add(hexahedra_row({11, 4, 4}, 0.25, settings));
    report.add(hexahedra_row({11, 4, 4}, 0.45, settings));
    report.add(membrane_row(0.25, settings));
    report.add(membrane_row(1. / 3, settings));
}

} // namespace study
