// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>

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
    void add(double x, const std::string& setup, const CaseSets<3>& sets, const FitSettings& fit,
             bool acceleration = false) {
        if (m_forms.empty()) {
            m_forms = edge_form_scores(*m_mesh, m_reference, sets, *m_settings);
        }
        const Row row = solid_row("box, tetrahedra", *m_mesh, m_reference, setup, edges_alone, sets, m_forms,
                                  {.acceleration = acceleration, .fit = fit}, *m_settings);
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

/// The first cases of a set.
Cases<3> first(const Cases<3>& cases, int n) {
    const auto end = std::min(cases.motions.size(), static_cast<std::size_t>(n));
    Cases<3> result;
    for (std::size_t c = 0; c < end; ++c) {
        result.add(cases.scenarios[c], cases.motions[c]);
    }
    return result;
}

CaseSets<3> with_training(CaseSets<3> sets, Cases<3> training) {
    sets.training = std::move(training);
    return sets;
}

/// Of the cases under the first `n_clamps` clamps that come up, `n` in equal parts.
Cases<3> under_clamps(const Cases<3>& cases, int n_clamps, int n) {
    std::vector<std::vector<int>> clamps;
    std::vector<int> taken;
    Cases<3> result;
    for (std::size_t c = 0; c < cases.motions.size(); ++c) {
        const auto& clamped = cases.motions[c].clamped;
        auto place = static_cast<std::size_t>(std::find(clamps.begin(), clamps.end(), clamped) - clamps.begin());
        if (place == clamps.size() && place < static_cast<std::size_t>(n_clamps)) {
            clamps.push_back(clamped);
            taken.push_back(0);
        }
        if (place < clamps.size() && taken[place] < n / n_clamps) {
            ++taken[place];
            result.add(cases.scenarios[c], cases.motions[c]);
        }
    }
    return result;
}

/// What all lines share.
struct Bench {
    Report* report;
    TetMesh mesh;
    ReferenceKind reference;
    CaseSets<3> sets; ///< with more training cases than any line but the first uses
    const Settings* settings;

    [[nodiscard]] Line line(const std::string& title, const std::string& x_label) const {
        return {*report, mesh, reference, {.title = title, .x_label = x_label}, *settings};
    }
};

void add_case_counts(const Bench& bench) {
    Line line = bench.line("Number of training cases", "training cases");
    const auto counts = bench.settings->quick ? std::vector{6, 24, 60} : std::vector{6, 15, 30, 60, 120, 240};
    for (int n : counts) {
        line.add(n, text(n, " training cases"), with_training(bench.sets, first(bench.sets.training, n)), {}, n == 60);
    }
    line.draw("setups-cases");
}

void add_prior_weights(const Bench& bench) {
    const auto weights =
        bench.settings->quick ? std::vector{1e-5, 1e-3} : std::vector{1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1};
    for (int n : bench.settings->quick ? std::vector{24} : std::vector{15, 60}) {
        const auto sets = with_training(bench.sets, first(bench.sets.training, n));
        Line line = bench.line(text("Weight of the prior, ", n, " training cases"), "prior weight");
        for (double weight : weights) {
            line.add(weight, text(n, " training cases, prior weight ", weight), sets, {.prior_weight = weight});
        }
        line.draw(text("setups-prior-", n));
    }
}

void add_noise(const Bench& bench) {
    const auto clean = first(bench.sets.training, bench.settings->quick ? 24 : 60);
    for (double weight : bench.settings->quick ? std::vector{1e-3} : std::vector{1e-5, 1e-3}) {
        Line line = bench.line(text("Noise in the recorded positions, prior weight ", weight), "noise / displacement");
        for (double level : bench.settings->quick ? std::vector{1e-2} : std::vector{0., 1e-3, 1e-2, 5e-2}) {
            Cases<3> noisy = clean;
            for (std::size_t c = 0; c < noisy.motions.size(); ++c) {
                noisy.motions[c] = with_noise(noisy.motions[c], level, bench.settings->seed + static_cast<unsigned>(c));
            }
            line.add(level, text("noise ", level, ", prior weight ", weight), with_training(bench.sets, noisy),
                     {.prior_weight = weight}, level == 1e-2 && weight == 1e-3);
        }
        line.draw(text("setups-noise-", weight));
    }
}

/// Judged under the body's own clamp, which is always trained under, and under one that never is.
void add_clamps(const Bench& bench) {
    constexpr int n = 48;
    CaseSettings cases;
    cases.clamps = 4;
    cases.training = 4 * n;
    auto sets = record_solid(bench.mesh, bench.reference, body_of(bench.mesh), cases, *bench.settings);
    sets.loads = under_clamps(sets.loads, 1, 1000);
    Line line = bench.line("Number of clamps trained under", "clamps");
    for (int clamps = 1; clamps <= 4; ++clamps) {
        line.add(clamps, text(n, " training cases under ", clamps, clamps == 1 ? " clamp" : " clamps"),
                 with_training(sets, under_clamps(sets.training, clamps, n)), {});
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
    small.reference.stiffness_damping = 0.06 / omega; // 3 % of critical damping at the lowest frequency
    CaseSettings cases;
    cases.training = 9;
    auto sets = record_solid(small.mesh, small.reference, body, cases, settings);
    auto pushes = sets.training.scenarios;
    for (auto& scenario : pushes) {
        set_amplitude(scenario, ramp_and_release(0.2 * period, 0.4 * period));
    }
    sets.training = record_swings(small.mesh, small.reference, pushes, period / 40, frames, settings);
    Line line = small.line("Horizon of the windows of nine motions in time", "frames");
    for (int horizon : {1, 4, 16, 0}) {
        line.add(horizon > 0 ? horizon : frames - 1,
                 horizon > 0 ? text("9 motions, horizon ", horizon) : std::string("9 motions, each to its end"), sets,
                 {.prior_weight = 1e-4, .horizon = horizon, .damping_per_stiffness = small.reference.stiffness_damping},
                 horizon == 1);
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
    CaseSettings cases;
    cases.training = settings.quick ? 60 : 240;
    bench.sets = record_solid(bench.mesh, bench.reference, body_of(bench.mesh), cases, settings);
    add_case_counts(bench);
    add_prior_weights(bench);
    add_noise(bench);
    if (!settings.quick) {
        add_clamps(bench);
    }
    add_horizons(bench);
}

} // namespace study
