// SPDX-License-Identifier: BSD-3-Clause
#include "fit_data.hpp"

#include <numeric>
#include <stdexcept>

#include <springfit/fit/acceleration/dominant_term.hpp>
#include <springfit/fit/acceleration/exact.hpp>
#include <springfit/motion/record.hpp>

using namespace springfit;
using test::Random;

namespace {

/// A problem with unknowns of stiffness alone, made from a quadratic and bounds.
AccelerationProblem box_problem(NodeQuadratic objective, const Values<double>& lower, const Values<double>& upper,
                                const Values<double>& start) {
    AccelerationProblem problem;
    const auto n = static_cast<int>(start.size());
    SpringNetwork<2, double> chain;
    chain.rest_positions = Points<2, double>::Zero(2, n + 1);
    chain.springs.resize(2, n);
    for (int e = 0; e <= n; ++e) {
        chain.rest_positions(0, e) = e;
        if (e < n) {
            chain.springs.col(e) << e, e + 1;
        }
    }
    chain.stiffness = Values<double>::Ones(n);
    chain.rest_length = Values<double>::Ones(n);
    chain.damping = Values<double>::Zero(n);
    problem.parameters = Parameters(chain, {});
    problem.objective = std::move(objective);
    problem.lower = lower;
    problem.upper = upper;
    problem.prior = start;
    return problem;
}

/// One term over all unknowns.
NodeQuadratic dense(const DenseMatrix<double>& h, const Values<double>& g, double constant) {
    std::vector<int> columns(static_cast<std::size_t>(g.size()));
    std::iota(columns.begin(), columns.end(), 0);
    std::vector<double> packed;
    for (Index q = 0; q < g.size(); ++q) {
        for (Index p = q; p < g.size(); ++p) {
            packed.push_back(h(p, q));
        }
    }
    NodeQuadratic quadratic(g.size());
    quadratic.add_term(0, columns, packed, std::vector<double>(g.begin(), g.end()), constant);
    return quadratic;
}

/// 1/2 sum (theta_{i+1} - theta_i)^2 - sum theta_i with both ends at 0: a term for each piece of the string.
NodeQuadratic string_under_weight(int n) {
    NodeQuadratic objective(n);
    const std::vector<int> first{0};
    const std::vector<int> last{n - 1};
    const std::vector<double> one{1};
    const std::vector<double> half{0.5};
    objective.add_term(0, first, one, half, 1e10);
    for (int i = 1; i < n; ++i) {
        const std::vector<int> ends{i - 1, i};
        const std::vector<double> halves{0.5, 0.5};
        const std::vector<double> pull{1, -1, 1};
        objective.add_term(i, ends, pull, halves, 0);
    }
    objective.add_term(n, last, one, half, 0);
    return objective;
}

/// The bounds hold, what the report says is so, and no multiplier has the wrong sign.
void check_report(const AccelerationProblem& problem, const AccelerationReport& report) {
    REQUIRE(report.theta.size() == problem.n_unknowns());
    CHECK((report.theta.array() >= problem.lower.array()).all());
    CHECK((report.theta.array() <= problem.upper.array()).all());
    CHECK(report.kkt_residual == kkt_residual(problem, report.theta, problem.objective.gradient(report.theta)));
    CHECK(report.objective == problem.objective.value(report.theta));
    CHECK(report.objective <= report.objective_start);
    CHECK(report.history.size() == std::size_t(report.iterations));
    CHECK(report.lower_multipliers.minCoeff() >= 0);
    CHECK(report.upper_multipliers.minCoeff() >= 0);
    for (Index u = 0; u < problem.n_unknowns(); ++u) {
        if (problem.held(u)) {
            CHECK(report.theta(u) == problem.prior(u));
        }
    }
}

template <int Dim>
auto grid(int n) {
    if constexpr (Dim == 2) {
        auto mesh = triangle_grid<double>({n, n}, {1, 1});
        jitter(mesh, 0.2, 6u);
        return mesh;
    } else {
        auto mesh = tetrahedron_grid<double>({n, n, n}, {1, 1, 1});
        jitter(mesh, 0.2, 6u);
        return mesh;
    }
}

/// Linear elasticity on a grid, its springs, and motion of the kind asked for, such that many bounds are active.
template <int Dim>
AccelerationProblem elastic_problem(int n, int n_fields, double wave, double amplitude, int frames, Random& random,
                                    double lower = 0) {
    const auto mesh = grid<Dim>(n);
    auto network = test::network_at_rest<Dim, double>(mesh.nodes, edges(mesh));
    network.stiffness.setConstant(100);
    const auto stiffness = test::simplex_stiffness(mesh, 1000., 0.4);
    auto fields = test::smooth_fields<Dim>(mesh.nodes, n_fields, amplitude, wave, random);
    std::vector<Points<Dim, double>> displacements;
    for (int t = 0; t < frames; ++t) { // combinations of few fields
        Points<Dim, double> u = Points<Dim, double>::Zero(Dim, mesh.n_nodes());
        for (const auto& field : fields) {
            u += random(-1, 1) * field;
        }
        displacements.push_back(u);
    }
    AccelerationOptions<double> options;
    options.parameters.stiffness.lower = lower;
    const auto motion = test::linear_motion<Dim>(network, stiffness, displacements);
    return acceleration_problem<Dim, double>(network, {motion}, options);
}

} // namespace

