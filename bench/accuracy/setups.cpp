// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>
#include <numeric>

#include <springfit/cases/noise.hpp>

#include "solid.hpp"
#include "svg.hpp"

namespace study {

namespace {

/// Errors of matched motion along one setting: rows of the report and a figure.
class Line {
public:
    Line(Report& report, const TetMesh& mesh, const ReferenceKind& reference, svg::Chart chart,
         const Settings& settings)
        : m_report(&report), m_mesh(&mesh), m_reference(reference), m_chart(std::move(chart)), m_settings(&settings) {
        m_chart.y_label = "relative error";
        m_chart.log_x = m_chart.log_y = true;
        m_chart.series = {{"unseen loads", {}, {}},
                          {"unseen kinds", {}, {}},
                          {"unseen clamp", {}, {}},
                          {"closed form, loads", {}, {}}};
    }

    /// One point; all points of a line have the same held-out cases. Not drawn for x = 0.
    void add(double x, const std::string& setup, const RecordedCases<3, double>& cases, const CalibrateOptions& how) {
        if (m_forms.empty()) {
            m_forms = edge_form_scores(*m_mesh, m_reference, cases, *m_settings);
        }
        const Row row = solid_row("box, tetrahedra", *m_mesh, m_reference, setup, edges_alone, cases, m_forms, how);
        m_report->add(row);
        const Errors fitted = row.errors_of("trajectory");
        const std::array values = {fitted.loads, fitted.kinds, fitted.clamp, row.best_closed_form().loads};
        for (std::size_t s = 0; s < values.size(); ++s) {
            m_chart.series[s].x.push_back(x);
            m_chart.series[s].y.push_back(values[s]);
        }
    }

    void draw(const std::string& name) { m_report->figure(name, svg::lines(m_chart)); }

private:
    Report* m_report;
    const TetMesh* m_mesh;
    ReferenceKind m_reference;
    svg::Chart m_chart;
    const Settings* m_settings;
    std::vector<Score> m_forms;
};

RecordedCases<3, double> with_training(RecordedCases<3, double> cases, CaseSet<3, double> training) {
    cases.training = std::move(training);
    return cases;
}

/// The first cases of a set.
CaseSet<3, double> first(const CaseSet<3, double>& cases, int n) {
    std::vector<std::size_t> numbers(std::min(cases.size(), static_cast<std::size_t>(n)));
    std::iota(numbers.begin(), numbers.end(), std::size_t(0));
    return cases.subset(numbers);
}

/// Of the cases under the first clamp sets, `n` in equal parts.
CaseSet<3, double> under_clamps(const CaseSet<3, double>& cases, int n_clamps, int n) {
    std::vector<int> taken(static_cast<std::size_t>(n_clamps), 0);
    std::vector<std::size_t> numbers;
    for (std::size_t c = 0; c < cases.size(); ++c) {
        const int clamp = cases.cases[c].clamp_set;
        if (clamp < n_clamps && taken[static_cast<std::size_t>(clamp)]++ < n / n_clamps) {
            numbers.push_back(c);
        }
    }
    return cases.subset(numbers);
}

/// The held-out cases without the unseen loads under other clamps than the body's own.
CaseSet<3, double> judged_under_own_clamp(const CaseSet<3, double>& held_out) {
    std::vector<std::size_t> numbers;
    for (std::size_t c = 0; c < held_out.size(); ++c) {
        if (held_out.cases[c].role != CaseRole::unseen_load || held_out.cases[c].clamp_set == 0) {
            numbers.push_back(c);
        }
    }
    return held_out.subset(numbers);
}

/// What all lines share.
struct Bench {
    Report* report;
    TetMesh mesh;
    ReferenceKind reference;
    RecordedCases<3, double> cases; ///< with more training cases than any line but the first uses
    const Settings* settings;

