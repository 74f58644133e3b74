// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>

#include <springfit/simulate/simulate.hpp>

#include "solid.hpp"
#include "svg.hpp"

namespace study {

namespace {

constexpr double damping_ratio = 0.03; ///< of the slowest vibration
constexpr int frames_per_period = 40;
constexpr int periods = 5;
constexpr std::size_t n_training_swings = 8; ///< of a period and a half

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
std::vector<Network> networks_of(const TetMesh& mesh, const ReferenceKind& reference, const NetworkKind& kind,
                                 const Cases<3>& training, const Settings& settings) {
    std::vector<Network> all;
    const auto alone = prior_network(mesh, reference, edges_alone);
    for (const auto& [name, form] : closed_forms(mesh, alone.springs, reference.solid())) {
        all.push_back({name, true, 0, alone});
        apply(form, all.back().network);
    }
    const auto prior = prior_network(mesh, reference, kind);
    if (!kind.second_ring) {
        for (const auto& fit : acceleration_fits(prior, training.motions, settings)) {
            all.push_back({fit.method, false, fit.seconds, fit.network});
        }
    }
    FitSettings how;
    how.damping_per_stiffness = reference.stiffness_damping;
    how.steps_per_frame = 2;
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
    svg::Chart chart{
        .title = "The node that moves most, " + release.name, .x_label = "time, s", .y_label = "displacement, m"};
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

/// What is let go of, and what networks are fitted to.
struct Swings {
    CaseSets<3> sets; ///< static cases and some motions in time to train on, motions in time to judge by
    ReferenceKind reference;
    std::vector<int> clamped;
    double omega = 0; ///< lowest natural frequency of the reference, rad/s
};

Swings record_releases(const TetMesh& mesh, ReferenceKind reference, double strain, const Settings& settings) {
    const auto body = body_of(mesh);
    Swings swings;
    swings.clamped = body.clamps[0].nodes;
    swings.omega = reference_frequency(mesh, reference, swings.clamped);
    reference.stiffness_damping = 2 * damping_ratio / swings.omega;
    swings.reference = reference;
    CaseSettings cases;
    cases.training = settings.quick ? 36 : reference.material == MaterialKind::linear ? 120 : 60;
    cases.loads = 3;
    cases.kinds = 5;
    cases.clamp = 3;
    cases.strain = strain;
    const auto statics = record_solid(mesh, reference, body, cases, settings);
    const double frame_time = 2 * std::numbers::pi / swings.omega / frames_per_period;
    const auto swing = [&](const Cases<3>& start) {
        return record_swings(mesh, reference, releases(start), frame_time, periods * frames_per_period + 1, settings);
    };
    swings.sets = {statics.training, swing(statics.loads), swing(statics.kinds), swing(statics.clamp)};
    Cases<3> first;
    for (std::size_t c = 0; c < std::min<std::size_t>(n_training_swings, statics.training.motions.size()); ++c) {
        first.add(statics.training.scenarios[c], statics.training.motions[c]);
    }
    const auto in_time =
        record_swings(mesh, reference, releases(first), frame_time, 3 * frames_per_period / 2 + 1, settings);
    for (std::size_t c = 0; c < in_time.motions.size(); ++c) {
        swings.sets.training.add(in_time.scenarios[c], in_time.motions[c]);
    }
    return swings;
}

struct Frequencies {
    Table table{"dynamics-frequency",
                "Lowest natural frequency of networks, and its ratio to that of the reference.",
                {"nodes", "material", "network", "method", "Hz", "ratio to the reference"}};
    double fitted = std::numeric_limits<double>::quiet_NaN(); ///< the last ratio, of the last method: matched motion
};

/// One row, with the frequencies of all its networks.
Row add_row(Report& report, const TetMesh& mesh, const Swings& swings, const NetworkKind& kind, double strain,
            Frequencies& frequencies, const Settings& settings) {
    Row row;
    row.mesh = "box, tetrahedra";
    row.material = name_of(swings.reference.material);
    row.poisson = swings.reference.poisson;
    row.nodes = static_cast<long>(mesh.n_nodes());
    row.network = name_of(kind);
    row.setup = text(periods, " periods, ", strain_text(strain));
    const auto networks = networks_of(mesh, swings.reference, kind, swings.sets.training, settings);
    for (const auto& [method, is_closed_form, seconds, network] : networks) {
        row.springs = static_cast<long>(network.n_springs());
        row.scores.push_back({method, is_closed_form, errors(network, swings.sets, settings), seconds});
        const double omega = network_frequency(network, swings.clamped);
        frequencies.fitted = omega / swings.omega;
        frequencies.table.lines.push_back({text(row.nodes), row.material, row.network, method,
                                           number(omega / (2 * std::numbers::pi)), number(frequencies.fitted)});
    }
    report.add(row);
    report.table(frequencies.table);
    if (!kind.second_ring && !swings.sets.kinds.motions.empty()) {
        const auto& kinds = swings.sets.kinds;
        report.figure(swings.reference.material == MaterialKind::linear ? "dynamics" : "dynamics-large",
                      svg::lines(chart_of(kinds.scenarios.front(), kinds.motions.front(), networks)));
    }
    return row;
}

void add_bars(Report& report, const Row& row, const Frequencies& frequencies) {
    const std::string what = text("Five periods after a release, ", row.material, ", ", row.network);
    report.at_most(what + ": positions, unseen loads", row.errors_of("trajectory").loads, 0.10);
    report.at_most(what + ": positions, unseen kinds", row.errors_of("trajectory").kinds, 0.10);
    report.at_most(text("Lowest natural frequency, ", row.material, ", ", row.network, ": relative error"),
                   std::abs(frequencies.fitted - 1), 0.02);
}

} // namespace

void study_dynamics(Report& report, const Settings& settings) {
    report.begin(
        "dynamics", "Motion in time",
        "A box of tetrahedra, nu = 0.3, let go of at rest under a load, over five periods of its slowest "
        "vibration. The reference has stiffness-proportional damping, 3 % of critical at the slowest vibration; the "
        "networks' damping follows their stiffness with the same factor. Networks are fitted to static cases "
        "and to eight swings of a period and a half after other releases; their motion is stepped from the reference's "
        "start. Errors are those of all positions over all "
        "frames: a small error of a frequency adds up over the periods. The linear material is let go of at "
        "small strain, neo-Hookean at 5 %.");
    Frequencies frequencies;
    const auto add_rows = [&](Index n_nodes, MaterialKind material, double strain,
                              const std::vector<NetworkKind>& kinds) {
        const TetMesh mesh = box_mesh(box_size, n_nodes);
        const auto swings = record_releases(mesh, {.material = material, .poisson = 0.3}, strain, settings);
        for (const NetworkKind& kind : kinds) {
            const Row row = add_row(report, mesh, swings, kind, strain, frequencies, settings);
            add_bars(report, row, frequencies);
        }
    };
    if (settings.quick) {
        add_rows(100, MaterialKind::linear, small_strain, {edges_alone});
        return;
    }
    add_rows(400, MaterialKind::linear, small_strain, {edges_alone, with_ring});
    add_rows(150, MaterialKind::neo_hookean, 0.05, {edges_alone});
}

} // namespace study
