// SPDX-License-Identifier: BSD-3-Clause
#include "fit_data.hpp"

#include <springfit/fit/acceleration/dominant_term.hpp>
#include <springfit/fit/trajectory/gauss_newton.hpp>
#include <springfit/motion/record.hpp>
#include <springfit/network/volume.hpp>
#include <springfit/simulate/equilibrium.hpp>
#include <springfit/simulate/symplectic_euler.hpp>

using namespace springfit;
using test::Random;

namespace {

template <int D>
using Dimension = std::integral_constant<int, D>;

/// A small body of springs and cells whose stiffness varies, its first nodes clamped.
template <int Dim>
struct Fixture {
    SpringNetwork<Dim, double> network;
    std::vector<int> clamped;

    explicit Fixture(bool cells) {
        Random random(5);
        if constexpr (Dim == 2) {
            auto mesh = triangle_grid<double>({3, 2}, {1.5, 1.});
            jitter(mesh, 0.2, 3u);
            network = test::network_at_rest<2, double>(mesh.nodes, edges(mesh));
            if (cells) {
                add_volume_cells(network, mesh);
            }
            clamped = {0, 4, 8};
        } else {
            auto mesh = tetrahedron_grid<double>({2, 1, 1}, {1., 0.5, 0.5});
            jitter(mesh, 0.2, 3u);
            network = test::network_at_rest<3, double>(mesh.nodes, edges(mesh));
            if (cells) {
                add_volume_cells(network, mesh);
            }
            clamped = {0, 3, 6, 9};
        }
        for (Index e = 0; e < network.n_springs(); ++e) {
            network.stiffness(e) = random(0.5, 2.);
            network.damping(e) = random(0.01, 0.05);
        }
        for (Index c = 0; c < network.n_cells(); ++c) {
            network.volume_stiffness(c) = random(0.2, 1.);
        }
        network.mass *= 0.1;
    }

    [[nodiscard]] Motion<Dim, double> static_case(double force, unsigned seed) const {
        Random random(seed);
        Scenario<Dim, double> scenario;
        scenario.name = "static";
        scenario.clamps.push_back({clamped, {}});
        NodalLoad<Dim, double> load;
        for (int i = 0; i < network.n_nodes(); ++i) {
            load.nodes.push_back(i);
        }
        load.forces = random.points<Dim, double>(network.n_nodes(), force);
        scenario.loads.push_back(load);
        const auto rest = equilibrium(network, scenario);
        REQUIRE(rest.status == Status::converged);
        REQUIRE(rest.stable);
        Motion<Dim, double> motion;
        motion.name = "static";
        motion.rest_positions = network.rest_positions;
        motion.clamped = clamped;
        motion.times = {0.};
        motion.positions = {rest.positions};
        motion.velocities = {Points<Dim, double>::Zero(Dim, network.n_nodes())};
        motion.accelerations = motion.velocities;
        motion.external_forces = {load.forces};
        return motion;
    }