    [[nodiscard]] Line line(const std::string& title, const std::string& x_label) const {
        return {*report, mesh, reference, {.title = title, .x_label = x_label}, *settings};
    }
};

void add_case_counts(const Bench& bench) {
    Line line = bench.line("Number of training cases", "training cases");
    const auto counts = bench.settings->quick ? std::vector{6, 24, 60} : std::vector{6, 15, 30, 60, 120, 240};
    for (int n : counts) {
        line.add(n, text(n, " training cases"), with_training(bench.cases, first(bench.cases.training, n)),
                 fit_options(n == 60, *bench.settings));
    }
    line.draw("setups-cases");
}

void add_prior_weights(const Bench& bench) {
    const auto weights =
        bench.settings->quick ? std::vector{1e-5, 1e-3} : std::vector{1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1};
    for (int n : bench.settings->quick ? std::vector{24} : std::vector{15, 60}) {
        const auto cases = with_training(bench.cases, first(bench.cases.training, n));
        Line line = bench.line(text("Weight of the prior, ", n, " training cases"), "prior weight");
        for (double weight : weights) {
            auto how = fit_options(false, *bench.settings);
            how.prior_weight = weight;
            line.add(weight, text(n, " training cases, prior weight ", weight), cases, how);
        }
        line.draw(text("setups-prior-", n));
    }
}

void add_noise(const Bench& bench) {
    const auto clean = first(bench.cases.training, bench.settings->quick ? 24 : 60);
    for (double weight : bench.settings->quick ? std::vector{1e-3} : std::vector{1e-5, 1e-3}) {
        Line line = bench.line(text("Noise in the recorded positions, prior weight ", weight), "noise / displacement");
        for (double level : bench.settings->quick ? std::vector{1e-2} : std::vector{0., 1e-3, 1e-2, 5e-2}) {
            auto noisy = clean;
            for (std::size_t c = 0; c < noisy.size(); ++c) {
                noisy.motions[c] = with_noise(noisy.motions[c], level, bench.settings->seed + static_cast<unsigned>(c));
            }
            auto how = fit_options(level == 1e-2 && weight == 1e-3, *bench.settings);
            how.prior_weight = weight;
            line.add(level, text("noise ", level, ", prior weight ", weight), with_training(bench.cases, noisy), how);
        }
        line.draw(text("setups-noise-", weight));
    }
}

/// Judged under the body's own clamp, which is always trained under, and under one that never is.
void add_clamps(const Bench& bench) {
    constexpr int n = 48;
    auto loads = load_cases(4 * n, *bench.settings);
    loads.clamps = 4;
    auto cases =
        equilibria(recorder_of(bench.mesh, bench.reference), body_of(bench.mesh), loads, small_strain, *bench.settings);
    cases.held_out = judged_under_own_clamp(cases.held_out);
    Line line = bench.line("Number of clamps trained under", "clamps");
    for (int clamps = 1; clamps <= 4; ++clamps) {
        line.add(clamps, text(n, " training cases under ", clamps, clamps == 1 ? " clamp" : " clamps"),
                 with_training(cases, under_clamps(cases.training, clamps, n)), fit_options(false, *bench.settings));
    }
    line.draw("setups-clamps");
}

/// Trained on a few motions in time, cut into windows; judged by equilibria.
void add_horizons(const Bench& bench) {
    constexpr int frames = 49;
    const Settings& settings = *bench.settings;
    Bench small = bench;
    small.mesh = box_mesh(box_size, 150);
    const auto body = body_of(small.mesh);
    const double omega = reference_frequency(small.mesh, small.reference, body.clamps[0].nodes);
    const double period = 2 * std::numbers::pi / omega;
    const double beta = 0.06 / omega; // 3 % of critical damping at the lowest frequency
    const auto reference = recorder_of(small.mesh, small.reference);
    const auto statics = equilibria(reference, body, load_cases(9, settings), small_strain, settings);
    auto pushes = statics.training.cases;
    for (auto& push : pushes) {
        set_amplitude(push.scenario, ramp_and_release(0.2 * period, 0.4 * period));
    }
    auto cases = record_swings(reference, pushes, beta, period / 40, frames, settings);
    cases.held_out = statics.held_out;
    Line line = small.line("Horizon of the windows of nine motions in time", "frames");
    for (int horizon : {1, 4, 16, 0}) {
        auto how = fit_options(horizon == 1, settings);
        how.prior_weight = 1e-4;
        how.horizon = horizon;
        line.add(horizon > 0 ? horizon : frames - 1,
                 horizon > 0 ? text("9 motions, horizon ", horizon) : std::string("9 motions, each to its end"), cases,
                 how);
    }
    line.draw("setups-horizon");
}

} // namespace

void study_setups(Report& report, const Settings& settings) {
    report.begin(
        "setups", "Setups",
        "What of the training matters: a box of tetrahedra, springs along its edges, small strain, nu = 0.3. One "
        "setting changes along each line; the others are 60 training cases under three clamps, a prior weight of "
        "1e-5 and no noise unless a row says otherwise. The last line trains on nine motions in time, cut into "
        "windows of some frames (a period of the slowest vibration has 40), and is judged by equilibria like the "
        "others.");
    Bench bench{&report, box_mesh(box_size, settings.quick ? 150 : 400), {.poisson = 0.3}, {}, &settings};
    bench.cases = equilibria(recorder_of(bench.mesh, bench.reference), body_of(bench.mesh),
                             load_cases(settings.quick ? 60 : 240, settings), small_strain, settings);
    add_case_counts(bench);
    add_prior_weights(bench);
    add_noise(bench);
    if (!settings.quick) {
        add_clamps(bench);
    }
    add_horizons(bench);
}

} // namespace study
