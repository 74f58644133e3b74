// SPDX-License-Identifier: BSD-3-Clause
#include "bodies.hpp"
#include "solids.hpp"
#include "tolerance.hpp"

#include <numbers>

#include <springfit/fem/dynamics.hpp>
#include <springfit/motion/record.hpp>

using namespace springfit;
using fem::Dilatation;

namespace {

using SolidModel = fem::Model<3, double, Tet4, fem::NeoHookean>;
static_assert(Reference<SolidModel>);
static_assert(Reference<fem::Model<2, float, Tri6, fem::LinearElastic>>);
static_assert(Stepper<fem::Dynamics<3, float>>);

constexpr double pi = std::numbers::pi;

/// A short bar of soft rubber, its left end clamped where `clamped`.
struct Bar {
    Mesh<3, double, Tet4> mesh = test::grid<Tet4, 3>({6, 2, 2}, {1.5, 0.5, 0.5});
    fem::NeoHookean rubber{.young = 1e4, .poisson = 0.45};
    std::vector<int> left = test::nodes_where(mesh, [](const auto& x) { return x(0) < 1e-9; });

    [[nodiscard]] SolidModel model(double alpha = 0, double beta = 0) const {
        return {
            mesh, rubber, 1000., {.dilatation = Dilatation::mean, .mass_damping = alpha, .stiffness_damping = beta}};
    }
};

/// Largest part of M a = f_ext - f_int(x) - D v that is left over on free nodes, over the largest of its terms.
double imbalance(const SolidModel& model, const Motion<3, double>& motion) {
    double worst = 0;
    double scale = 0;
    const FreeNodes all(motion.n_nodes(), {});
    for (std::size_t t = 0; t < motion.times.size(); ++t) {
        const auto& x = motion.positions[t];
        const auto& v = motion.velocities[t];
        const auto stiffness = model.stiffness(x, all);
        Points<3, double> damping = model.options().mass_damping * v * model.masses().asDiagonal();
        const Values<double> stretched = stiffness.selfadjointView<Eigen::Lower>() * Values<double>(v.reshaped());
        damping.reshaped() += model.options().stiffness_damping * stretched;
        const Points<3, double> forces = motion.external_forces[t] - model.internal_forces(x) - damping;
        const Points<3, double> inertia = motion.accelerations[t] * model.masses().asDiagonal();
        for (Index i = 0; i < motion.n_nodes(); ++i) {
            if (!std::binary_search(motion.clamped.begin(), motion.clamped.end(), static_cast<int>(i))) {
                worst = std::max(worst, (inertia - forces).col(i).norm());
                scale = std::max(scale, forces.col(i).norm());
            }
        }
    }
    return worst / scale;
}

/// Times at which a recorded value falls through zero or rises through it.
template <class Value>
std::vector<double> crossings(const Motion<2, double>& motion, const Value& value) {
    std::vector<double> times;
    for (std::size_t t = 1; t < motion.times.size(); ++t) {
        const double before = value(motion.positions[t - 1]);
        const double after = value(motion.positions[t]);
        if (before * after < 0) {
            times.push_back(motion.times[t - 1] + (motion.times[t] - motion.times[t - 1]) * before / (before - after));
        }
    }
    return times;
}

} // namespace

TEST_CASE("recorded accelerations are in balance with the forces at their frame, damped or not") {
    const Bar bar;
    Scenario<3, double> scenario;
    scenario.clamps = {{bar.left, {}}};
    scenario.gravity = {{{0., 0., -9.81}, {}}};
    for (const auto& model : {bar.model(), bar.model(0.5, 2e-3)}) {
        const auto recording = record(model, scenario, {.dt = 0.01, .frames = 25});
        CHECK(recording.status == Status::converged);
        validate(recording.motion);
        CHECK(imbalance(model, recording.motion) < 1e-12);
        CHECK(recording.motion.positions.back().row(2).minCoeff() < -0.01);
    }
}