    /// Let go from a stretched shape, under a constant force, one clamped node driven.
    [[nodiscard]] Motion<Dim, double> swing(int frames, double dt, unsigned seed) const {
        Random random(seed);
        Scenario<Dim, double> scenario;
        scenario.name = "swing";
        Clamp<Dim, double> clamp{clamped, {}};
        clamp.position = [](const Vector<Dim, double>& rest, double time) {
            Vector<Dim, double> x = rest;
            x(1) += 0.05 * std::sin(2 * time);
            return x;
        };
        scenario.clamps.push_back(clamp);
        scenario.initial_positions = network.rest_positions + random.points<Dim, double>(network.n_nodes(), 0.05);
        scenario.initial_velocities = random.points<Dim, double>(network.n_nodes(), 0.1);
        for (int node : clamped) {
            scenario.initial_positions.col(node) = network.rest_positions.col(node);
            scenario.initial_velocities.col(node).setZero();
        }
        NodalLoad<Dim, double> load;
        load.nodes = {static_cast<int>(network.n_nodes()) - 1};
        load.forces = random.points<Dim, double>(1, 0.1);
        scenario.loads.push_back(load);
        SymplecticEulerOptions<double> fine;
        fine.step_fraction = 0.02;
        SymplecticEuler<Dim, double> stepper(network, fine);
        auto recording = record_stepper(stepper, scenario, {.dt = dt, .frames = frames});
        REQUIRE(recording.status == Status::converged);
        return recording.motion;
    }
};

/// A network whose values are off, as a prior.
template <int Dim>
SpringNetwork<Dim, double> disturbed(SpringNetwork<Dim, double> network, double most, unsigned seed) {
    Random random(seed);
    for (Index e = 0; e < network.n_springs(); ++e) {
        network.stiffness(e) *= std::exp(random(-most, most));
        network.damping(e) *= std::exp(random(-most, most));
    }
    for (Index c = 0; c < network.n_cells(); ++c) {
        network.volume_stiffness(c) += random(-most, most);
    }
    return network;
}

TrajectoryOptions everything() {
    TrajectoryOptions options;
    options.parameters.damping.fit = true;
    options.parameters.rest_length.fit = true;
    options.prior_weight = 1e-3;
    return options;
}

template <int Dim>
void check_gradient(const TrajectoryProblem<Dim>& problem, unsigned seed) {
    Random random(seed);
    Values<double> theta(problem.n_unknowns());
    for (double& value : theta) {
        value = random(-0.2, 0.2);
    }
    TrajectoryPoint<Dim> point(problem);
    REQUIRE(point.move_to(theta));
    Values<double> gradient;
    REQUIRE(point.gradient(gradient));
    const double step = 1e-4;
    TrajectoryPoint<Dim> other(problem);
    const Index last = theta.size() - 1; // beta's, where that is fitted
    for (Index u = 0; u <= last; u = u == last ? last + 1 : std::min(u + 3, last)) {
        CAPTURE(u);
        Values<double> moved = theta;
        moved(u) += step;
        REQUIRE(other.move_to(moved, &point));
        const double above = other.value();
        moved(u) -= 2 * step;
        REQUIRE(other.move_to(moved, &point));
        const double difference = (above - other.value()) / (2 * step);
        CHECK(test::relative(gradient(u), difference, gradient.cwiseAbs().maxCoeff()) < 2e-6);
    }
}

} // namespace

TEST_CASE_TEMPLATE("the adjoint gradient is that of finite differences", T, Dimension<2>, Dimension<3>) {
    constexpr int Dim = T::value;
    const Fixture<Dim> fixture(true);
    const auto prior = disturbed(fixture.network, 0.3, 9);
    auto options = everything();
    SUBCASE("statics at large strain") {
        options.parameters.damping.fit = false;
        check_gradient(TrajectoryProblem<Dim>(
                           prior, std::vector{fixture.static_case(0.1, 1), fixture.static_case(0.2, 2)}, options),
                       1);
    }
    SUBCASE("midpoint steps, several windows, few checkpoints") {
        options.horizon = 4;
        options.window_stride = 3;
        options.steps_per_frame = 3;
        options.checkpoint_interval = 5;
        check_gradient(TrajectoryProblem<Dim>(prior, std::vector{fixture.swing(12, 0.15, 1)}, options), 2);
    }
    SUBCASE("implicit Euler, whole motion, beside statics") {
        options.rule = PredictionRule::implicit_euler;
        check_gradient(
            TrajectoryProblem<Dim>(prior, std::vector{fixture.swing(8, 0.2, 3), fixture.static_case(0.1, 3)}, options),
            3);
    }
    SUBCASE("damping that follows stiffness, ties") {
        options.parameters.damping.fit = false;
        options.parameters.rest_length.fit = false;
        options.parameters.damping_per_stiffness = 0.05;
        SUBCASE("known") {}
        SUBCASE("fitted as one value") {
            options.parameters.fit_damping_per_stiffness = true;
        }
        options.parameters.stiffness.ties.resize(static_cast<std::size_t>(prior.n_springs()));
        for (std::size_t e = 0; e < options.parameters.stiffness.ties.size(); ++e) {
            options.parameters.stiffness.ties[e] = static_cast<int>(e % 4);
        }
        check_gradient(TrajectoryProblem<Dim>(prior, std::vector{fixture.swing(10, 0.15, 5)}, options), 4);
    }
}