TEST_CASE("unknowns of their own: each is g / h, or the bound before it") {
    const Index n = 9;
    Values<double> h(n);
    Values<double> g(n);
    h << 1, 2, 4, 1e6, 1e-6, 3, 5, 7, 2;
    g << 3, -2, 2, 5e6, 2e-6, 3, -5, 70, 8;
    const Values<double> lower = Values<double>::Constant(n, -0.5);
    const Values<double> upper = Values<double>::Constant(n, 4);
    const AccelerationProblem problem =
        box_problem(dense(h.asDiagonal(), g, 1e9), lower, upper, Values<double>::Ones(n));
    const AccelerationReport report = exact(problem);
    CHECK(report.status == Status::converged);
    const double scale = 5e6 / 1e3; // the largest |g| / sqrt(h)
    for (Index u = 0; u < n; ++u) {
        CHECK(std::sqrt(h(u)) * std::abs(report.theta(u) - std::clamp(g(u) / h(u), -0.5, 4.)) <= 1e-10 * scale);
    }
    CHECK(report.at_lower.size() == 2);
    CHECK(report.at_upper.size() == 3); // one of them with a multiplier of 0
    CHECK(report.factorisations == 0);
}

TEST_CASE_TEMPLATE("one spring: its stiffness from one frame", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    Points<dim, Scalar> nodes = Points<dim, Scalar>::Zero(dim, 2);
    nodes(0, 1) = 1;
    auto network = test::network_at_rest<dim, Scalar>(nodes, (NodePairs(2, 1) << 0, 1).finished());
    Motion<dim, Scalar> motion;
    motion.rest_positions = nodes;
    motion.clamped = {0};
    motion.times = {0};
    motion.positions = {nodes};
    motion.positions[0](0, 1) = Scalar(1.25);
    motion.velocities = {Points<dim, Scalar>::Zero(dim, 2)};
    motion.external_forces = motion.velocities;
    motion.accelerations = motion.velocities;
    motion.accelerations[0](0, 1) = -2; // mass 1, stretch 1/4
    const AccelerationReport report = exact(acceleration_problem<dim, Scalar>(network, {motion}));
    CHECK(report.status == Status::converged);
    CHECK(test::relative(report.theta(0), 8., 8.) < 1e-12);
    AccelerationOptions<Scalar> options;
    options.parameters.stiffness.upper = 5;
    CHECK(exact(acceleration_problem<dim, Scalar>(network, {motion}, options)).theta(0) == 5);
}