TEST_CASE("a free body keeps its momentum under any deformation") {
    const Bar bar;
    const auto model = bar.model();
    const double mass = 1000. * 1.5 * 0.5 * 0.5;
    CHECK(test::relative(model.masses().sum(), mass, mass) < 1e-12);
    Scenario<3, double> scenario;
    scenario.gravity = {{{0., 0., -2.}, {}}};
    scenario.initial_velocities = test::shaken<3, double>(Points<3, double>::Zero(3, bar.mesh.n_nodes()), 0.5, 8);
    const Vector<3, double> momentum = scenario.initial_velocities * model.masses();
    fem::Dynamics stepper{model, {.alpha = 0., .tolerance = 1e-10}};
    auto state = stepper.start(scenario);
    for (int k = 0; k < 40; ++k) {
        REQUIRE(stepper.advance(state, scenario, 0.01) == Status::converged);
    }
    const Vector<3, double> expected = momentum + mass * 0.4 * Vector<3, double>(0, 0, -2);
    CHECK((state.velocities * model.masses() - expected).norm() < 1e-9 * mass);
    CHECK((state.positions - bar.mesh.nodes).cwiseAbs().maxCoeff() > 0.1);
}

TEST_CASE("the trapezoidal rule keeps the energy of a linear body, HHT never adds to it") {
    const auto mesh = test::grid<Tri3, 2>({12, 3}, {4., 1.});
    const fem::Model model{mesh, fem::LinearElastic{.young = 1e4, .poisson = 0.3}, 1000.};
    Scenario<2, double> scenario;
    scenario.clamps = {{test::nodes_where(mesh, [](const auto& x) { return x(0) < 1e-9; }), {}}};
    scenario.initial_velocities = test::shaken<2, double>(Points<2, double>::Zero(2, mesh.n_nodes()), 0.3, 5);
    for (int node : scenario.clamps[0].nodes) {
        scenario.initial_velocities.col(node).setZero();
    }
    const auto energy = [&](const auto& state) {
        return model.energy(state.positions) + state.velocities.cwiseAbs2().colwise().sum().dot(model.masses()) / 2;
    };
    for (const double alpha : {0., -0.1}) {
        fem::Dynamics stepper{model, {.alpha = alpha, .tolerance = 1e-11}};
        auto state = stepper.start(scenario);
        const double start = energy(state);
        for (int k = 0; k < 200; ++k) {
            REQUIRE(stepper.advance(state, scenario, 0.05) == Status::converged);
        }
        if (alpha == 0) {
            CHECK(test::relative(energy(state), start, start) < 1e-8);
        } else {
            CHECK(energy(state) < 0.9 * start);
        }
    }
}

TEST_CASE("halving the step divides the error by four, for the trapezoidal rule and HHT") {
    const Bar bar;
    const auto model = bar.model(0.3, 1e-3);
    Scenario<3, double> scenario;
    scenario.clamps = {{bar.left, {}}};
    scenario.gravity = {{{1., 2., -5.}, [](double t) { return std::sin(3 * t); }}};
    for (const double alpha : {0., -0.1}) {
        const auto at_end = [&](int steps) {
            fem::Dynamics stepper{model, {.alpha = alpha, .tolerance = 1e-11}};
            auto state = stepper.start(scenario);
            for (int k = 0; k < steps; ++k) {
                CHECK(stepper.advance(state, scenario, 0.32 / steps) == Status::converged);
            }
            return state.positions;
        };
        const Points<3, double> fine = at_end(256);
        const double ratio = (at_end(32) - fine).norm() / (at_end(64) - fine).norm();
        CAPTURE(alpha);
        // D is that of the start of a step, which is of first order, but small here
        CHECK(ratio > 3.2);
        CHECK(ratio < 4.9);
    }
}