TEST_CASE_TEMPLATE("products with the Gauss-Newton matrix are those of its dense form and of finite differences", T,
                   Dimension<2>, Dimension<3>) {
    constexpr int Dim = T::value;
    const Fixture<Dim> fixture(true);
    const auto prior = disturbed(fixture.network, 0.3, 9);
    TrajectoryOptions options;
    options.prior_weight = 1e-3;
    // So small that the matrix at the rest shape is that at the equilibrium.
    const TrajectoryProblem<Dim> problem(
        prior, std::vector{fixture.static_case(1e-8, 1), fixture.static_case(1e-8, 2), fixture.static_case(1e-8, 3)},
        options);
    TrajectoryPoint<Dim> point(problem);
    const Values<double> theta = Values<double>::Zero(problem.n_unknowns());
    REQUIRE(point.move_to(theta));
    REQUIRE(point.has_dense());
    const DenseMatrix<double> dense = point.dense();
    DenseMatrix<double> products(theta.size(), theta.size());
    for (Index u = 0; u < theta.size(); ++u) {
        products.col(u) = point.product(Values<double>::Unit(theta.size(), u));
    }
    CHECK(test::relative_difference(products, dense) < 1e-6);
    CHECK(test::relative_difference(products, products.transpose().eval()) < 1e-6);

    // J' W J is the curvature of J along a direction where the residual is that of the reference itself.
    TrajectoryOptions bare;
    bare.prior_weight = 0;
    const TrajectoryProblem<Dim> own(fixture.network, std::vector{fixture.swing(6, 0.1, 4)}, [&] {
        auto fine = bare;
        fine.steps_per_frame = 2;
        fine.parameters.damping.fit = true;
        return fine;
    }());
    TrajectoryPoint<Dim> truth(own);
    const Values<double> zero = Values<double>::Zero(own.n_unknowns());
    REQUIRE(truth.move_to(zero));
    const Values<double> diagonal = truth.curvature(400);
    for (Index u = 0; u < zero.size(); u += 5) {
        CAPTURE(u);
        const double entry = truth.product(Values<double>::Unit(zero.size(), u))(u);
        CHECK(entry >= 0);
        CHECK(diagonal(u) >= entry / 2); // 400 probes: 7 % of standard deviation
        CHECK(diagonal(u) <= entry * 2);
    }
}

TEST_CASE_TEMPLATE("products of motions in time are those of finite differences, with many steps as with few", T,
                   Dimension<2>, Dimension<3>) {
    constexpr int Dim = T::value;
    Fixture<Dim> fixture(true);
    auto& network = fixture.network;
    network.damping = 0.05 * network.stiffness;
    Random random(12);
    for (const int steps : {1, 4, 32}) {
        CAPTURE(steps);
        TrajectoryOptions options;
        options.prior_weight = 0;
        options.steps_per_frame = steps;
        options.parameters.damping_per_stiffness = 0.05;
        options.parameters.fit_damping_per_stiffness = true;
        // Its own motion: J is almost 0 there, and its curvature J' W J alone.
        const TrajectoryProblem<Dim> problem(network, std::vector{fixture.swing(10, 0.02, 4)}, options);
        TrajectoryPoint<Dim> truth(problem), other(problem);
        const Values<double> zero = Values<double>::Zero(problem.n_unknowns());
        REQUIRE(truth.move_to(zero));
        Values<double> direction = zero;
        for (double& value : direction) {
            value = random(-1, 1);
        }
        const double step = 1e-3;
        REQUIRE(other.move_to(step * direction, &truth));
        double difference = other.value();
        REQUIRE(other.move_to(-step * direction, &truth));
        difference += other.value() - 2 * truth.value();
        const double expected = difference / (step * step);
        CHECK(test::relative(direction.dot(truth.product(direction)), expected, expected) < 0.03);
        const Values<double> diagonal = truth.curvature(200);
        for (Index u = 0; u < zero.size(); u += 7) {
            CAPTURE(u);
            const double entry = truth.product(Values<double>::Unit(zero.size(), u))(u);
            CHECK(diagonal(u) >= entry / 2);
            CHECK(diagonal(u) <= entry * 2);
        }
    }
}