TEST_CASE_TEMPLATE("a spring model is recovered, with damping, preload and ties", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    constexpr bool in_double = std::same_as<Scalar, double>;
    Random random(71);
    for (auto body : test::bodies<dim, Scalar>()) {
        for (const bool damped : {false, true}) {
            CAPTURE(body.name);
            CAPTURE(damped);
            auto truth = body.network;
            test::randomise(truth, damped, random);
            AccelerationOptions<Scalar> options;
            options.parameters.damping.fit = damped;
            options.parameters.preload.fit = damped;
            if (damped) {
                for (Scalar& l : truth.rest_length) {
                    l *= static_cast<Scalar>(random(0.8, 1.2));
                }
            } else {
                options.parameters.stiffness.ties.resize(std::size_t(truth.n_springs()));
                for (Index e = 0; e < truth.n_springs(); ++e) {
                    options.parameters.stiffness.ties[std::size_t(e)] = int(e % 7);
                    truth.stiffness(e) = Scalar(100 + 10 * (e % 7));
                }
            }
            const auto motion = test::random_motion<dim, Scalar>(truth, body.clamped, 60, random);
            auto network = body.network;
            network.mass = truth.mass;
            const AccelerationProblem problem = acceleration_problem<dim, Scalar>(network, {motion}, options);
            const AccelerationReport report = exact(problem, {.tolerance = 1e-14});
            CHECK(usable(report.status));
            check_report(problem, report);
            apply(problem, report, network);
            CHECK(test::relative_error(problem.parameters, ParameterKind::stiffness, network.stiffness,
                                       truth.stiffness) < (in_double ? 1e-9 : 1e-3));
            if (damped) {
                CHECK(test::relative_error(problem.parameters, ParameterKind::damping, network.damping, truth.damping) <
                      (in_double ? 1e-8 : 1e-2));
                CHECK(test::relative_error(problem.parameters, ParameterKind::preload, network.rest_length,
                                           truth.rest_length) < (in_double ? 1e-9 : 1e-3));
            }
        }
    }
}

TEST_CASE_TEMPLATE("active bounds: on the bound to the last bit, as projected Newton by hand has it", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    Random random(72);
    auto body = test::bodies<dim, Scalar>().front();
    test::randomise(body.network, false, random);
    const auto motion = test::random_motion<dim, Scalar>(body.network, body.clamped, 20, random);
    AccelerationOptions<Scalar> options;
    options.parameters.stiffness.lower = 250;
    options.parameters.stiffness.upper = 600;
    const AccelerationProblem problem = acceleration_problem<dim, Scalar>(body.network, {motion}, options);
    const AccelerationReport report = exact(problem);
    CHECK(report.status == Status::converged);
    check_report(problem, report);
    CHECK(report.kkt_residual <= 1e-10);
    CHECK(report.at_lower.size() > 0);
    CHECK(report.at_upper.size() > 0);
    const AccelerationReport sweeps = dominant_term(problem, {.max_sweeps = 2000, .tolerance = 1e-12});
    CHECK(test::relative_difference(report.theta, sweeps.theta) < 1e-8);
    const AccelerationReport warm = exact(problem, {.initial = report.theta});
    CHECK(warm.iterations == 0);
    CHECK(warm.theta == report.theta);
}

TEST_CASE_TEMPLATE("elastic motion with many bounds active", T, test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    Random random(73);
    const AccelerationProblem problem =
        elastic_problem<dim>(dim == 2 ? 12 : 5, 12, 2, 1e-2, 40, random, dim == 2 ? 300 : 0);
    const AccelerationReport report = exact(problem);
    CHECK(report.status == Status::converged);
    check_report(problem, report);
    CHECK(report.kkt_residual <= 1e-10);
    CHECK(report.at_lower.size() > 10);
}

TEST_CASE_TEMPLATE("two long waves tell springs apart badly, and still", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    Random random(74);
    const AccelerationProblem problem = elastic_problem<dim>(dim == 2 ? 20 : 7, 2, 0.3, 1e-3, 40, random);
    const AccelerationReport report = exact(problem);
    CHECK(report.status == Status::converged);
    check_report(problem, report);
    CHECK(report.products > 100);
}

TEST_CASE("a string under its weight: conjugate gradients give way to Cholesky") {
    // 1/2 sum (theta_{i+1} - theta_i)^2 - sum theta_i with both ends at 0 has the minimiser i (n + 1 - i) / 2.
    const int n = 3000;
    const Values<double> anything = Values<double>::Constant(n, std::numeric_limits<double>::infinity());
    const AccelerationReport report =
        exact(box_problem(string_under_weight(n), -anything, anything, Values<double>::Zero(n)));
    CHECK(report.status == Status::converged);
    CHECK(report.factorisations > 0);
    for (int i = 1; i <= n; ++i) {
        CHECK(test::relative(report.theta(i - 1), 0.5 * i * (n + 1. - i), 0.125 * n * n) < 1e-8);
    }
}

