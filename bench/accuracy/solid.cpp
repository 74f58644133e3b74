// SPDX-License-Identifier: BSD-3-Clause
#include <springfit/fem/statics.hpp>

#include "solid.hpp"
#include "svg.hpp"

namespace study {

CaseSets<3> linear_sets(const Mesh<3, double, Tet4>& mesh, double poisson, const CaseSettings& cases,
                        const Settings& settings) {
    const fem::Model model{mesh, fem::LinearElastic{young, poisson}, density, model_options(poisson)};
    return record_sets(model, edges(mesh), body_of(mesh, model.masses()), cases, settings);
}

std::vector<Score> edge_form_scores(const Mesh<3, double, Tet4>& mesh, double poisson, const CaseSets<3>& sets,
                                    const Settings& settings) {
    const auto network = springs_along_edges(mesh, {.density = density});
    std::vector<Score> scores;
    for (const auto& [name, form] : closed_forms(mesh, network.springs, {.young = young, .poisson = poisson})) {
        auto closed = network;
        apply(form, closed);
        scores.push_back({name, true, errors(closed, sets, settings), 0, form.caveat});
    }
    return scores;
}

template double error<3>(const SpringNetwork<3, double>&, const Cases<3>&, const Settings&);
template Score trajectory_score<3>(SpringNetwork<3, double>&, const std::vector<Motion<3, double>>&,
                                   const CaseSets<3>&, const FitSettings&, const Settings&);

namespace {

/// One row per network; the closed forms on edges alone are those of every row.
template <class Reference>
std::vector<Row> tetrahedra_rows(const std::string& name, const Reference& model,
                                 const Mesh<3, double, Tet4>& mesh, const Body<3, double>& body,
                                 const CaseSettings& cases, const std::vector<NetworkKind>& networks,
                                 const Methods& methods, const Settings& settings) {
    const double poisson = model.material().poisson;
    const auto sets = record_sets(model, edges(mesh), body, cases, settings);
    const auto forms = edge_form_scores(mesh, poisson, sets, settings);
    std::vector<Row> rows;
    for (const NetworkKind& kind : networks) {
        if (interrupted()) {
            break;
        }
        Row row;
        row.mesh = name;
        row.material = std::string(std::decay_t<decltype(model.material())>::name);
        row.poisson = poisson;
        row.network = name_of(kind);
        row.setup = cases.strain < 0.01 ? "small strain" : text("strain ", cases.strain);
        if (const int left_out = sets.training.left_out + sets.loads.left_out + sets.kinds.left_out +
                                 sets.clamp.left_out;
            left_out > 0) {
            row.setup += text(", ", left_out, " cases without equilibrium left out");
        }
        auto network = springs_along_edges(
            mesh, {.second_ring = kind.second_ring, .volume = kind.volume, .density = density});
        Methods own = methods;
        own.acceleration = methods.acceleration && !kind.second_ring && !kind.volume;
        run(row, mesh, {.young = young, .poisson = poisson}, network, sets, own, settings, forms);
        rows.push_back(std::move(row));
    }
    return rows;
}

std::vector<Row> linear_rows(const std::string& name, const Mesh<3, double, Tet4>& mesh, double poisson,
                             const std::vector<NetworkKind>& networks, bool acceleration, const Settings& settings) {
    const fem::Model model{mesh, fem::LinearElastic{young, poisson}, density, model_options(poisson)};
    CaseSettings cases;
    cases.training = settings.quick ? 60 : 120;
    return tetrahedra_rows(name, model, mesh, body_of(mesh, model.masses()), cases, networks,
                           {.acceleration = acceleration}, settings);
}

void add_bars(Report& report, const std::vector<Row>& rows) {
    for (const Row& row : rows) {
        const double nu = row.poisson;
        const std::string what = text("3D tetrahedra, ", row.network, ", nu ", nu);
        const Errors fitted = row.find("trajectory")->errors;
        const Errors ratio = row.ratio("trajectory");
        if (row.network == name_of({}) && nu < 0.49) {
            const bool nearly_incompressible = nu == 0.45;
            report.at_most(what + ": unseen loads", fitted.loads, nearly_incompressible ? 0.03 : 0.02);
            report.at_most(what + ": unseen kinds", fitted.kinds, nearly_incompressible ? 0.09 : 0.06);
            report.at_least(what + ": ratio, loads", ratio.loads, 8);
            report.at_least(what + ": ratio, kinds", ratio.kinds, 8);
            if (nearly_incompressible) {
                report.at_most(what + ": unseen clamp", fitted.clamp, 0.25);
                report.at_least(what + ": ratio, clamp", ratio.clamp, 1.8);
            }
        }
        if (row.network == name_of({true, true})) {
            report.at_most(what + ": unseen loads", fitted.loads, nu >= 0.45 ? 0.008 : 0.015);
            report.at_most(what + ": unseen kinds", fitted.kinds, nu >= 0.45 ? 0.025 : 0.04);
            report.at_least(what + ": ratio, loads", ratio.loads, 12);
            report.at_least(what + ": ratio, kinds", ratio.kinds, 12);
            if (nu >= 0.45) {
                Row springs_alone = row;
                std::erase_if(springs_alone.scores, [](const Score& s) { return s.method == "cauchy_split"; });
                report.at_least(what + ": ratio to closed forms of springs alone, loads",
                                springs_alone.ratio("trajectory").loads, 50);
            }
        }
        if (row.network == name_of({false, true}) && nu == 0.45) {
            report.at_most(what + ": unseen clamp", fitted.clamp, 0.06);
            report.at_least(what + ": ratio, clamp", ratio.clamp, 7);
        }
    }
}

Row hexahedra_row(const std::array<int, 3>& cells, double poisson, const Settings& settings) {
    const auto mesh = hex_grid<double>(cells, {box_size[0], box_size[1], box_size[2]});
    auto network = springs_along_edges(mesh, {.diagonals = true, .density = density});
    const fem::Model model{mesh, fem::LinearElastic{young, poisson}, density, model_options(poisson)};
    const auto sets = record_sets(model, edges(mesh), body_of(mesh, model.masses()), {}, settings);
    Row row;
    row.mesh = "box, hexahedra";
    row.material = std::string(fem::LinearElastic::name);
    row.poisson = poisson;
    row.network = "edges, diagonals";
    row.setup = "small strain";
    run(row, mesh, {.young = young, .poisson = poisson}, network, sets, {}, settings);
    return row;
}

/// A flat sheet in space, stretched by 4 % by its rim and loaded within its plane.
Row membrane_row(double poisson, const Settings& settings) {
    const auto mesh = membrane(rectangle_mesh(0.8, 0.4, 150));
    auto network = springs_along_edges(mesh, {.density = density});
    const fem::Model model{mesh, fem::StVenantKirchhoff{young, poisson}, density};
    Body<3, double> body{mesh.nodes, network.mass, {}, {}};
    const std::vector<int> rim = boundary_nodes(mesh);
    for (int node = 0; node < static_cast<int>(mesh.n_nodes()); ++node) {
        body.surface.push_back(node);
    }
    body.clamps = {{rim, [](const Vector<3, double>& rest, double) { return Vector<3, double>(1.04 * rest); }}};
    CaseSettings cases;
    cases.training = settings.quick ? 30 : 60;
    cases.clamps = 1;
    cases.clamp = 0;
    cases.strain = 0.1;
    const auto sets = record_sets(model, edges(mesh), body, cases, settings);
    Row row;
    row.mesh = "membrane";
    row.material = std::string(fem::StVenantKirchhoff::name);
    row.poisson = poisson;
    row.network = name_of({});
    row.setup = "rim stretched by 4 %, loads in the plane";
    run(row, mesh, {.young = young, .poisson = poisson}, network, sets, {}, settings);
    return row;
}

void study_surfaces(Report& report, const Settings& settings) {
    for (const auto& [file, axis] : std::vector<std::pair<std::string, int>>{
             {"elephant", 1}, {"fandisk", 0}, {"knot1", 0}, {"bear", 1}}) {
        if (interrupted()) {
            return;
        }
        const auto mesh = solid_mesh(settings.data / (file + ".off"), 600);
        if (!mesh) {
            report.note(file + ": left out, no solid mesh.");
            continue;
        }
        CaseSettings cases;
        cases.training = 45;
        cases.clamp = 6;
        cases.strain = 0.15;
        const fem::Model model{*mesh, fem::NeoHookean{young, 0.45}, density, model_options(0.45)};
        Methods methods;
        methods.fit.max_iterations = 12;
        methods.fit.tolerance = 0.02;
        auto rows = tetrahedra_rows(file, model, *mesh, body_of(*mesh, model.masses(), axis), cases,
                                    {{}, {false, true}}, methods, settings);
        for (Row& row : rows) {
            if (file == "elephant" && row.network == name_of({false, true})) {
                const Errors fitted = row.find("trajectory")->errors;
                report.at_most("Elephant, neo-Hookean, nu 0.45, strain 0.15: unseen loads", fitted.loads, 0.05);
                report.at_most("Elephant: unseen kinds", fitted.kinds, 0.10);
                report.at_least("Elephant: ratio, loads", row.ratio("trajectory").loads, 5);
            }
            report.add(std::move(row));
        }
    }
}

} // namespace

void study_solids(Report& report, const Settings& settings) {
    report.begin("solids", "Solids",
                 "A box of 0.8 x 0.3 x 0.3 m, clamped at one end (in training, at two other sides too), as tetrahedra by Delaunay "
                 "refinement and as jittered hexahedra cut at random; braced hexahedra; a membrane; solids bounded by surfaces. "
                 "From nu = 0.45 on, the reference averages the volume change around each node, so that it does not lock. Volume "
                 "stiffness starts at no more than 6 shear moduli.");
    const std::vector<NetworkKind> all = {{}, {true, false}, {false, true}, {true, true}};
    const std::vector<double> ratios = settings.quick ? std::vector{0.25, 0.45} : std::vector{0., 0.25, 0.45, 0.49};
    svg::Chart chart{.title = "Unseen loads, box of tetrahedra", .x_label = "Poisson's ratio",
                     .y_label = "relative error", .log_y = true};
    chart.series = {{"best closed form, springs", {}, {}}};
    for (const NetworkKind& kind : all) {
        chart.series.push_back({"fitted " + name_of(kind), {}, {}});
    }
    const auto box = box_mesh(box_size, settings.quick ? 150 : 400);
    for (double poisson : ratios) {
        if (interrupted()) {
            return;
        }
        auto rows = linear_rows("box, tetrahedra", box, poisson, all, poisson == 0.25, settings);
        add_bars(report, rows);
        if (rows.size() == all.size()) {
            chart.groups.push_back(text(poisson));
            chart.series[0].y.push_back(rows[0].best_closed_form().loads);
            for (std::size_t r = 0; r < rows.size(); ++r) {
                chart.series[r + 1].y.push_back(rows[r].find("trajectory")->errors.loads);
            }
        }
        for (Row& row : rows) {
            report.add(std::move(row));
        }
        report.figure("solids", svg::bars(chart));
    }
    if (settings.quick) {
        report.add(hexahedra_row({6, 2, 2}, 0.25, settings));
        return;
    }
    const auto cut = random_cut_box({9, 4, 4}, box_size, 3);
    const auto coarse = box_mesh(box_size, 180);
    const auto fine = box_mesh(box_size, 1000);
    for (double poisson : ratios) {
        for (const auto& [name, mesh, networks] :
             {std::tuple{"box, tetrahedra", &coarse, std::vector<NetworkKind>{{}, {true, true}}},
              std::tuple{"box, cut at random", &cut, std::vector<NetworkKind>{{}, {true, true}}},
              std::tuple{"box, tetrahedra", &fine, std::vector<NetworkKind>{{}}}}) {
            if (interrupted()) {
                return;
            }
            for (Row& row : linear_rows(name, *mesh, poisson, networks, false, settings)) {
                report.add(std::move(row));
            }
        }
        for (const auto& cells : {std::array{8, 3, 3}, std::array{13, 5, 5}}) {
            if (!interrupted()) {
                report.add(hexahedra_row(cells, poisson, settings));
            }
        }
    }
    for (double poisson : {0.25, 1. / 3}) {
        if (!interrupted()) {
            report.add(membrane_row(poisson, settings));
        }
    }
    if (settings.data.empty()) {
        report.note("Solids bounded by surfaces are left out: no folder given by --data.");
    } else {
        study_surfaces(report, settings);
    }
}

} // namespace study