TEST_CASE("a bar rings at the frequency of its first axial mode, and Rayleigh damping fades it as it should") {
    const double length = 2;
    const double speed = std::sqrt(1e4 / 1000.);
    const double omega = pi * speed / (2 * length);
    const auto mesh = test::grid<Quad4, 2>({24, 2}, {length, 0.2});
    Scenario<2, double> scenario;
    scenario.clamps = {{test::nodes_where(mesh, [](const auto& x) { return x(0) < 1e-9; }), {}}};
    scenario.initial_positions = mesh.nodes;
    scenario.initial_positions.row(0).array() += 1e-3 * (pi / (2 * length) * mesh.nodes.row(0).array()).sin();
    const Index tip = test::node_at<2, Quad4>(mesh, {length, 0.1});
    const auto stretch = [&](const Points<2, double>& x) { return x(0, tip) - length; };
    const fem::LinearElastic material{.young = 1e4, .poisson = 0.};
    const double period = 2 * pi / omega;
    const RecordOptions<double> options{.dt = period / 80, .frames = 240};
    const auto motion = record(fem::Model{mesh, material, 1000.}, scenario, options).motion;
    const auto times = crossings(motion, stretch);
    REQUIRE(times.size() >= 5);
    CHECK(test::relative(2 * (times[4] - times[0]) / 4, period, period) < 0.003);

    const double ratio = 0.05; // zeta = (alpha / omega + beta omega) / 2
    for (const auto& damping : {std::array{2 * ratio * omega, 0.}, std::array{0., 2 * ratio / omega}}) {
        const fem::Model damped{mesh, material, 1000., {.mass_damping = damping[0], .stiffness_damping = damping[1]}};
        const auto fading = record(damped, scenario, options).motion;
        const double left = stretch(fading.positions[160]) / 1e-3; // two periods on
        const double expected = std::exp(-ratio * omega * fading.times[160]);
        CHECK(test::relative(left, expected, expected) < 0.03);
    }
}

TEST_CASE("a cantilever swings at Euler and Bernoulli's first frequency") {
    const double length = 4;
    const double height = 0.2;
    const auto mesh = test::grid<Tri6, 2>({16, 1}, {length, height});
    const fem::Model model{mesh, fem::Corotated{.young = 1e6, .poisson = 0.}, 1000.};
    Scenario<2, double> scenario;
    scenario.clamps = {{test::nodes_where(mesh, [](const auto& x) { return x(0) < 1e-9; }), {}}};
    scenario.gravity = {{{0., -1e-2}, {}}};
    // released from the shape under gravity, without gravity
    scenario.initial_positions = fem::equilibrium(model, scenario, 0., {.tolerance = 1e-9}).state.positions;
    scenario.gravity.clear();
    const double omega = std::pow(1.8751040687119611 / length, 2) * std::sqrt(1e6 * height * height / (12 * 1000.));
    const double period = 2 * pi / omega;
    const auto motion = record(model, scenario, {.dt = period / 60, .frames = 150}).motion;
    const Index tip = test::node_at<2, Tri6>(mesh, {length, height / 2});
    const auto times = crossings(motion, [&](const auto& x) { return x(1, tip) - mesh.nodes(1, tip); });
    REQUIRE(times.size() >= 4);
    CHECK(test::relative(2 * (times[3] - times[0]) / 3, period, period) < 0.02);
}

TEST_CASE("mass damping slows a free body as exp(-alpha t); turning it costs nothing by stiffness damping") {
    const Bar bar;
    Scenario<3, double> scenario;
    scenario.initial_velocities = Points<3, double>::Zero(3, bar.mesh.n_nodes());
    scenario.initial_velocities.row(1).setConstant(2);
    const auto slowed = record(bar.model(1.5), scenario, {.dt = 0.02, .frames = 51}).motion;
    CHECK(test::relative(slowed.velocities.back().row(1).mean(), 2 * std::exp(-1.5), 2.) < 1e-3);

    const Vector<3, double> centre(0.75, 0.25, 0.25);
    const Vector<3, double> spin(0, 0, 1);
    for (Index i = 0; i < bar.mesh.n_nodes(); ++i) {
        scenario.initial_velocities.col(i) = spin.cross(Vector<3, double>(bar.mesh.nodes.col(i) - centre));
    }
    const auto turned = record(bar.model(0, 0.01), scenario, {.dt = 0.02, .frames = 80}).motion;
    const auto spin_of = [&](std::size_t frame) {
        double sum = 0;
        const auto model = bar.model();
        for (Index i = 0; i < bar.mesh.n_nodes(); ++i) {
            const Vector<3, double> arm = turned.positions[frame].col(i) - centre;
            sum += model.masses()(i) * arm.cross(Vector<3, double>(turned.velocities[frame].col(i)))(2);
        }
        return sum;
    };
    CHECK(test::relative(spin_of(79), spin_of(0), spin_of(0)) < 0.02);
}

