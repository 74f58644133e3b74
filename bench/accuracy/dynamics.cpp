// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>
#include <numeric>

#include <springfit/simulate/simulate.hpp>

#include "solid.hpp"
#include "svg.hpp"

namespace study {

namespace {

constexpr double damping_ratio = 0.03; ///< of the slowest vibration
constexpr int frames_per_period = 40;
constexpr int periods = 5;
constexpr std::size_t n_training_swings = 8; ///< of a period and a half

/// Load cases that let go of the body at the equilibria of others.
std::vector<LoadCase<3, double>> releases(const CaseSet<3, double>& equilibria) {
    auto cases = equilibria.cases;
    for (std::size_t c = 0; c < cases.size(); ++c) {
        Scenario<3, double> scenario;
        scenario.name = "let go of " + cases[c].scenario.name;
        scenario.clamps = cases[c].scenario.clamps;
        scenario.initial_positions = equilibria.motions[c].positions[0];
        cases[c].scenario = std::move(scenario);
    }
    return cases;
}

/// Every network to compare, with damping that follows stiffness: the closed forms on edges, and the fits of a network.
std::vector<Candidate<3>> networks_of(const TetMesh& mesh, const ReferenceKind& reference, const NetworkKind& kind,
                                      const RecordedCases<3, double>& cases, const Settings& settings) {
    auto how = fit_options(!kind.second_ring, settings);
    how.learn_from_all = true;
    how.steps_per_frame = 2;
    auto forms_alone = how;
    forms_alone.method = Method::closed_form;
    auto all = candidates_of(edge_forms(mesh, reference), cases, forms_alone);
    for (auto& candidate : candidates_of(start_of(mesh, reference, kind), cases, how)) {
        if (candidate.acceleration || candidate.trajectory) {
            all.push_back(std::move(candidate));
        }
    }
    judge(all, cases, how);
    return all;
}

/// The way of the node that moves most after a release, in the reference and in some networks.
svg::Chart chart_of(const Scenario<3, double>& release, const Motion<3, double>& reference,
                    const std::vector<Candidate<3>>& networks) {
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
    for (const auto& own : networks) {
        if (own.name == "trajectory" || own.name == "van_gelder") {
            add(own.name, simulate(own.network, release, reference.times, until_interrupted()).motion);
        }
    }
    return chart;
}

/// What is let go of, and what networks are fitted to.
struct Swings {
    RecordedCases<3, double> cases; ///< equilibria and some motions in time to train on, motions in time to judge by
    ReferenceKind reference;
    std::vector<int> clamped;
    double omega = 0; ///< lowest natural frequency of the reference, rad/s
};

Swings record_releases(const TetMesh& mesh, const ReferenceKind& kind, double strain, const Settings& settings) {
    const auto body = body_of(mesh);
    const auto reference = recorder_of(mesh, kind);
    Swings swings;
    swings.reference = kind;
    swings.clamped = body.clamps[0].nodes;
    swings.omega = reference_frequency(mesh, kind, swings.clamped);
    auto loads = load_cases(settings.quick ? 36 : kind.material == MaterialKind::linear ? 120 : 60, settings);
    loads.held_out_loads = 3;
    loads.held_out_kinds = 5;
    loads.held_out_clamp = 3;
    const auto statics = equilibria(reference, body, loads, strain, settings);
    const auto swing = [&](const CaseSet<3, double>& start, int frames) {
        return record_swings(reference, releases(start), 2 * damping_ratio / swings.omega,
                             2 * std::numbers::pi / swings.omega / frames_per_period, frames, settings);
    };
    std::vector<std::size_t> first(std::min(n_training_swings, statics.training.size()));
    std::iota(first.begin(), first.end(), std::size_t(0));
    swings.cases = swing(statics.held_out, periods * frames_per_period + 1);
    swings.cases.training = statics.training;
    swings.cases.add(swing(statics.training.subset(first), 3 * frames_per_period / 2 + 1));
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
    const auto networks = networks_of(mesh, swings.reference, kind, swings.cases, settings);
    row.springs = static_cast<long>(networks.back().network.n_springs());
    add_scores(row, networks, swings.cases);
    for (std::size_t n = 0; n < networks.size(); ++n) {
        const double omega = network_frequency(networks[n].network, swings.clamped);
        frequencies.fitted = omega / swings.omega;
        frequencies.table.lines.push_back({text(row.nodes), row.material, row.network, row.scores[n].method,
                                           number(omega / (2 * std::numbers::pi)), number(frequencies.fitted)});
    }
    report.add(row);
    report.table(frequencies.table);
    const auto& held_out = swings.cases.held_out;
    const auto shown = std::find_if(held_out.cases.begin(), held_out.cases.end(),
                                    [](const auto& own) { return own.role == CaseRole::unseen_kind; });
    if (!kind.second_ring && shown != held_out.cases.end()) {
        const auto& motion = held_out.motions[static_cast<std::size_t>(shown - held_out.cases.begin())];
        report.figure(swings.reference.material == MaterialKind::linear ? "dynamics" : "dynamics-large",
                      svg::lines(chart_of(shown->scenario, motion, networks)));
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
