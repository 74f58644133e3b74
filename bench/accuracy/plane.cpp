// SPDX-License-Identifier: BSD-3-Clause
#include <springfit/fem/dynamics.hpp>
#include <springfit/fem/statics.hpp>

#include "svg.hpp"
#include "trial.hpp"

namespace study {

namespace {

constexpr double young = 5e4;
constexpr double density = 1000;

template <CellType Cell>
Body<2, double> body_of(const Mesh<2, double, Cell>& mesh, const SpringNetwork<2, double>& network) {
    Body<2, double> body{mesh.nodes, network.mass, boundary_nodes(mesh), {}};
    body.clamps = {{side_nodes<2, double>(mesh.nodes, {0, false}, 0.02), {}}};
    return body;
}

/// One row: a mesh of a material at a strain.
template <CellType Cell, fem::Material Mat>
Row plane_row(const std::string& name, const Mesh<2, double, Cell>& mesh, const Mat& material, double strain,
              bool acceleration, const Settings& settings) {
    auto network = springs_along_edges(mesh, {.diagonals = !SimplexCell<Cell>, .density = density});
    const fem::Model model{mesh, material, density};
    CaseSettings cases;
    cases.strain = strain;
    cases.training = settings.quick ? 60 : 120;
    const auto sets = record_sets(model, edges(mesh), body_of(mesh, network), cases, settings);
    Row row;
    row.mesh = name;
    row.material = std::string(Mat::name);
    row.poisson = material.poisson;
    row.network = SimplexCell<Cell> ? "edges" : "edges, diagonals";
    row.setup = strain < 0.01 ? "small strain" : text("strain ", strain);
    run(row, mesh, {.young = young, .poisson = material.poisson}, network, sets, {.acceleration = acceleration},
        settings);
    return row;
}

struct PlaneMesh {
    std::string name;
    std::function<Row(int resolution, double poisson, int material, bool acceleration)> row;
};

} // namespace

void study_plane(Report& report, const Settings& settings) {
    report.begin("plane", "Plane stress",
                 "A sheet 0.8 m long, clamped at its left side (and, in training, at two others), by four kinds of mesh at three "
                 "resolutions. Springs along the edges; in squares, along the diagonals too. Small strain with the linear material, "
                 "5 % with the others.");
    const auto row_of = [&](const std::string& name, const auto& mesh, double poisson, int material, bool acceleration) {
        switch (material) {
        case 0: return plane_row(name, mesh, fem::LinearElastic{young, poisson}, 1e-4, acceleration, settings);
        case 1: return plane_row(name, mesh, fem::StVenantKirchhoff{young, poisson}, 0.05, false, settings);
        default: return plane_row(name, mesh, fem::NeoHookean{young, poisson}, 0.05, false, settings);
        }
    };
    const std::vector<PlaneMesh> meshes = {
        {"Delaunay",
         [&](int r, double nu, int material, bool acceleration) {
             return row_of("Delaunay", rectangle_mesh(0.8, 0.4, std::array{100, 250, 600}[static_cast<std::size_t>(r)]), nu,
                           material, acceleration);
         }},
        {"equilateral",
         [&](int r, double nu, int material, bool acceleration) {
             const int n = 12 << r;
             return row_of("equilateral", equilateral_triangles<double>(n, 7 * n / 12, 0.8 / n), nu, material,
                           acceleration);
         }},
        {"right-angled",
         [&](int r, double nu, int material, bool acceleration) {
             const int n = 12 << r;
             return row_of("right-angled", triangle_grid<double>({n, n / 2}, {0.8, 0.4}), nu, material, acceleration);
         }},
        {"squares",
         [&](int r, double nu, int material, bool acceleration) {
             const int n = 12 << r;
             return row_of("squares", quad_grid<double>({n, n / 2}, {0.8, 0.4}), nu, material, acceleration);
         }},
    };
    const std::vector<double> ratios = settings.quick ? std::vector{0., 1. / 3, 0.45}
                                                      : std::vector{0., 0.25, 1. / 3, 0.45, 0.49};
    const int bars_resolution = settings.quick ? 0 : 1;
    svg::Chart chart{.title = "Unseen loads, Delaunay mesh, plane stress", .x_label = "Poisson's ratio",
                     .y_label = "relative error", .log_y = true};
    chart.series = {{"best closed form", {}, {}}, {"trajectory", {}, {}}};
    for (const PlaneMesh& mesh : meshes) {
        const bool is_main = mesh.name == "Delaunay";
        for (int resolution = 0; resolution < (settings.quick ? 1 : 3); ++resolution) {
            for (double poisson : ratios) {
                for (int material = 0; material < 3; ++material) {
                    const bool is_linear = material == 0;
                    if (interrupted() || (!is_linear && (settings.quick || resolution != bars_resolution)) ||
                        (settings.quick && !is_main && poisson != ratios[1])) {
                        continue;
                    }
                    const bool at_bars = is_main && is_linear && resolution == bars_resolution;
                    Row row = mesh.row(resolution, poisson, material, resolution == bars_resolution && is_linear);
                    if (at_bars) {
                        chart.groups.push_back(text(std::round(100 * poisson) / 100));
                        chart.series[0].y.push_back(row.best_closed_form().loads);
                        chart.series[1].y.push_back(row.find("trajectory")->errors.loads);
                        if (poisson != 0.25 && poisson != 0.49) {
                            const Errors fitted = row.find("trajectory")->errors;
                            const Errors ratio = row.ratio("trajectory");
                            const std::string what = text("2D Delaunay, nu ", chart.groups.back());
                            report.at_most(what + ": unseen loads", fitted.loads, 0.010);
                            report.at_most(what + ": unseen kinds", fitted.kinds, 0.020);
                            report.at_least(what + ": ratio to the best closed form, loads", ratio.loads, 4);
                            report.at_least(what + ": ratio, kinds", ratio.kinds, 4);
                        }
                    }
                    report.add(std::move(row));
                }
            }
        }
    }
    report.figure("plane", svg::bars(chart));
}

} // namespace study
