// SPDX-License-Identifier: BSD-3-Clause
#include "solid.hpp"
#include "svg.hpp"

namespace study {

namespace {

const std::vector<NetworkKind> all_networks = {edges_alone, with_ring, with_volume, with_both};

void add_edges_bars(Report& report, const std::string& what, const Row& row) {
    const Errors fitted = row.errors_of("trajectory");
    const Errors ratio = row.ratio();
    const bool nearly_incompressible = row.poisson == 0.45;
    report.at_most(what + ": unseen loads", fitted.loads, nearly_incompressible ? 0.03 : 0.02);
    report.at_most(what + ": unseen kinds", fitted.kinds, nearly_incompressible ? 0.09 : 0.06);
    report.at_least(what + ": ratio to the best closed form, loads", ratio.loads, 8);
    report.at_least(what + ": ratio, kinds", ratio.kinds, 8);
    if (nearly_incompressible) {
        report.at_most(what + ": unseen clamp", fitted.clamp, 0.25);
        report.at_least(what + ": ratio, clamp", ratio.clamp, 1.8);
    }
}

void add_both_bars(Report& report, const std::string& what, const Row& row) {
    const Errors fitted = row.errors_of("trajectory");
    const Errors ratio = row.ratio();
    const bool nearly_incompressible = row.poisson >= 0.45;
    report.at_most(what + ": unseen loads", fitted.loads, nearly_incompressible ? 0.008 : 0.015);
    report.at_most(what + ": unseen kinds", fitted.kinds, nearly_incompressible ? 0.025 : 0.04);
    report.at_least(what + ": ratio to the best closed form, loads", ratio.loads, 12);
    report.at_least(what + ": ratio, kinds", ratio.kinds, 12);
    if (nearly_incompressible) {
        Row springs_alone = row;
        std::erase_if(springs_alone.scores,
                      [](const Score& score) { return score.method.starts_with("cauchy_split"); });
        report.at_least(what + ": ratio to closed forms of springs alone, loads", springs_alone.ratio().loads, 50);
        report.at_least(what + ": ratio to closed forms of springs alone, kinds", springs_alone.ratio().kinds, 50);
    }
}

void add_bars(Report& report, const Row& row) {
    const std::string what = text("Box of tetrahedra, ", row.network, ", nu ", row.poisson);
    if (row.network == name_of(edges_alone) && row.poisson < 0.49) {
        add_edges_bars(report, what, row);
    } else if (row.network == name_of(with_both)) {
        add_both_bars(report, what, row);
    } else if (row.network == name_of(with_volume) && row.poisson == 0.45) {
        report.at_most(what + ": unseen clamp", row.errors_of("trajectory").clamp, 0.06);
        report.at_least(what + ": ratio, clamp", row.ratio().clamp, 7);
    }
}

std::vector<Row> box_rows(const std::string& name, const TetMesh& mesh, const ReferenceKind& reference,
                          const std::vector<NetworkKind>& networks, bool acceleration, const Settings& settings) {
    return solid_rows(name, mesh, body_of(mesh), reference, load_cases(settings.quick ? 60 : 120, settings),
                      small_strain, networks, fit_options(acceleration, settings), settings);
}

/// The rows that bars are read from: all networks on the finest box.
void add_bar_rows(Report& report, Index n_nodes, const std::vector<double>& ratios, const Settings& settings) {
    svg::Chart chart{.title = text("Unseen loads, box of ", n_nodes, " nodes"),
                     .x_label = "Poisson's ratio",
                     .y_label = "relative error",
                     .log_y = true};
    chart.series = {{"best form, springs", {}, {}}};
    for (const NetworkKind& kind : all_networks) {
        chart.series.push_back({name_of(kind), {}, {}});
    }
    const TetMesh box = box_mesh(box_size, n_nodes);
    for (double poisson : ratios) {
        const auto rows = box_rows("box, tetrahedra", box, {.poisson = poisson}, all_networks,
                                   settings.quick && poisson == 0.25, settings);
        chart.groups.push_back(text(poisson));
        chart.series[0].y.push_back(rows.front().best_closed_form().loads);
        for (std::size_t r = 0; r < rows.size(); ++r) {
            chart.series[r + 1].y.push_back(rows[r].errors_of("trajectory").loads);
            report.add(rows[r]);
            add_bars(report, rows[r]);
        }
        report.figure("solids", svg::bars(chart));
    }
}

void add_rows(Report& report, const std::vector<Row>& rows) {
    for (const Row& row : rows) {
        report.add(row);
    }
}

/// Coarser boxes, cut at random, references that do not lock, large strain.
void add_other_rows(Report& report, const std::vector<double>& ratios, const Settings& settings) {
    const TetMesh coarse = box_mesh(box_size, 150);
    const TetMesh middle = box_mesh(box_size, 400);
    const TetMesh cut = random_cut_box({9, 4, 4}, box_size, 3);
    for (double poisson : ratios) {
        const ReferenceKind linear{.poisson = poisson};
        add_rows(report, box_rows("box, tetrahedra", coarse, linear, {edges_alone, with_both}, true, settings));
        add_rows(report,
                 box_rows("box, tetrahedra", middle, linear, {edges_alone, with_both}, poisson == 0.25, settings));
        add_rows(report, box_rows("box, cut at random", cut, linear, {edges_alone, with_both}, false, settings));
    }
    for (double poisson : {0.45, 0.49}) {
        add_rows(report, box_rows("box, tetrahedra", middle, {.poisson = poisson, .mean_dilatation = true},
                                  {edges_alone, with_volume, with_both}, false, settings));
    }
    auto large = fit_options(false, settings);
    large.prior_weight = 1e-3; // with 1e-5, some held-out cases find no equilibrium
    for (MaterialKind material : {MaterialKind::st_venant_kirchhoff, MaterialKind::neo_hookean}) {
        for (double poisson : {0.25, 0.45}) {
            const double strain = material == MaterialKind::neo_hookean ? 0.1 : 0.05;
            add_rows(report,
                     solid_rows("box, tetrahedra", coarse, body_of(coarse), {.material = material, .poisson = poisson},
                                load_cases(45, settings), strain, {edges_alone, with_volume}, large, settings));
        }
    }
}

} // namespace

void study_solids(Report& report, const Settings& settings) {
    report.begin(
        "solids", "Solids",
        "A box of 0.8 x 0.3 x 0.3 m, clamped at one end (in training, at two other sides too), as tetrahedra by "
        "Delaunay refinement and as jittered hexahedra cut at random; braced hexahedra; a membrane. Networks have "
        "springs along the edges, besides them springs between vertices that face each other across a triangle "
        "(second ring), cells that hold their volume, or both. Bars are read on the finest box.\n\n"
        "The reference takes linear tetrahedra as they are: near nu = 1/2 they are too stiff for the continuum, "
        "and it is their motion that networks on the same nodes are measured by. Rows with *mean dilatation* have "
        "a reference that does not lock, whose volume measure is an average around each node. That is harder for "
        "cells, which hold their volume each on its own; volume stiffness then starts at no more than 6 shear "
        "moduli.\n\n"
        "Below nu = 1/4, where the closed form of the cells would be negative, it is 0; fits may go below. At large "
        "strain, the weight of the prior is 1e-3.");
    const auto ratios = settings.quick ? std::vector{0.25, 0.45} : std::vector{0., 0.25, 0.45, 0.49};
    add_bar_rows(report, settings.quick ? 150 : 1000, ratios, settings);
    add_braced_rows(report, settings);
    if (!settings.quick) {
        add_other_rows(report, ratios, settings);
    }
}

} // namespace study
