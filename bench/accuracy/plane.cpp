// SPDX-License-Identifier: BSD-3-Clause
#include <functional>

#include <springfit/cases/fem_recorder.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/network/builders.hpp>

#include "svg.hpp"
#include "trial.hpp"

namespace study {

namespace {

constexpr double young = 5e4;
constexpr double density = 1000;
constexpr double large_strain = 0.05;
constexpr double large_strain_prior_weight = 1e-3; ///< with 1e-5, some unseen kinds find no equilibrium

/// One row: a mesh of a material at a strain.
template <CellType Cell, fem::Material Mat>
Row plane_row(const std::string& name, const Mesh<2, double, Cell>& mesh, const Mat& material, bool acceleration,
              const Settings& settings) {
    const auto network = springs_along_edges(mesh, {.diagonals = !SimplexCell<Cell>, .density = density});
    auto body = specimen_of(mesh, density);
    body.surface = boundary_nodes(mesh);
    body.clamps = {{side_nodes<2, double>(mesh.nodes, {0, false}, 0.02), {}}};
    constexpr bool is_linear = std::same_as<Mat, fem::LinearElastic>;
    const double strain = is_linear ? small_strain : large_strain;
    const auto cases = equilibria(fem_recorder(mesh, material, density), body,
                                  load_cases(settings.quick || !is_linear ? 60 : 200, settings), strain, settings);
    Row row;
    row.mesh = name;
    row.material = std::string(Mat::name);
    row.poisson = material.poisson;
    row.network = SimplexCell<Cell> ? "edges" : "edges, diagonals";
    row.setup = strain_text(strain);
    auto how = fit_options(acceleration && is_linear, settings);
    how.prior_weight = is_linear ? how.prior_weight : large_strain_prior_weight;
    add_scores(row, closed_form_networks(mesh, network, {.young = young, .poisson = material.poisson}), cases, how);
    return row;
}

/// The materials of a row by number.
enum PlaneMaterial { linear, st_venant_kirchhoff, neo_hookean };

template <CellType Cell>
Row row_of(const std::string& name, const Mesh<2, double, Cell>& mesh, double poisson, PlaneMaterial material,
           bool acceleration, const Settings& settings) {
    switch (material) {
    case st_venant_kirchhoff:
        return plane_row(name, mesh, fem::StVenantKirchhoff{young, poisson}, acceleration, settings);
    case neo_hookean: return plane_row(name, mesh, fem::NeoHookean{young, poisson}, acceleration, settings);
    default: return plane_row(name, mesh, fem::LinearElastic{young, poisson}, acceleration, settings);
    }
}

/// Calls `visit(name, mesh)` for each kind of mesh at a resolution.
template <class Visit>
void for_meshes(int resolution, const Visit& visit) {
    const int n = 12 << resolution;
    visit("Delaunay", rectangle_mesh(0.8, 0.4, std::array{100, 260, 1200}[static_cast<std::size_t>(resolution)]));
    visit("equilateral", equilateral_triangles<double>(n, 7 * n / 12, 0.8 / n));
    visit("right-angled", triangle_grid<double>({n, n / 2}, {0.8, 0.4}));
    visit("squares", quad_grid<double>({n, n / 2}, {0.8, 0.4}));
}

void add_bars(Report& report, const Row& row) {
    const std::string what = text("Plane Delaunay, nu ", std::round(100 * row.poisson) / 100);
    const Errors fitted = row.errors_of("trajectory");
    report.at_most(what + ": unseen loads", fitted.loads, 0.010);
    report.at_most(what + ": unseen kinds", fitted.kinds, 0.020);
    report.at_least(what + ": ratio to the best closed form, loads", row.ratio().loads, 4);
    report.at_least(what + ": ratio, kinds", row.ratio().kinds, 4);
}

/// Linear rows of every mesh and Poisson's ratio at one resolution; `chart` gets those of the Delaunay mesh.
void add_linear_rows(Report& report, int resolution, bool is_finest, const std::vector<double>& ratios,
                     svg::Chart& chart, const Settings& settings) {
    for_meshes(resolution, [&](const std::string& name, const auto& mesh) {
        const bool is_main = name == "Delaunay";
        for (double poisson : ratios) {
            if (settings.quick && !is_main && poisson != 1. / 3) {
                continue;
            }
            const Row row = row_of(name, mesh, poisson, linear, is_finest || poisson == 1. / 3, settings);
            report.add(row);
            if (is_main && is_finest) {
                chart.groups.push_back(text(std::round(100 * poisson) / 100));
                chart.series[0].y.push_back(row.best_closed_form().loads);
                chart.series[1].y.push_back(row.errors_of("trajectory").loads);
                chart.series[2].y.push_back(row.errors_of("dominant term").loads);
                if (poisson != 0.25 && poisson != 0.49) {
                    add_bars(report, row);
                }
            }
        }
    });
}

} // namespace

void study_plane(Report& report, const Settings& settings) {
    report.begin(
        "plane", "Plane stress",
        "A sheet 0.8 m long, clamped at its left side (and, in training, at two others), by four kinds of mesh at "
        "three resolutions; springs along the edges, in squares along the diagonals too. The linear material at "
        "small strain, the others at 5 % and with a prior weight of 1e-3. Bars are read on the finest Delaunay mesh. "
        "On equilateral triangles and "
        "on squares at nu = 1/3 a closed form is exact but for the rotation that even small loads make.");
    const auto ratios = settings.quick ? std::vector{0., 1. / 3, 0.45} : std::vector{0., 0.25, 1. / 3, 0.45, 0.49};
    svg::Chart chart{.title = "Unseen loads, Delaunay mesh, plane stress",
                     .x_label = "Poisson's ratio",
                     .y_label = "relative error",
                     .log_y = true};
    chart.series = {{"best closed form", {}, {}}, {"trajectory", {}, {}}, {"dominant term", {}, {}}};
    const int finest = settings.quick ? 0 : 2;
    for (int resolution = 0; resolution <= finest; ++resolution) {
        add_linear_rows(report, resolution, resolution == finest, ratios, chart, settings);
    }
    report.figure("plane", svg::bars(chart));
    if (settings.quick) {
        return;
    }
    for_meshes(1, [&](const std::string& name, const auto& mesh) {
        for (PlaneMaterial material : {st_venant_kirchhoff, neo_hookean}) {
            for (double poisson : ratios) {
                report.add(row_of(name, mesh, poisson, material, false, settings));
            }
        }
    });
}

} // namespace study