TEST_CASE("a string under its weight above a floor: a parabola that touches it, and the floor") {
    const int n = 300;
    const double floor = 0.0625 * n * n; // at half its depth
    const AccelerationProblem problem = box_problem(string_under_weight(n), Values<double>::Zero(n),
                                                    Values<double>::Constant(n, floor), Values<double>::Zero(n));
    const AccelerationReport report = exact(problem);
    CHECK(report.status == Status::converged);
    check_report(problem, report);
    const double touch = std::sqrt(2 * floor); // a parabola of curvature 1 is level there
    CHECK(std::abs(double(report.at_upper.size()) - (n - 2 * touch)) < 4);
    for (int i = 1; i < touch - 2; ++i) {
        CHECK(test::relative(report.theta(i - 1), floor - 0.5 * (touch - i) * (touch - i), floor) < 1 / touch);
    }
}

TEST_CASE("sets that go round in circles are settled by a pull to where they are") {
    // Semidefinite, far from diagonally dominant and with degenerate bounds: from random starts sets do not settle
    // alone.
    Random random(75);
    int settled = 0;
    for (int trial = 0; trial < 300; ++trial) {
        CAPTURE(trial);
        const Index n = 3 + trial % 8;
        const DenseMatrix<double> a = random.points<2, double>(n, 1).transpose();
        DenseMatrix<double> h = a * a.transpose();
        h.diagonal().array() += trial % 3 == 0 ? 1e-6 : 1e-3;
        const Values<double> g = random.points<3, double>(n, 2).row(0).transpose();
        const Values<double> start = Values<double>::Constant(n, random(0, 0.5));
        AccelerationProblem problem =
            box_problem(dense(h, g, 1e3), Values<double>::Zero(n), Values<double>::Ones(n), start);
        problem.upper.setConstant(trial % 2 == 0 ? 1 : std::numeric_limits<double>::infinity());
        const AccelerationReport report = exact(problem);
        CHECK((report.status == Status::converged || report.status == Status::stalled));
        CHECK(report.kkt_residual <= 1e-9); // rounding times a condition of 1e7
        check_report(problem, report);
        settled += report.iterations > 8 ? 1 : 0;
        Values<double> x = start;
        BoundedLeastSquares solver;
        REQUIRE(solver.solve(h, g, problem.lower, problem.upper, x));
        CHECK(report.objective <= problem.objective.value(x) + 1e-9 * 1e3);
    }
    CHECK(settled > 0);
}

TEST_CASE("held unknowns stay, and nothing to solve is no failure") {
    Random random(76);
    auto body = test::bodies<2, double>().front();
    test::randomise(body.network, false, random);
    const auto motion = test::random_motion<2, double>(body.network, body.clamped, 20, random);
    AccelerationOptions<double> options;
    options.parameters.stiffness.lower = options.parameters.stiffness.upper = 400;
    const AccelerationProblem held = acceleration_problem<2, double>(body.network, {motion}, options);
    AccelerationReport report = exact(held);
    CHECK(report.status == Status::converged);
    CHECK((report.theta.array() == 400).all());
    CHECK(report.iterations == 0);
    CHECK(report.objective == report.objective_start);
    auto still = motion;
    still.clamped.resize(static_cast<std::size_t>(body.network.n_nodes()));
    std::iota(still.clamped.begin(), still.clamped.end(), 0);
    report = exact(acceleration_problem<2, double>(body.network, {still}));
    CHECK(report.status == Status::converged);
    CHECK(report.theta.size() == 0);
}

