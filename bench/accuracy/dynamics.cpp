// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>

#include <springfit/score/simulate.hpp>

#include "solid.hpp"
#include "svg.hpp"

namespace study {

namespace {

constexpr double damping_ratio = 0.03; ///< of the slowest vibration
constexpr int frames_per_period = 40;
constexpr int periods = 5;
constexpr double strain = 0.05;

/// Scenarios that let go of the body at the equilibria of some cases.
std::vector<Scenario<3, double>> releases(const Cases<3>& cases) {
    std::vector<Scenario<3, double>> scenarios;
    for (std::size_t c = 0; c < cases.motions.size(); ++c) {
        Scenario<3, double> scenario;
        scenario.name = "let go of " + cases.scenarios[c].name;
        scenario.clamps = cases.scenarios[c].clamps;
        scenario.initial_positions = cases.motions[c].positions[0];
        scenarios.push_back(std::move(scenario));
    }
    return scenarios;
}

struct Network {
    std::string method;
    bool is_closed_form;
    double seconds;
    SpringNetwork<3, double> network;
};

/// Every network to compare, with damping that follows stiffness.
std::vector<Network> networks(const TetMesh& mesh, const ReferenceKind& reference, const Cases<3>& training,
                              const Settings& settings) {
    std::vector<Network> all;
    const auto prior = prior_network(mesh, reference, edges_alone);
    for (const auto& [name, form] : closed_forms(mesh, prior.springs, reference.solid())) {
        all.push_back({name, true, 0, prior});
        apply(form, all.back().network);
    }
    for (const auto& fit : acceleration_fits(prior, training.motions, settings)) {
        all.push_back({fit.method, false, fit.seconds, fit.network});
    }
    FitSettings how;
    how.damping_per_stiffness = reference.stiffness_damping;
    const auto fit = match_motion(prior, training.motions, how, settings);
    all.push_back({"trajectory", false, fit.seconds, fit.network});
    for (Network& own : all) {
        own.network.damping = reference.stiffness_damping * own.network.stiffness;
    }
    return all;
}

/// The way of the node that moves most after a release, in the reference and in some networks.
svg::Chart chart_of(const Scenario<3, double>& release, const Motion<3, double>& reference,
                    const std::vector<Network>& networks) {
    const Points<3, double> start = reference.positions[0] - reference.rest_positions;
    Index node = 0;
    Index axis = 0;
    (void)start.cwiseAbs().maxCoeff(&axis, &node);
    svg::Chart chart{.title = "The node that moves most, " + release.name,
                     .x_label = "time, s",
                     .y_label = "displacement, m"};
    const auto add = [&](const std::string& name, const Motion<3, double>& motion) {
        svg::Series series{name, motion.times, {}};
        for (const auto& positions : motion.positions) {
            series.y.push_back(positions(axis, node) - motion.rest_positions(axis, node));
        }
        chart.series.push_back(std::move(series));
    };
    add("reference", reference);
    for (const Network& own : networks) {
        if (own.method == "trajectory" || own.method == "van_gelder") {
            const SymplecticEulerOptions<double> options{.max_substeps = 100000};
            add(own.method, simulate(own.network, release, reference.times, until_interrupted(), options).motion);
        }
    }
    return chart;
}

} // namespace

void study_dynamics(Report& report, const Settings& settings) {
    report.begin(
        "dynamics", "Motion in time",
        "A box of neo-Hookean tetrahedra, nu = 0.3, let go of at rest under a load that strains it by 5 %, over "
        "five periods of its slowest vibration. The reference has stiffness-proportional damping, 3 % of critical "
        "at the slowest vibration; the networks' damping follows their stiffness with the same factor. Networks "
        "are springs along edges, fitted to static cases alone; their motion is stepped from the reference's "
        "start. Errors are those of all positions over all frames: a small error of a frequency adds up.");
    const TetMesh mesh = box_mesh(box_size, settings.quick ? 100 : 400);
    const auto body = body_of(mesh);
    ReferenceKind reference{.material = MaterialKind::neo_hookean, .poisson = 0.3};
    const auto& clamped = body.clamps[0].nodes;
    const double omega = reference_frequency(mesh, reference, clamped);
    const double period = 2 * std::numbers::pi / omega;
    reference.stiffness_damping = 2 * damping_ratio / omega;
    CaseSettings cases;
    cases.training = settings.quick ? 36 : 60;
    cases.loads = 3;
    cases.kinds = 5;
    cases.clamp = 3;
    cases.strain = strain;
    const auto statics = record_solid(mesh, reference, body, cases, settings);
    const auto swing = [&](const Cases<3>& start) {
        return record_swings(mesh, reference, releases(start), period / frames_per_period,
                             periods * frames_per_period + 1, settings);
    };
    const CaseSets<3> sets{statics.training, swing(statics.loads), swing(statics.kinds), swing(statics.clamp)};

    Row row;
    row.mesh = "box, tetrahedra";
    row.material = name_of(reference.material);
    row.poisson = reference.poisson;
    row.nodes = static_cast<long>(mesh.n_nodes());
    row.network = name_of(edges_alone);
    row.setup = text(periods, " periods");
    Table table{
        "dynamics-frequency",
        text("Lowest natural frequency; that of the reference is ", number(omega / (2 * std::numbers::pi)), " Hz."),
        {"method", "Hz", "relative to the reference"}};
    double fitted_frequency = std::numeric_limits<double>::quiet_NaN();
    const auto all = networks(mesh, reference, statics.training, settings);
    for (const auto& [method, is_closed_form, seconds, network] : all) {
        row.springs = static_cast<long>(network.n_springs());
        row.scores.push_back({method, is_closed_form, errors(network, sets, settings), seconds});
        const double own = network_frequency(network, clamped);
        table.lines.push_back({method, number(own / (2 * std::numbers::pi)), number(own / omega)});
        fitted_frequency = own;
    }
    report.add(row);
    report.table(table);
    report.at_most("Five periods after a release, neo-Hookean, nu 0.3: positions, unseen loads",
                   row.errors_of("trajectory").loads, 0.10);
    report.at_most("Five periods after a release: positions, unseen kinds", row.errors_of("trajectory").kinds, 0.10);
    report.at_most("Lowest natural frequency of the fitted network: relative error",
                   std::abs(fitted_frequency / omega - 1), 0.02);
    if (!sets.kinds.motions.empty()) {
        report.figure("dynamics", svg::lines(chart_of(sets.kinds.scenarios.front(), sets.kinds.motions.front(), all)));
    }
}

} // namespace study
