// SPDX-License-Identifier: BSD-3-Clause
#include "../fit/fit_data.hpp"

#include <numeric>
#include <stdexcept>

#include <springfit/fem/dynamics.hpp>
#include <springfit/fit/acceleration/exact.hpp>
#include <springfit/ipopt/exact.hpp>
#include <springfit/motion/record.hpp>
#include <springfit/network/builders.hpp>

using namespace springfit;
using test::Random;

namespace {

template <int Dim, class Scalar>
struct Case {
    SpringNetwork<Dim, Scalar> network;
    Motion<Dim, Scalar> motion;
};

template <int Dim, class Scalar>
Case<Dim, Scalar> make_case(unsigned seed, bool damped = false, int frames = 20) {
    Random random(seed);
    auto body = test::bodies<Dim, Scalar>().front();
    test::randomise(body.network, damped, random);
    return {body.network, test::random_motion<Dim, Scalar>(body.network, body.clamped, frames, random)};
}

} // namespace

TEST_CASE_TEMPLATE("active bounds: on the bound to the last bit, multipliers of the right sign", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto [network, motion] = make_case<dim, Scalar>(41);
    AccelerationOptions<Scalar> options;
    options.parameters.stiffness.lower = 250;
    options.parameters.stiffness.upper = 600;
    const AccelerationProblem problem = acceleration_problem<dim, Scalar>(network, {motion}, options);
    const AccelerationReport report = ipopt::exact(problem);
    CHECK(report.status == Status::converged);
    CHECK(report.kkt_residual < 1e-9);
    CHECK(report.theta.minCoeff() == 250);
    CHECK(report.theta.maxCoeff() == 600);
    CHECK(report.at_lower.size() > 0);
    CHECK(report.at_upper.size() > 0);
    CHECK(report.lower_multipliers.minCoeff() >= 0);
    CHECK(report.upper_multipliers.minCoeff() >= 0);
    CHECK(report.lower_multipliers.maxCoeff() > 0);
    CHECK(report.upper_multipliers.maxCoeff() > 0);
    const Values<double> gradient = problem.objective.gradient(report.theta);
    const double scale = problem.objective.linear().cwiseAbs().maxCoeff();
    CHECK((gradient - report.lower_multipliers + report.upper_multipliers).cwiseAbs().maxCoeff() < 1e-8 * scale);
    CHECK(report.history.size() == std::size_t(report.iterations) + 1);
}

TEST_CASE("held unknowns stay, and nothing to solve is no failure") {
    const auto [network, motion] = make_case<2, double>(42);
    AccelerationOptions<double> options;
    options.parameters.stiffness.lower = options.parameters.stiffness.upper = 400;
    const AccelerationProblem held = acceleration_problem<2, double>(network, {motion}, options);
    AccelerationReport report = ipopt::exact(held);
    CHECK(report.status == Status::converged);
    CHECK((report.theta.array() == 400).all());
    CHECK(report.iterations == 0);
    CHECK(report.objective == held.objective.value(held.prior));

    options.parameters.damping.fit = true;
    const AccelerationProblem half = acceleration_problem<2, double>(network, {motion}, options);
    report = ipopt::exact(half);
    CHECK(report.status == Status::converged);
    CHECK((half.parameters.per_spring(ParameterKind::stiffness, report.theta).tail(network.n_springs() - 1).array() ==
           400)
              .all());
    CHECK(report.objective < half.objective.value(half.prior));

    auto still = motion;
    still.clamped.resize(static_cast<std::size_t>(network.n_nodes()));
    std::iota(still.clamped.begin(), still.clamped.end(), 0);
    const AccelerationProblem nothing = acceleration_problem<2, double>(network, {still});
    report = ipopt::exact(nothing);
    CHECK(report.status == Status::converged);
    CHECK(report.theta.size() == 0);
}