TEST_CASE("what is not a number is never certified") {
    const double nan = std::nan("");
    const Values<double> infinite = Values<double>::Constant(3, std::numeric_limits<double>::infinity());
    const auto problem = [&](const DenseMatrix<double>& h, const Values<double>& g) {
        return box_problem(dense(h, g, 10), -infinite, infinite, Values<double>::Ones(3));
    };
    const DenseMatrix<double> h = Eigen::Matrix3d::Identity();
    const Values<double> g = Values<double>::Ones(3); // so that the start is the minimum
    CHECK(exact(problem(h, g)).status == Status::converged);
    CHECK(std::isnan(kkt_residual(problem(h, g), Values<double>::Constant(3, nan))));
    for (Index u = 0; u < 3; ++u) {
        CAPTURE(u);
        Values<double> theta = g;
        theta(u) = nan;
        CHECK(std::isnan(kkt_residual(problem(h, g), theta, Values<double>::Zero(3))));
        CHECK(std::isnan(kkt_residual(problem(h, g), g, theta)));
        Values<double> wrong_g = g;
        wrong_g(u) = nan;
        DenseMatrix<double> wrong_h = h;
        wrong_h(u, u) = nan;
        for (const AccelerationProblem& wrong : {problem(h, wrong_g), problem(wrong_h, g)}) {
            CHECK(std::isnan(kkt_residual(wrong, g)));
            for (const AccelerationReport& report : {exact(wrong), dominant_term(wrong)}) {
                CHECK(report.status == Status::diverged);
                CHECK(std::isnan(report.kkt_residual));
                CHECK(report.theta == g); // the start
                CHECK(report.iterations == 0);
            }
            CHECK(one_pass(wrong).status != Status::converged);
        }
    }
}

TEST_CASE("a stop returns the best so far, an exception comes through, a wrong option is refused") {
    Random random(77);
    const AccelerationProblem problem = elastic_problem<3>(4, 12, 2, 1e-2, 40, random);
    const AccelerationReport whole = exact(problem);
    for (int stop = 0; stop < 4; ++stop) {
        CAPTURE(stop);
        int calls = 0;
        const AccelerationReport report = exact(problem, {.progress = [&](const Progress& p) {
                                                    CHECK(p.stage == "exact fit");
                                                    CHECK((p.fraction >= 0 && p.fraction <= 1));
                                                    return calls++ < stop;
                                                }});
        CHECK(report.status == Status::interrupted);
        CHECK(calls == stop + 1);
        check_report(problem, report);
        CHECK(report.objective >= whole.objective * (1 - 1e-12));
    }
    const AccelerationReport limited = exact(problem, {.max_iterations = 2});
    CHECK(limited.status == Status::iteration_limit);
    CHECK(limited.iterations == 2);
    check_report(problem, limited);
    CHECK_THROWS_WITH_AS(
        (void)exact(problem, {.progress = [](const Progress&) -> bool { throw std::runtime_error("mine"); }}), "mine",
        std::runtime_error);
    CHECK_THROWS_AS((void)exact(problem, {.tolerance = 0}), InvalidArgument);
    CHECK_THROWS_AS((void)exact(problem, {.tolerance = std::nan("")}), InvalidArgument);
    CHECK_THROWS_AS((void)exact(problem, {.max_iterations = -1}), InvalidArgument);
    CHECK_THROWS_AS((void)exact(problem, {.initial = Values<double>::Ones(2)}), InvalidArgument);
    CHECK_THROWS_AS((void)exact(problem, {.initial = Values<double>::Constant(problem.n_unknowns(), std::nan(""))}),
                    InvalidArgument);
}

TEST_CASE("the packed product is that of the matrix, for every size") {
    Random random(78);
    for (Index n = 1; n < 40; ++n) {
        CAPTURE(n);
        DenseMatrix<double> h = DenseMatrix<double>::Zero(n, n);
        for (double& value : h.reshaped()) {
            value = random(-1, 1);
        }
        h = (h + h.transpose()).eval();
        const Values<double> x = random.points<2, double>(n, 1).row(0).transpose();
        const NodeQuadratic quadratic = dense(h, x, 0);
        CHECK((quadratic.product(x) - h * x).cwiseAbs().maxCoeff() < 1e-13);
        Values<double> again;
        const double square = detail::NodeProduct(quadratic, {})(x, again);
        CHECK(again == quadratic.product(x));
        CHECK(test::relative(square, x.dot(h * x), double(n)) < 1e-13);
    }
}
