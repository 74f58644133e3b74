// SPDX-License-Identifier: BSD-3-Clause
#include "../fit/trajectory_cases.hpp"

#include <stdexcept>

#include <springfit/search/annealing.hpp>
#include <springfit/search/genetic.hpp>

using namespace springfit;
using search::AnnealingOptions;
using search::GeneticOptions;
using search::SearchReport;
using search::TrajectoryMatch;
using test::Dimension;
using test::SmallBlock;

namespace {

constexpr int start = 2; ///< simulations of the prior and of twice its stiffness

/// A few equilibria of springs that the prior is wrong about; four stiffnesses to find.
template <int Dim>
TrajectoryProblem<Dim> representable(TrajectoryOptions options = {}) {
    const SmallBlock<Dim> block;
    auto truth = block.network(0, 1);
    options.prior_weight = 1e-6;
    options.parameters.stiffness.ties.resize(std::size_t(truth.n_springs()));
    for (Index e = 0; e < truth.n_springs(); ++e) {
        options.parameters.stiffness.ties[std::size_t(e)] = int(e % 4);
        truth.stiffness(e) = std::exp(0.3 * double(e % 4) - 0.5);
    }
    return TrajectoryProblem<Dim>(block.network(0, 1), block.equilibria(truth, 3, 0.01), options);
}

SearchReport run(const TrajectoryProblem<2>& problem, const GeneticOptions& options) {
    return search::genetic(problem, options);
}
SearchReport run(const TrajectoryProblem<2>& problem, const AnnealingOptions& options) {
    return search::annealing(problem, options);
}

/// What a report says of its point is so.
template <int Dim>
void check_report(const TrajectoryProblem<Dim>& problem, const SearchReport& report) {
    const auto& fit = report.fit;
    REQUIRE(fit.theta.size() == problem.n_unknowns());
    CHECK((fit.theta.array() >= problem.parameters().lower().array()).all());
    CHECK((fit.theta.array() <= problem.parameters().upper().array()).all());
    TrajectoryPoint<Dim> point(problem);
    REQUIRE(point.move_to(fit.theta));
    CHECK(test::relative(fit.objective, point.value(), fit.objective_start) < 1e-8);
    CHECK(test::relative(fit.misfit, point.misfit(), fit.misfit_start) < 1e-6);
    CHECK(fit.objective <= fit.objective_start);
    CHECK(fit.history.size() == std::size_t(fit.iterations));
    REQUIRE(report.seconds.size() == fit.history.size());
    for (std::size_t i = 1; i < fit.history.size(); ++i) {
        CHECK(fit.history[i] <= fit.history[i - 1]);
        CHECK(report.seconds[i] >= report.seconds[i - 1]);
    }
    if (!fit.history.empty()) {
        CHECK(fit.history.back() == fit.objective);
        CHECK(report.seconds.back() <= fit.seconds);
    }
    CHECK(fit.data_share.minCoeff() >= 0);
    CHECK(fit.data_share.maxCoeff() <= 1);
}

} // namespace

TEST_CASE_TEMPLATE("both searches find what springs did, and the same by the same seed", T, Dimension<2>,
                   Dimension<3>) {
    constexpr int Dim = T::value;
    const auto problem = representable<Dim>();
    const auto check = [&](const auto& engine, auto options, int evaluations) {
        const SearchReport report = engine(problem, options);
        CHECK(report.fit.status == Status::iteration_limit);
        check_report(problem, report);
        CHECK(report.fit.evaluations == evaluations);
        CHECK(report.fit.misfit < 0.05 * report.fit.misfit_start);
        const SearchReport again = engine(problem, options);
        CHECK(again.fit.theta == report.fit.theta);
        CHECK(again.fit.history == report.fit.history);
        options.seed = 2;
        CHECK(engine(problem, options).fit.theta != report.fit.theta);
        return report;
    };
    GeneticOptions genetic;
    genetic.generations = 100;
    const auto bred =
        check([](const auto& p, const auto& o) { return search::genetic(p, o); }, genetic, start + 20 * 101);
    CHECK(bred.fit.iterations == 101);
    AnnealingOptions annealing;
    annealing.temperatures = 30;
    const auto annealed =
        check([](const auto& p, const auto& o) { return search::annealing(p, o); }, annealing, start + 30 * 5 * 4);
    CHECK(annealed.fit.iterations == 30);
}

TEST_CASE("a problem of pagmo: J in the box, a penalty where nothing can be simulated, copies of their own") {
    const SmallBlock<2> block;
    auto network = block.network(0, 1);
    add_volume_cells(network, block.mesh);
    network.volume_stiffness.setConstant(0.2);
    TrajectoryOptions options;
    options.parameters.stiffness.lower = 0.5;
    const auto problem = std::make_shared<const TrajectoryProblem<2>>(
        network, block.equilibria(block.network(0.3, 1), 2, 0.01), options);
    const TrajectoryMatch<2> match(problem, {-2, 2.5});
    const pagmo::problem wrapped(match);
    const pagmo::problem copy(wrapped); // NOLINT(performance-unnecessary-copy-initialization)
    const Index springs = network.n_springs();
    const auto [lower, upper] = wrapped.get_bounds();
    REQUIRE(Index(lower.size()) == problem->n_unknowns());
    for (Index u = 0; u < problem->n_unknowns(); ++u) {
        CHECK(lower[std::size_t(u)] == (u < springs ? std::log(0.5) : -2));
        CHECK(upper[std::size_t(u)] == 2.5);
    }
    CHECK(wrapped.get_thread_safety() == pagmo::thread_safety::basic);

    Values<double> theta = Values<double>::Constant(problem->n_unknowns(), 0.1);
    TrajectoryPoint<2> point(*problem);
    REQUIRE(point.move_to(theta));
    const double value = wrapped.fitness({theta.begin(), theta.end()})[0];
    CHECK(test::relative(value, point.value(), value) < 1e-8);
    CHECK(copy.fitness({theta.begin(), theta.end()})[0] == value);
    theta.tail(network.n_cells()).setConstant(-2);
    theta.head(springs).setConstant(std::log(0.5));
    CHECK(wrapped.fitness({theta.begin(), theta.end()})[0] == TrajectoryMatch<2>::penalty);
    theta.setConstant(0.1); // nothing of the failure stays
    CHECK(wrapped.fitness({theta.begin(), theta.end()})[0] == value);

    CHECK_THROWS_AS(TrajectoryMatch<2>(nullptr), InvalidArgument);
    CHECK_THROWS_AS(TrajectoryMatch<2>(problem, {1, -1}), InvalidArgument);
    CHECK_THROWS_AS(TrajectoryMatch<2>(problem, {-std::numeric_limits<double>::infinity(), 1}), InvalidArgument);
    CHECK_THROWS_AS(TrajectoryMatch<2>(problem, {-3, -2}), InvalidArgument); // stiffness >= 0.5 is above it
}