TEST_CASE_TEMPLATE("what springs did is found again from their motion", T, Dimension<2>, Dimension<3>) {
    constexpr int Dim = T::value;
    const Fixture<Dim> fixture(false);
    const auto prior = disturbed(fixture.network, 0.5, 4);
    TrajectoryOptions options;
    options.prior_weight = 1e-12;
    GaussNewtonOptions engine;
    engine.max_iterations = 100;
    engine.tolerance = 1e-8;
    engine.max_cg_iterations = 200;
    engine.cg_tolerance = 1e-3;
    auto network = prior;
    SUBCASE("equilibria at large strain") {
        std::vector<Motion<Dim, double>> cases;
        for (unsigned seed = 1; seed <= 12; ++seed) {
            cases.push_back(fixture.static_case(0.1, seed));
        }
        const TrajectoryProblem<Dim> problem(prior, cases, options);
        const auto report = gauss_newton(problem, engine);
        CHECK(usable(report.status));
        CHECK(report.misfit < 1e-5);
        apply(problem, report, network);
        for (Index e = 0; e < network.n_springs(); ++e) {
            const auto is_clamped = [&](int node) {
                return std::count(fixture.clamped.begin(), fixture.clamped.end(), node) > 0;
            };
            const bool held = is_clamped(network.springs(0, e)) && is_clamped(network.springs(1, e));
            CAPTURE(e);
            if (held) { // no motion says anything
                CHECK(network.stiffness(e) == prior.stiffness(e));
                CHECK(report.data_share(e) == 0);
            } else {
                CHECK(test::relative(network.stiffness(e), fixture.network.stiffness(e), fixture.network.stiffness(e)) <
                      1e-3);
            }
        }
    }
    SUBCASE("a swing, with its damping") {
        options.parameters.damping.fit = true;
        options.steps_per_frame = 4;
        engine.max_cg_iterations = 40;
        engine.max_iterations = 30;
        const TrajectoryProblem<Dim> problem(
            prior, std::vector{fixture.swing(24, 0.05, 1), fixture.swing(24, 0.05, 2), fixture.swing(24, 0.05, 3)},
            options);
        const auto report = gauss_newton(problem, engine);
        CHECK(usable(report.status));
        CHECK(report.misfit < 2e-3); // what is left is the integrators' difference
        apply(problem, report, network);
        Index near = 0;
        for (Index e = 0; e < network.n_springs(); ++e) {
            near += std::abs(std::log(network.stiffness(e) / fixture.network.stiffness(e))) < 0.05 ? 1 : 0;
        }
        CHECK(near >= network.n_springs() * 8 / 10);
        CHECK(report.misfit < report.misfit_start / 20);
    }
}

