// SPDX-License-Identifier: BSD-3-Clause
#include "fits.hpp"
#include "solid.hpp"
#include "svg.hpp"

namespace study {

namespace {

/// One fit of springs along the edges of a box to 60 static cases.
void add_large_fit(Report& report, Index n_nodes, double seconds_allowed, const Settings& settings) {
    const ReferenceKind reference{.poisson = 0.3};
    const TetMesh mesh = box_mesh(box_size, n_nodes);
    for (const Row& row : solid_rows("box, tetrahedra", mesh, body_of(mesh), reference, load_cases(60, settings),
                                     small_strain, {edges_alone}, fit_options(n_nodes < 5000, settings), settings)) {
        report.add(row);
        report.at_most(text("Seconds of a fit of ", row.springs, " springs to 60 static cases"),
                       row.find("trajectory")->seconds, seconds_allowed);
    }
}

/// Held-out errors of networks over the time that it took to find them.
class Curves {
public:
    Curves(Report& report, const RecordedCases<3, double>& cases, const Settings& settings)
        : m_report(&report), m_cases(&cases), m_how(fit_options(false, settings)) {}

    void add(const std::string& method, const Candidate<3>& fit) {
        std::vector<Candidate<3>> scored{fit};
        judge(scored, *m_cases, m_how);
        const Errors found = errors_of(scored.front(), *m_cases);
        auto series = std::find_if(m_chart.series.begin(), m_chart.series.end(),
                                   [&](const auto& other) { return other.name == method; });
        if (series == m_chart.series.end()) {
            series = m_chart.series.insert(series, {method, {}, {}});
        }
        series->x.push_back(fit.seconds);
        series->y.push_back(found.loads);
        m_table.lines.push_back({method, number(fit.seconds), number(fit.trajectory->objective), number(found.loads),
                                 number(found.kinds), number(found.clamp)});
        m_report->table(m_table);
        m_report->figure("time", svg::lines(m_chart));
    }

private:
    Report* m_report;
    const RecordedCases<3, double>* m_cases;
    CalibrateOptions m_how;
    svg::Chart m_chart{.title = "Unseen loads over the time of the search",
                       .x_label = "seconds",
                       .y_label = "relative error",
                       .log_x = true,
                       .log_y = true};
    Table m_table{"time-engines",
                  "Engines of trajectory matching on one problem, ended after some iterations or seconds. J: what they "
                  "minimise. Genetic search and annealing look at values alone and have up to ten times the time of "
                  "gauss_newton.",
                  {"engine", "seconds", "J", "unseen loads", "unseen kinds", "unseen clamp"}};
};

void add_curves(Report& report, const Settings& settings) {
    const ReferenceKind reference{.poisson = 0.3};
    const TetMesh mesh = box_mesh(box_size, settings.quick ? 60 : 150);
    const auto cases =
        equilibria(recorder_of(mesh, reference), body_of(mesh), load_cases(36, settings), small_strain, settings);
    const auto start = start_of(mesh, reference, edges_alone);
    Curves curves(report, cases, settings);
    auto how = fit_options(false, settings);
    how.matching_tolerance = 1e-5;
    double seconds = 0;
    for (int iterations : {1, 2, 3, 5, 8, 12, 20}) {
        how.matching_iterations = iterations;
        const auto found = candidates_of(start, cases, how).back();
        curves.add("gauss_newton", found);
        seconds = found.seconds;
    }
    // The other engines have the same problem, which calibration does not give to them.
    const auto& prior = start.front().network;
    const TrajectoryProblem<3> problem(prior, cases.training.motions,
                                       {.prior_weight = how.prior_weight, .execution = settings.execution});
    for (int iterations : {3, 10, 30, 100, 300}) {
        if (const auto found = ipopt_fit(problem, prior, iterations)) {
            curves.add("ipopt", *found);
        }
    }
    for (double factor : settings.quick ? std::vector{10.} : std::vector{1., 3., 10.}) {
        for (const Search search : {Search::genetic, Search::annealing}) {
            if (const auto found = search_fit(search, problem, prior, factor * seconds, settings.seed)) {
                curves.add(found->name, *found);
            }
        }
    }
}

} // namespace

void study_time(Report& report, const Settings& settings) {
    report.begin("time", "Time",
                 "How long fits take on the machine of the summary, and what engines reach in how much time. A box of "
                 "tetrahedra, springs along the edges, small strain, nu = 0.3.");
    add_curves(report, settings);
    add_large_fit(report, settings.quick ? 300 : 1650, 60, settings);
    if (!settings.quick) {
        add_large_fit(report, 15500, 900, settings);
    }
}

} // namespace study