TEST_CASE("a stop returns the best so far, an exception comes through, a wrong option is refused") {
    const auto [network, motion] = make_case<3, double>(43);
    AccelerationOptions<double> options;
    options.parameters.stiffness.upper = 300;
    options.parameters.stiffness.prior = Values<double>::Constant(network.n_springs(), 1.);
    const AccelerationProblem problem = acceleration_problem<3, double>(network, {motion}, options);
    const double start = problem.objective.value(problem.prior);
    const AccelerationReport whole = ipopt::exact(problem);

    for (int stop = 0; stop < 6; ++stop) {
        CAPTURE(stop);
        int calls = 0;
        const AccelerationReport report = ipopt::exact(problem, {.progress = [&](const Progress& p) {
                                                           CHECK(p.stage == "exact fit");
                                                           CHECK((p.fraction >= 0 && p.fraction <= 1));
                                                           return calls++ < stop;
                                                       }});
        CHECK(report.status == Status::interrupted);
        CHECK(calls == stop + 1);
        CHECK(report.objective <= start);
        CHECK(report.objective >= whole.objective);
        CHECK((report.theta.array() >= 0).all());
        CHECK((report.theta.array() <= 300).all());
    }
    const AccelerationReport limited = ipopt::exact(problem, {.max_iterations = 2});
    CHECK(limited.status == Status::iteration_limit);
    CHECK(limited.iterations == 2);
    CHECK(limited.objective <= start);

    CHECK_THROWS_WITH_AS(
        (void)ipopt::exact(problem, {.progress = [](const Progress&) -> bool { throw std::runtime_error("mine"); }}),
        "mine", std::runtime_error);
    CHECK_THROWS_AS((void)ipopt::exact(problem, {.ipopt = {{"no_such_option", "yes"}}}), InvalidArgument);
    CHECK_THROWS_AS((void)ipopt::exact(problem, {.ipopt = {{"mu_strategy", "backwards"}}}), InvalidArgument);
    CHECK_THROWS_AS((void)ipopt::exact(problem, {.print_level = 99}), InvalidArgument);
    CHECK_THROWS_AS((void)ipopt::exact(problem, {.tolerance = 0}), InvalidArgument);
    CHECK_THROWS_AS((void)ipopt::exact(problem, {.max_iterations = -1}), InvalidArgument);
    CHECK_THROWS_AS((void)ipopt::exact(problem, {.initial = Values<double>::Ones(2)}), InvalidArgument);
    const ipopt::ExactOptions other{.ipopt = {{"mehrotra_algorithm", "no"}, {"mu_init", 0.01}, {"max_iter", 500}}};
    CHECK(ipopt::exact(problem, other).status == Status::converged);
    CHECK(test::relative_difference(ipopt::exact(problem, {.initial = whole.theta}).theta, whole.theta) < 1e-9);
}

TEST_CASE("stiffness and damping orders of magnitude apart, in any unit") {
    for (const double unit : {1., 1e-9, 1e9}) {
        CAPTURE(unit);
        Random random(44);
        auto truth = test::bodies<3, double>().front().network;
        test::randomise(truth, true, random);
        truth.stiffness *= unit;
        truth.damping *= 1e-3 * unit;
        truth.mass *= unit;
        const auto motion = test::random_motion<3, double>(truth, {0, 1}, 60, random, unit);
        auto network = truth;
        network.stiffness.setZero();
        network.damping.setZero();
        AccelerationOptions<double> options;
        options.parameters.damping.fit = true;
        const AccelerationProblem problem = acceleration_problem<3, double>(network, {motion}, options);
        const AccelerationReport report = ipopt::exact(problem);
        CHECK(report.status == Status::converged);
        apply(problem, report, network);
        CHECK(test::relative_error(problem.parameters, ParameterKind::stiffness, network.stiffness, truth.stiffness) <
              1e-6);
        CHECK(test::relative_error(problem.parameters, ParameterKind::damping, network.damping, truth.damping) < 1e-6);
    }
}

TEST_CASE_TEMPLATE("the fit without Ipopt finds the same springs in the motion of finite elements", T,
                   test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto mesh = [] {
        if constexpr (dim == 2) {
            auto triangles = triangle_grid<double>({10, 5}, {1, 0.5});
            jitter(triangles, 0.2, 8u);
            return triangles;
        } else {
            auto tets = tetrahedron_grid<double>({6, 3, 3}, {1, 0.5, 0.5});
            jitter(tets, 0.2, 8u);
            return tets;
        }
    }();
    const fem::Model reference{mesh, fem::NeoHookean{.young = 1e4, .poisson = 0.3}, 1000.};
    std::vector<Motion<dim, double>> motions;
    for (int d = 0; d < dim; ++d) {
        Scenario<dim, double> scenario;
        scenario.name = "gravity";
        std::vector<int> clamped;
        for (Index i = 0; i < mesh.n_nodes(); ++i) {
            if (mesh.nodes(0, i) < 1e-9) {
                clamped.push_back(static_cast<int>(i));
            }
        }
        scenario.clamps.push_back({.nodes = clamped, .position = {}});
        Vector<dim, double> gravity = Vector<dim, double>::Zero();
        gravity(d) = 2;
        scenario.gravity.push_back({.acceleration = gravity, .amplitude = {}});
        motions.push_back(record(reference, scenario, {.dt = 0.05, .frames = 30}).motion);
    }
    auto network = springs_along_edges(mesh, {.density = 1000.});
    network.stiffness.setConstant(1000);
    const AccelerationProblem problem = acceleration_problem<dim, double>(network, motions);
    const AccelerationReport by_ipopt = ipopt::exact(problem);
    const AccelerationReport native = exact(problem);
    CHECK(native.status == Status::converged);
    CHECK(native.at_lower.size() > 5);
    CHECK(test::relative(native.objective, by_ipopt.objective, by_ipopt.objective) < 1e-8);
    CHECK(native.objective <= by_ipopt.objective * (1 + 1e-12));
    CHECK(test::relative_difference(native.theta, by_ipopt.theta) < 1e-6);
}