TEST_CASE("the springs of a stretched membrane, which resist nothing sideways at rest, are found from its equilibria") {
    auto flat = triangle_grid<double>({4, 3}, {1., 0.8});
    jitter(flat, 0.2, 3u);
    Points<3, double> nodes = Points<3, double>::Zero(3, flat.n_nodes());
    nodes.topRows<2>() = flat.nodes;
    auto network = test::network_at_rest<3, double>(nodes, edges(flat));
    Random random(7);
    for (Index e = 0; e < network.n_springs(); ++e) {
        network.stiffness(e) = random(0.5, 2.);
    }
    std::vector<int> rim;
    for (int i = 0; i < network.n_nodes(); ++i) {
        if (nodes(0, i) < 1e-9 || nodes(0, i) > 1 - 1e-9 || nodes(1, i) < 1e-9 || nodes(1, i) > 0.8 - 1e-9) {
            rim.push_back(i);
        }
    }
    REQUIRE(rim.size() < static_cast<std::size_t>(network.n_nodes()));
    std::vector<Motion<3, double>> cases;
    for (int c = 0; c < 12; ++c) {
        Scenario<3, double> scenario;
        scenario.clamps.push_back({rim, [](const Vector<3, double>& rest, double) { return 1.04 * rest; }});
        scenario.initial_positions = 1.04 * nodes;
        NodalLoad<3, double> load;
        for (int i = 0; i < network.n_nodes(); ++i) {
            load.nodes.push_back(i);
        }
        load.forces = random.points<3, double>(network.n_nodes(), 0.02);
        scenario.loads.push_back(load);
        const auto balance = equilibrium(network, scenario);
        REQUIRE(balance.stable);
        Motion<3, double> motion;
        motion.name = text("case ", c);
        motion.rest_positions = nodes;
        motion.clamped = rim;
        motion.times = {0.};
        motion.positions = {balance.positions};
        motion.velocities = {Points<3, double>::Zero(3, network.n_nodes())};
        motion.accelerations = motion.velocities;
        motion.external_forces = {load.forces};
        cases.push_back(std::move(motion));
    }
    const auto prior = disturbed(network, 0.5, 4);
    TrajectoryOptions options;
    options.prior_weight = 1e-12;
    const TrajectoryProblem<3> problem(prior, cases, options);
    const auto report = gauss_newton(problem, {.max_iterations = 60, .tolerance = 1e-8});
    CHECK(usable(report.status));
    CHECK(report.misfit < 1e-4 * report.misfit_start);
    auto fitted = prior;
    apply(problem, report, fitted);
    for (Index e = 0; e < network.n_springs(); ++e) {
        CAPTURE(e);
        if (report.data_share(e) > 0.5) {
            CHECK(test::relative(fitted.stiffness(e), network.stiffness(e), network.stiffness(e)) < 1e-2);
        }
    }
    CHECK(report.n_set_by_data() > network.n_springs() / 2);
}