TEST_CASE("clamps that move carry their velocity and the body along") {
    const Bar bar;
    Scenario<3, double> scenario;
    scenario.clamps = {{bar.left, [](const Vector<3, double>& rest, double t) {
                            return Vector<3, double>(rest + Vector<3, double>(0, 0.2 * std::sin(4 * t), 0));
                        }}};
    const auto recording = record(bar.model(), scenario, {.dt = 0.01, .frames = 40});
    CHECK(recording.status == Status::converged);
    const auto& motion = recording.motion;
    for (std::size_t t = 1; t < motion.times.size(); ++t) {
        const double time = motion.times[t];
        const int node = bar.left[0];
        CHECK(std::abs(motion.positions[t](1, node) - bar.mesh.nodes(1, node) - 0.2 * std::sin(4 * time)) < 1e-12);
        CHECK(std::abs(motion.velocities[t](1, node) - 0.8 * std::cos(4 * time)) < 1e-3);
        CHECK(std::abs(motion.accelerations[t](1, node) + 3.2 * std::sin(4 * time)) < 1e-2);
    }
    CHECK(imbalance(bar.model(), motion) < 1e-12);
    // the scenario may be changed on the way: let go
    fem::Dynamics stepper{bar.model()};
    auto state = stepper.start(scenario);
    REQUIRE(stepper.advance(state, scenario, 0.01) == Status::converged);
    scenario.clamps.clear();
    REQUIRE(stepper.advance(state, scenario, 0.01) == Status::converged);
}

TEST_CASE("a step too large to be taken at once is halved, an impossible one leaves the state as it was") {
    const Bar bar;
    Scenario<3, double> scenario;
    scenario.clamps = {{bar.left, [](const Vector<3, double>& rest, double t) {
                            return Vector<3, double>(rest + Vector<3, double>(0.24 * t / 0.1, 0, 0));
                        }}};
    fem::Dynamics once{bar.model(), {.max_halvings = 0}};
    auto stuck = once.start(scenario);
    const auto before = stuck;
    CHECK(once.advance(stuck, scenario, 0.2) != Status::converged);
    CHECK(stuck.time == 0);
    CHECK(stuck.positions == before.positions);
    fem::Dynamics halving{bar.model(), {.max_halvings = 6}};
    auto state = halving.start(scenario);
    CHECK(halving.advance(state, scenario, 0.2) == Status::converged);
    CHECK(test::relative(state.time, 0.2, 0.2) < 1e-12);
}

TEST_CASE("in single precision a motion comes to the same") {
    const Bar bar;
    const auto run = [&]<class S>(const Mesh<3, S, Tet4>& mesh) {
        Scenario<3, S> scenario;
        scenario.clamps = {{bar.left, {}}};
        scenario.gravity = {{Vector<3, S>(0, 0, S(-9.81)), {}}};
        const fem::Model model{mesh, bar.rubber, 1000., {.dilatation = Dilatation::mean}};
        const auto recording = record(model, scenario, {.dt = S(0.01), .frames = 40});
        CHECK(recording.status == Status::converged);
        return Points<3, double>((recording.motion.positions.back() - mesh.nodes).template cast<double>());
    };
    Mesh<3, float, Tet4> single;
    single.nodes = bar.mesh.nodes.cast<float>();
    single.cells = bar.mesh.cells;
    const Points<3, double> exact = run(bar.mesh);
    CHECK((run(single) - exact).norm() < 1e-3 * exact.norm());
}

TEST_CASE("dynamics refuse what does not fit") {
    const Bar bar;
    CHECK_THROWS_AS((fem::Dynamics{bar.model(), {.alpha = 0.1}}), InvalidArgument);
    CHECK_THROWS_AS((fem::Dynamics{bar.model(), {.alpha = std::nan("")}}), InvalidArgument);
    fem::Dynamics stepper{bar.model()};
    Scenario<3, double> scenario;
    auto state = stepper.start(scenario);
    CHECK_THROWS_AS(stepper.advance(state, scenario, 0.), InvalidArgument);
    CHECK_THROWS_AS(stepper.advance(state, scenario, std::nan("")), InvalidArgument);
    scenario.clamps = {{{-1}, {}}};
    CHECK_THROWS_AS((void)stepper.start(scenario), InvalidArgument);
}
