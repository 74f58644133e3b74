// SPDX-License-Identifier: BSD-3-Clause
#include "../fit/trajectory_cases.hpp"

#include <stdexcept>

#include <springfit/ipopt/trajectory.hpp>

using namespace springfit;
using test::Dimension;
using test::SmallBlock;

namespace {

GaussNewtonOptions to_the_end() {
    GaussNewtonOptions options;
    options.max_iterations = 300;
    options.tolerance = 1e-9;
    return options;
}

/// What a report says of its point is so.
template <int Dim>
void check_report(const TrajectoryProblem<Dim>& problem, const TrajectoryReport& report) {
    const auto& lower = problem.parameters().lower();
    const auto& upper = problem.parameters().upper();
    REQUIRE(report.theta.size() == problem.n_unknowns());
    CHECK((report.theta.array() >= lower.array()).all());
    CHECK((report.theta.array() <= upper.array()).all());
    TrajectoryPoint<Dim> point(problem);
    REQUIRE(point.move_to(report.theta));
    CHECK(test::relative(report.objective, point.value(), report.objective_start) < 1e-8);
    CHECK(test::relative(report.misfit, point.misfit(), report.misfit_start) < 1e-8);
    CHECK(report.objective <= report.objective_start);
    CHECK(report.history.size() == std::size_t(report.iterations));
    CHECK(report.evaluations >= 1);
    CHECK(report.curvature.minCoeff() >= 0);
    CHECK(report.data_share.minCoeff() >= 0);
    CHECK(report.data_share.maxCoeff() <= 1);
}

} // namespace

TEST_CASE_TEMPLATE("linear elasticity: the optimum of Gauss-Newton", T, Dimension<2>, Dimension<3>) {
    constexpr int Dim = T::value;
    const SmallBlock<Dim> block;
    TrajectoryOptions options;
    options.prior_weight = 1e-3;
    SUBCASE("springs") {}
    SUBCASE("ties") {
        options.parameters.stiffness.ties.resize(std::size_t(springs_along_edges(block.mesh, {}).n_springs()));
        for (std::size_t e = 0; e < options.parameters.stiffness.ties.size(); ++e) {
            options.parameters.stiffness.ties[e] = int(e % 3);
        }
    }
    SUBCASE("bounds that bind") {
        options.parameters.stiffness.lower = 0.2;
        options.parameters.stiffness.upper = 0.6;
    }
    const TrajectoryProblem<Dim> problem = block.elastic(options, 12, 3e-4);
    const TrajectoryReport reference = gauss_newton(problem, to_the_end());
    const TrajectoryReport report = ipopt::trajectory(problem);
    CHECK(report.status == Status::converged);
    check_report(problem, report);
    CHECK(report.objective_start == reference.objective_start);
    CHECK(report.misfit_start == reference.misfit_start);
    CHECK(test::relative(report.objective, reference.objective, reference.objective) < 1e-4);
    CHECK(report.gradient_max < 1e-2 * report.objective);
    const auto& lower = problem.parameters().lower();
    const auto& upper = problem.parameters().upper();
    Index on_bound = 0;
    for (Index u = 0; u < report.theta.size(); ++u) {
        CAPTURE(u);
        CHECK((report.theta(u) == lower(u)) == (reference.theta(u) == lower(u)));
        CHECK((report.theta(u) == upper(u)) == (reference.theta(u) == upper(u)));
        on_bound += report.theta(u) == lower(u) || report.theta(u) == upper(u) ? 1 : 0;
    }
    CHECK((on_bound > 0) == std::isfinite(options.parameters.stiffness.upper));
    CHECK((report.theta.size() == 3) == !options.parameters.stiffness.ties.empty());
}

TEST_CASE_TEMPLATE("what springs did is found again from their equilibria and swings", T, Dimension<2>, Dimension<3>) {
    constexpr int Dim = T::value;
    const SmallBlock<Dim> block;
    const auto truth = block.network(0.5, 1);
    auto network = truth;
    network.stiffness.setOnes();
    TrajectoryOptions options;
    options.prior_weight = 1e-12;
    ipopt::TrajectoryFitOptions engine;
    engine.tolerance = 1e-6;
    SUBCASE("equilibria") {
        const TrajectoryProblem<Dim> problem(network, block.equilibria(truth, 12, Dim == 2 ? 0.03 : 0.003), options);
        const TrajectoryReport report = ipopt::trajectory(problem, engine);
        CHECK(usable(report.status));
        check_report(problem, report);
        CHECK(report.misfit < 1e-4);
        apply(problem, report, network);
        for (Index e = 0; e < network.n_springs(); ++e) {
            CAPTURE(e);
            if (report.data_share(e) > 0.5) {
                CHECK(test::relative(network.stiffness(e), truth.stiffness(e), truth.stiffness(e)) < 2e-3);
            }
        }
        CHECK(report.n_set_by_data() > network.n_springs() / 2);
    }
    SUBCASE("swings, damping too") {
        network.damping *= 2;
        options.prior_weight = 1e-4;
        options.parameters.damping.fit = true;
        options.steps_per_frame = 2;
        const TrajectoryProblem<Dim> problem(network, block.swings(truth, 2, 0.005, 0.1, 10), options);
        const TrajectoryReport reference = gauss_newton(problem, to_the_end());
        const TrajectoryReport report = ipopt::trajectory(problem);
        CHECK(usable(report.status));
        check_report(problem, report);
        CHECK(test::relative(report.objective, reference.objective, reference.objective) < 1e-4);
        CHECK(report.misfit < report.misfit_start / 5);
    }
}