TEST_CASE_TEMPLATE("regions that cannot be simulated, a prior that cannot, held unknowns", Options, GeneticOptions,
                   AnnealingOptions) {
    const SmallBlock<2> block;
    auto network = block.network(0, 1);
    add_volume_cells(network, block.mesh);
    auto truth = network;
    truth.volume_stiffness.setConstant(0.1);
    network.volume_stiffness.setConstant(0.5);
    TrajectoryOptions options;
    options.prior_weight = 1e-6;
    options.parameters.stiffness.fit = false;
    options.parameters.volume.ties.assign(std::size_t(network.n_cells()), 0);
    Options few;
    if constexpr (std::is_same_v<Options, GeneticOptions>) {
        few.generations = 20;
        few.spread = 2; // half of them unstable
        few.mutation_width = 0.2;
    } else {
        few.temperatures = 40;
        few.start_range = 1;
        few.start_temperature = 10;
    }
    const TrajectoryProblem<2> problem(network, block.equilibria(truth, 2, 0.01), options);
    const SearchReport report = run(problem, few);
    check_report(problem, report);
    CHECK(report.fit.rejected > 0);
    CHECK(report.fit.misfit < 0.1 * report.fit.misfit_start);

    network.volume_stiffness.setConstant(-50);
    const TrajectoryProblem<2> unstable(network, block.equilibria(truth, 1, 0.01), options);
    const SearchReport refused = run(unstable, few);
    CHECK(refused.fit.status == Status::failed);
    CHECK(refused.fit.theta.size() == 1);
    CHECK(refused.fit.history.empty());

    TrajectoryOptions fixed;
    fixed.parameters.stiffness.lower = fixed.parameters.stiffness.upper = 0.8;
    const auto held = representable<2>(fixed);
    const SearchReport same = run(held, few);
    check_report(held, same);
    CHECK(same.fit.theta == held.parameters().lower());
    CHECK(same.fit.objective == same.fit.objective_start);
}

TEST_CASE_TEMPLATE("a stop or a budget of time returns the best so far, a wrong option is refused", Options,
                   GeneticOptions, AnnealingOptions) {
    const auto problem = representable<2>();
    for (int stop : {0, 1, 50, 333}) {
        CAPTURE(stop);
        int calls = 0;
        double last = 0;
        Options options;
        options.progress = [&](const Progress& progress) {
            CHECK((progress.fraction >= last && progress.fraction <= 1));
            last = progress.fraction;
            return calls++ < stop;
        };
        const SearchReport report = run(problem, options);
        CHECK(report.fit.status == Status::interrupted);
        CHECK(calls == stop + 1);
        CHECK(report.fit.evaluations == start + stop);
        check_report(problem, report);
        CHECK(report.fit.history.empty() == (stop == 0));
    }
    Options options;
    options.seconds = 1e-9;
    const SearchReport report = run(problem, options);
    CHECK(report.fit.status == Status::iteration_limit);
    CHECK(report.fit.evaluations == start);
    CHECK(report.fit.theta.isZero(0));
    check_report(problem, report);

    options = {};
    options.progress = [](const Progress&) -> bool { throw std::runtime_error("mine"); };
    CHECK_THROWS_WITH_AS((void)run(problem, options), "mine", std::runtime_error);
    const auto refused = [&](const auto& change) {
        Options wrong;
        change(wrong);
        CHECK_THROWS_AS((void)run(problem, wrong), InvalidArgument);
    };
    refused([](auto& o) { o.seconds = 0; });
    refused([](auto& o) { o.seconds = std::nan(""); });
    refused([](auto& o) { o.box.lower = 4; });
    if constexpr (std::is_same_v<Options, GeneticOptions>) {
        refused([](auto& o) { o.population = 2; });
        refused([](auto& o) { o.population = 21; });
        refused([](auto& o) { o.generations = -1; });
        refused([](auto& o) { o.spread = 0; });
        refused([](auto& o) { o.crossover = 1.1; });
        refused([](auto& o) { o.mutations = 0; });
        refused([](auto& o) { o.mutation_width = 2; });
    } else {
        refused([](auto& o) { o.start_temperature = o.end_temperature; });
        refused([](auto& o) { o.end_temperature = 0; });
        refused([](auto& o) { o.temperatures = 0; });
        refused([](auto& o) { o.rounds = 0; });
        refused([](auto& o) { o.trials = 0; });
        refused([](auto& o) { o.start_range = 0; });
    }
}