TEST_CASE_TEMPLATE("a horizon of one short step is the acceleration fit", T, Dimension<2>, Dimension<3>) {
    constexpr int Dim = T::value;
    const Fixture<Dim> fixture(false);
    double last = 1;
    for (const double dt : {0.02, 0.005}) {
        // Forty windows of one step, one after another in one motion, and their first frames with the acceleration that
        // each window shows.
        Motion<Dim, double> windows;
        Motion<Dim, double> starts;
        Random random(8);
        for (unsigned seed = 1; seed <= 40; ++seed) {
            auto motion = fixture.swing(2, dt, seed);
            const auto unknown = random.points<Dim, double>(motion.n_nodes(), 0.004); // forces springs cannot explain
            for (std::size_t t = 0; t < 2; ++t) {
                motion.external_forces[t] += unknown;
                motion.times[t] += 2 * dt * (seed - 1);
            }
            for (int node : fixture.clamped) {
                motion.velocities[0].col(node) = (motion.positions[1].col(node) - motion.positions[0].col(node)) / dt;
            }
            motion.accelerations[0] =
                2 / (dt * dt) * (motion.positions[1] - motion.positions[0] - dt * motion.velocities[0]);
            const auto append = [&](Motion<Dim, double>& to, std::size_t frames) {
                const auto extend = [&](auto& own, const auto& more) {
                    own.insert(own.end(), more.begin(), more.begin() + static_cast<std::ptrdiff_t>(frames));
                };
                to.rest_positions = motion.rest_positions;
                to.clamped = motion.clamped;
                extend(to.times, motion.times);
                extend(to.positions, motion.positions);
                extend(to.velocities, motion.velocities);
                extend(to.accelerations, motion.accelerations);
                extend(to.external_forces, motion.external_forces);
            };
            append(windows, 2);
            append(starts, 1);
        }
        auto prior = disturbed(fixture.network, 0.2, 7);
        prior.damping = fixture.network.damping;
        TrajectoryOptions options;
        options.prior_weight = 0;
        options.horizon = 1;
        options.window_stride = 2;
        const TrajectoryProblem<Dim> problem(prior, std::vector{windows}, options);
        CHECK(problem.n_windows() == 40);
        GaussNewtonOptions engine;
        engine.tolerance = 1e-12;
        engine.max_iterations = 200;
        engine.max_cg_iterations = 300;
        engine.cg_tolerance = 1e-6;
        const auto report = gauss_newton(problem, engine);
        auto network = prior;
        apply(problem, report, network);

        AccelerationOptions<double> accelerations;
        accelerations.parameters.stiffness.lower = 1e-3;
        const AccelerationProblem quadratic = acceleration_problem<Dim, double>(prior, {starts}, accelerations);
        DominantTermOptions sweeps;
        sweeps.max_sweeps = 20000;
        sweeps.tolerance = 1e-14;
        auto other = prior;
        apply(quadratic, dominant_term(quadratic, sweeps), other);
        double distance = 0;
        for (Index e = 0; e < network.n_springs(); ++e) {
            if (report.data_share(e) > 0) {
                distance = std::max(distance, test::relative(network.stiffness(e), other.stiffness(e), 1.));
            }
        }
        CAPTURE(dt);
        CHECK(distance < last / 2);
        last = distance;
    }
    CHECK(last < 0.05);
}

TEST_CASE("small gains end a search only where they do not grow") {
    detail::SmallGains gains(0.01);
    const auto add = [&](double gain) {
        gains.add(gain, 1.);
        return gains.enough();
    };
    CHECK_FALSE(add(0.5));
    CHECK_FALSE(add(0.004)); // the first step after one that was stepped back from
    CHECK_FALSE(add(0.008)); // less damped
    CHECK_FALSE(add(0.02));
    CHECK_FALSE(add(0.005));
    CHECK_FALSE(add(0.02));
    CHECK_FALSE(add(0.005));
    CHECK(add(0.005));
}

TEST_CASE("the largest entry of a gradient that is not a number is none") {
    Values<double> gradient(3);
    gradient << 3, std::nan(""), -2;
    CHECK(std::isnan(detail::largest_projected(gradient, {false, false, false})));
    CHECK(detail::largest_projected(gradient, {false, true, false}) == 3);
}

TEST_CASE("values are given to networks of the size that was fitted alone") {
    const Fixture<2> fixture(true);
    const TrajectoryProblem<2> problem(fixture.network, std::vector{fixture.static_case(0.1, 1)});
    TrajectoryReport report;
    report.theta = Values<double>::Zero(problem.n_unknowns());
    auto network = fixture.network;
    CHECK_NOTHROW(apply(problem, report, network));
    const auto refused = [&](const SpringNetwork<2, double>& other) {
        auto changed = other;
        CHECK_THROWS_AS(apply(problem, report, changed), InvalidArgument);
        CHECK(changed.stiffness == other.stiffness);
    };
    auto other = network;
    other.springs.conservativeResize(2, network.n_springs() - 1);
    other.stiffness.conservativeResize(network.n_springs() - 1);
    refused(other);
    other = network;
    other.cells.resize(3, 0);
    refused(other);
    other = network;
    other.rest_positions.conservativeResize(2, network.n_nodes() + 1);
    refused(other);
    report.theta.resize(1);
    CHECK_THROWS_AS(apply(problem, report, network), InvalidArgument);
}