TEST_CASE_TEMPLATE("points that cannot be simulated are stepped back from", T, Dimension<2>, Dimension<3>) {
    constexpr int Dim = T::value;
    const SmallBlock<Dim> block;
    // Cells of negative stiffness make a body unstable; long first steps lead there.
    auto truth = block.network(0, 1);
    add_volume_cells(truth, block.mesh);
    truth.volume_stiffness.setConstant(0.05);
    auto network = truth;
    network.volume_stiffness.setConstant(0.6);
    TrajectoryOptions options;
    options.parameters.stiffness.fit = false;
    options.prior_weight = 1e-9;
    const TrajectoryProblem<Dim> problem(network, block.equilibria(truth, 6, 1e-2), options);
    ipopt::TrajectoryFitOptions engine;
    engine.max_step = 1e3;
    engine.ipopt = {{"limited_memory_initialization", "constant"}, {"limited_memory_init_val", 1e-4}};
    const TrajectoryReport report = ipopt::trajectory(problem, engine);
    CHECK(usable(report.status));
    check_report(problem, report);
    CHECK(report.rejected > 0);
    CHECK(report.misfit < report.misfit_start / 100);

    // An unstable prior is no point to start from, nor are its multiples.
    network.volume_stiffness.setConstant(-50);
    const TrajectoryProblem<Dim> unstable(network, block.equilibria(truth, 1, 1e-2), options);
    const TrajectoryReport refused = ipopt::trajectory(unstable);
    CHECK(refused.status == Status::failed);
    CHECK(refused.theta.size() == unstable.n_unknowns());
    CHECK(refused.evaluations == 4); // the prior, and stiffer ones
    CHECK(refused.iterations == 0);
}

TEST_CASE("a stop returns the best so far, held unknowns stay, a wrong option is refused") {
    const SmallBlock<2> block;
    TrajectoryOptions options;
    const TrajectoryProblem<2> problem = block.elastic(options, 6, 3e-4);
    const TrajectoryReport whole = ipopt::trajectory(problem);
    double last = whole.objective_start;
    for (int stop = 0; stop < 6; ++stop) {
        CAPTURE(stop);
        int calls = 0;
        ipopt::TrajectoryFitOptions engine;
        engine.progress = [&](const Progress& progress) {
            CHECK(progress.stage == "trajectory");
            CHECK((progress.fraction >= 0 && progress.fraction <= 1));
            return calls++ < stop;
        };
        const TrajectoryReport report = ipopt::trajectory(problem, engine);
        CHECK(report.status == Status::interrupted);
        CHECK(calls == stop + 1);
        check_report(problem, report);
        CHECK(report.objective <= last);
        last = report.objective;
    }
    CHECK(last < whole.objective_start);
    CHECK(last >= whole.objective);

    ipopt::TrajectoryFitOptions engine;
    engine.max_iterations = 2;
    const TrajectoryReport limited = ipopt::trajectory(problem, engine);
    CHECK(limited.status == Status::iteration_limit);
    CHECK(limited.iterations == 2);
    check_report(problem, limited);

    options.parameters.stiffness.lower = options.parameters.stiffness.upper = 0.5;
    const TrajectoryProblem<2> held = block.elastic(options, 2, 3e-4);
    const TrajectoryReport nothing = ipopt::trajectory(held);
    CHECK(nothing.status == Status::converged);
    CHECK(nothing.theta == held.parameters().lower());
    CHECK(nothing.objective == nothing.objective_start);

    engine = {};
    engine.progress = [](const Progress&) -> bool { throw std::runtime_error("mine"); };
    CHECK_THROWS_WITH_AS((void)ipopt::trajectory(problem, engine), "mine", std::runtime_error);
    const auto refused = [&](const auto& change) {
        ipopt::TrajectoryFitOptions wrong;
        change(wrong);
        CHECK_THROWS_AS((void)ipopt::trajectory(problem, wrong), InvalidArgument);
    };
    refused([](auto& o) { o.tolerance = 0; });
    refused([](auto& o) { o.tolerance = std::nan(""); });
    refused([](auto& o) { o.max_iterations = -1; });
    refused([](auto& o) { o.memory = 0; });
    refused([](auto& o) { o.probes = 0; });
    refused([](auto& o) { o.max_step = 0; });
    refused([](auto& o) { o.print_level = 13; });
    refused([](auto& o) { o.ipopt = {{"no_such_option", 1}}; });
}
