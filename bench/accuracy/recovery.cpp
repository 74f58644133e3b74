// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>
#include <random>

#include <springfit/fit/acceleration/dominant_term.hpp>
#include <springfit/fit/acceleration/objective.hpp>
#include <springfit/fit/trajectory/gauss_newton.hpp>
#include <springfit/motion/replay.hpp>
#include <springfit/network/builders.hpp>
#include <springfit/score/frequency.hpp>
#include <springfit/simulate/simulate.hpp>
#include <springfit/simulate/static_solver.hpp>

#include "trial.hpp"

namespace study {

namespace {

constexpr double allowed = 1e-6;

/// A network whose stiffness is to be found again, and the closed form that fits start from.
template <int Dim>
struct Hidden {
    SpringNetwork<Dim, double> network;
    SpringNetwork<Dim, double> prior;
    Specimen<Dim, double> body;
    double period = 0; ///< of the slowest vibration, s
};

template <int Dim, CellType Cell>
Hidden<Dim> hidden_network(const Mesh<Dim, double, Cell>& mesh, unsigned seed) {
    auto network = springs_along_edges(mesh, {.density = 1000.});
    apply(van_gelder(mesh, network.springs, {.young = 5e4, .poisson = Dim == 2 ? 1. / 3 : 0.25}), network);
    Hidden<Dim> hidden{network, network, specimen_of(mesh, 1000)};
    hidden.body.surface = boundary_nodes(mesh);
    hidden.body.clamps = {{side_nodes<Dim, double>(mesh.nodes, {0, false}, 0.02), {}}};
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> exponent(-0.5, 0.5); // over a decade
    for (double& stiffness : hidden.network.stiffness) {
        stiffness *= std::pow(10., exponent(random));
    }
    hidden.period = 2 * std::numbers::pi / lowest_frequency(hidden.network, hidden.body.clamps[0].nodes).omega;
    return hidden;
}

/// Equilibria of the hidden network under random loads, all to learn from.
template <int Dim>
CaseSet<Dim, double> rests(const Hidden<Dim>& hidden, int n, double strain, unsigned seed, const Settings& settings) {
    const ReferenceRecorder reference(hidden.network);
    const LoadCaseOptions loads{
        .training = n, .clamps = 3, .held_out_loads = 0, .held_out_kinds = 0, .held_out_clamp = 0, .seed = seed};
    return equilibria<Dim>(reference, hidden.body, loads, strain, settings).training;
}

template <int Dim>
std::vector<Motion<Dim, double>> swings(const Hidden<Dim>& hidden, const Settings& settings) {
    auto cases = rests(hidden, 9, 0.05, settings.seed + 1, settings).cases;
    for (auto& load_case : cases) {
        set_amplitude(load_case.scenario, ramp_and_release(0.3 * hidden.period, 0.6 * hidden.period));
    }
    const ReferenceRecorder reference(hidden.network);
    auto recorded = record_motions<Dim, double>(
        reference, cases, 0, {.dt = hidden.period / 25, .frames = 30, .progress = until_interrupted()},
        settings.execution);
    stop_if_interrupted();
    return std::move(recorded.training.motions);
}

/// Static cases, in balance to rounding.
template <int Dim>
std::vector<Motion<Dim, double>> exact_equilibria(const Hidden<Dim>& hidden, const Settings& settings) {
    auto cases = rests(hidden, 90, 0.02, settings.seed, settings);
    for (std::size_t c = 0; c < cases.size(); ++c) {
        EquilibriumOptions<Dim, double> options;
        options.start = cases.motions[c].positions[0];
        options.tolerance = 1e-14;
        cases.motions[c].positions[0] = equilibrium(hidden.network, cases.cases[c].scenario, options).positions;
    }
    return std::move(cases.motions);
}

/// What a fit found, of whose solver more is asked here than in a calibration.
template <int Dim>
struct Found {
    std::string method;
    SpringNetwork<Dim, double> network;
    double seconds = 0;
};

template <int Dim>
std::vector<Found<Dim>> acceleration_fits(const SpringNetwork<Dim, double>& prior,
                                          const std::vector<Motion<Dim, double>>& motions, const Settings& settings) {
    const Stopwatch watch;
    const AccelerationProblem problem = acceleration_problem<Dim, double>(prior, motions, {}, settings.execution);
    const double assembly = watch.seconds();
    std::vector<Found<Dim>> fits;
    const auto add = [&](const char* method, const AccelerationReport& report) {
        stop_if_interrupted();
        fits.push_back({method, prior, assembly + report.seconds});
        apply(problem, report, fits.back().network);
    };
    add("one pass", one_pass(problem, {.execution = settings.execution}));
    add("dominant term", dominant_term(problem, {.max_sweeps = 5000,
                                                 .tolerance = 1e-12,
                                                 .execution = settings.execution,
                                                 .progress = until_interrupted()}));
    const ExactSolver by_ipopt = exact_solver();
    const ExactOptions how{.execution = settings.execution, .progress = until_interrupted()};
    add("exact", by_ipopt ? by_ipopt(problem, how) : exact(problem, how));
    return fits;
}

/// Matching of motion without any weight on the prior.
template <int Dim>
Found<Dim> matched(const SpringNetwork<Dim, double>& prior, const std::vector<Motion<Dim, double>>& motions,
                   TrajectoryOptions options, GaussNewtonOptions engine, const Settings& settings) {
    const Stopwatch watch;
    options.prior_weight = 0;
    options.execution = settings.execution;
    engine.progress = until_interrupted();
    const TrajectoryProblem<Dim> problem(prior, motions, options);
    const TrajectoryReport report = gauss_newton(problem, engine);
    stop_if_interrupted();
    Found<Dim> found{"trajectory", prior, watch.seconds()};
    if (usable(report.status)) {
        apply(problem, report, found.network);
    }
    return found;
}

/// The largest relative distance of a stiffness from another.
template <int Dim>
double distance(const SpringNetwork<Dim, double>& network, const SpringNetwork<Dim, double>& other) {
    return (network.stiffness.array() / other.stiffness.array() - 1).abs().maxCoeff();
}

template <int Dim>
void recover(Report& report, Table& table, const Hidden<Dim>& hidden, const Settings& settings) {
    const auto add = [&](const std::string& method, const std::string& data, double found, double seconds) {
        const auto& network = hidden.network;
        table.lines.push_back({text(Dim, "D"), text(network.n_nodes()), text(network.n_springs()), method, data,
                               number(found), number(seconds)});
        report.table(table);
        report.must_be_at_most(text("Recovery, ", Dim, "D, ", method, ": largest relative error of a stiffness"), found,
                               allowed);
    };
    for (const auto& fit : acceleration_fits(hidden.prior, swings(hidden, settings), settings)) {
        add(fit.method, "9 motions of 30 frames", distance(fit.network, hidden.network), fit.seconds);
    }
    const auto statics = exact_equilibria(hidden, settings);
    const auto fit = matched(hidden.prior, statics, {}, {.max_iterations = 60, .tolerance = 1e-14}, settings);
    add("trajectory", text(statics.size(), " static cases"), distance(fit.network, hidden.network), fit.seconds);
}

/// Windows of one short step from random states, one after another in one motion, under forces that no spring explains.
template <int Dim>
Motion<Dim, double> short_windows(const Hidden<Dim>& hidden, int n, double dt, unsigned seed) {
    const auto& network = hidden.network;
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto noise = [&](double size) {
        Points<Dim, double> values(Dim, network.n_nodes());
        for (double& value : values.reshaped()) {
            value = size * normal(random);
        }
        for (int node : hidden.body.clamps[0].nodes) {
            values.col(node).setZero();
        }
        return values;
    };
    const double shortest = network.rest_length.minCoeff();
    const double force = network.stiffness.mean() * shortest;
    Motion<Dim, double> windows;
    for (int w = 0; w < n; ++w) {
        Scenario<Dim, double> scenario;
        scenario.clamps = hidden.body.clamps;
        scenario.initial_positions = network.rest_positions + noise(0.02 * shortest);
        scenario.initial_velocities = noise(0.1 * shortest / hidden.period);
        auto motion = simulate(network, scenario, {0., dt}).motion;
        const Points<Dim, double> unknown = noise(0.005 * force);
        motion.accelerations[0] =
            2 / (dt * dt) * (motion.positions[1] - motion.positions[0] - dt * motion.velocities[0]);
        windows.rest_positions = motion.rest_positions;
        windows.clamped = motion.clamped;
        for (std::size_t t = 0; t < 2; ++t) {
            windows.times.push_back(dt * (2 * w + static_cast<double>(t)));
            windows.positions.push_back(motion.positions[t]);
            windows.velocities.push_back(motion.velocities[t]);
            windows.accelerations.push_back(motion.accelerations[t]);
            windows.external_forces.push_back(motion.external_forces[t] + unknown);
        }
    }
    return windows;
}

/// The first frame of each window alone, which is what an acceleration fit sees of it.
template <int Dim>
std::vector<Motion<Dim, double>> starts_of(const Motion<Dim, double>& windows) {
    std::vector<Motion<Dim, double>> starts;
    for (Index t = 0; t < windows.n_frames(); t += 2) {
        starts.push_back(excerpt(windows, t, t + 1));
    }
    return starts;
}

/// Matching of motion over one short step beside the acceleration fit, on data that springs do not explain.
void check_horizon(Report& report, const Hidden<2>& hidden, const Settings& settings) {
    Table table{"recovery-horizon",
                "The acceleration fit as the limit of matched motion: windows of one step, with forces that no spring "
                "explains. *between*: the largest relative difference of a stiffness between the two fits; *from the "
                "truth*: that between the acceleration fit and the network that moved.",
                {"step / slowest period", "between", "from the truth"}};
    double between = std::numeric_limits<double>::quiet_NaN();
    for (double part : {1. / 400, 1. / 1600, 1. / 6400}) {
        const auto windows = short_windows(hidden, 100, part * hidden.period, settings.seed);
        const auto fits = acceleration_fits(hidden.prior, starts_of(windows), settings);
        const auto fit = matched(hidden.prior, std::vector{windows}, {.horizon = 1, .window_stride = 2},
                                 {.max_iterations = 100, .tolerance = 1e-12}, settings);
        between = distance(fit.network, fits.back().network);
        table.lines.push_back({number(part), number(between), number(distance(fits.back().network, hidden.network))});
        report.table(table);
    }
    report.must_be_at_most("Horizon of one short step beside the acceleration fit: largest relative difference",
                           between, 0.01);
}

} // namespace

void study_recovery(Report& report, const Settings& settings) {
    report.begin(
        "recovery", "Recovery",
        "The reference is itself a network, whose springs have stiffness over a decade at random. Fits start from "
        "the closed form of the mesh, and are to find the stiffness of every spring again to 1e-6: acceleration "
        "fits from motions in time, matching of motion (without any weight on the prior) from static cases. If "
        "not, the study ends with exit code 1.");
    Table table{"recovery",
                "Largest relative error of the stiffness of a spring.",
                {"dimension", "nodes", "springs", "method", "data", "error", "seconds"}};
    const auto plane = hidden_network(rectangle_mesh(0.8, 0.4, settings.quick ? 60 : 150), settings.seed);
    recover(report, table, plane, settings);
    recover(report, table, hidden_network(box_mesh({0.8, 0.3, 0.3}, settings.quick ? 60 : 150), settings.seed),
            settings);
    check_horizon(report, plane, settings);
}

} // namespace study
