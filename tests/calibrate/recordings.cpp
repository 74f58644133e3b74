// SPDX-License-Identifier: BSD-3-Clause
#include "cases/specimens.hpp"
#include "tolerance.hpp"

#include <springfit/springfit.hpp>

using namespace springfit;

namespace {

/// The motion of a network, damped by 5 % of critical, under a weight over two of its slowest periods: it grows over
/// half of one, or is there at once.
template <int Dim>
Motion<Dim, double> falling(SpringNetwork<Dim, double> network, double aside, bool at_once = false) {
    Scenario<Dim, double> scenario;
    scenario.clamps = {{test::small_specimen<Dim>().clamps.front().nodes, {}}};
    const double omega = lowest_frequency(network, scenario.clamps.front().nodes).omega;
    const double period = 2 * std::numbers::pi / omega;
    Vector<Dim, double> g = Vector<Dim, double>::Constant(-0.5);
    g(0) = aside;
    scenario.gravity.push_back({g, at_once ? Amplitude<double>{} : ramp_and_release(period / 2, period)});
    network.damping = stiffness_proportional_damping(network, 2 * 0.05 / omega);
    return record(network, scenario, {.dt = period / 40, .frames = 80}).motion;
}

CalibrateOptions matching() {
    CalibrateOptions options;
    options.method = Method::trajectory;
    options.matching_iterations = 12;
    return options;
}

bool warns(const std::vector<Warning>& warnings, WarningCode code) {
    return std::any_of(warnings.begin(), warnings.end(), [&](const auto& warning) { return warning.code == code; });
}

/// The same body in other units.
template <class AnyMesh>
AnyMesh scaled(AnyMesh mesh, double factor) {
    mesh.nodes *= factor;
    return mesh;
}

} // namespace

TEST_CASE_TEMPLATE("noise is told from the model's error, and does not spoil the fit", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto truth = test::hidden_network<dim>();
    const double level = 0.01;
    std::vector<Motion<dim, double>> recorded;
    for (const double aside : {1., 0.2, -0.6}) {
        recorded.push_back(with_noise(falling(truth, aside), level, static_cast<unsigned>(10 * aside + 7)));
    }
    const auto cases = split_motions<dim, double>(recorded);
    CHECK(warns(cases.warnings, WarningCode::noisy_recording));
    REQUIRE(cases.held_out.size() == 1);
    CHECK(cases.held_out.motions.front().positions == recorded.back().positions); // as it was recorded
    CHECK(cases.training.motions.front().positions != recorded.front().positions);
    const auto result = calibrate(test::even(truth), cases, matching());
    const auto& scores = result.best().held_out;
    CHECK(scores.noise > 0.85 * level);
    CHECK(scores.noise < 1.15 * level);
    CHECK(scores.beside_noise() < 0.03);
    CHECK(test::relative(scores.beside_noise() * scores.beside_noise() + scores.noise * scores.noise,
                         scores.error * scores.error, scores.error * scores.error) < 1e-9);
    CHECK(result.verdict == Verdict::good);
}

TEST_CASE_TEMPLATE("what was not seen has no weight", T, test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto truth = test::hidden_network<dim>();
    std::vector<Motion<dim, double>> recorded;
    for (const double aside : {1., 0.2, -0.6}) {
        auto motion = falling(truth, aside);
        motion.unobserved.resize(motion.times.size());
        for (std::size_t t = 20; t < 50; ++t) { // filled in with nonsense where nothing starts
            const int node = static_cast<int>(motion.n_nodes()) - 1;
            motion.unobserved[t] = {node};
            if (t % 12 != 0) {
                motion.positions[t].col(node).array() += 0.3;
            }
        }
        recorded.push_back(std::move(motion));
    }
    auto cases = split_motions<dim, double>(recorded);
    const auto result = calibrate(test::even(truth), cases, matching());
    CHECK(result.verdict == Verdict::good);
    CHECK(result.best().held_out.error < 0.02);
    // Equilibria, too.
    std::vector<Motion<dim, double>> still;
    for (const auto& motion : recorded) {
        Scenario<dim, double> scenario;
        scenario.clamps = {{motion.clamped, {}}};
        scenario.gravity.push_back({Vector<dim, double>::Constant(0.1 * (1. + static_cast<double>(still.size()))), {}});
        still.push_back(record_statics(truth, {scenario}).front().motion);
        still.back().unobserved = {{static_cast<int>(motion.n_nodes()) - 1}};
        still.back().positions.front().col(motion.n_nodes() - 1).array() += 0.3;
    }
    const auto balanced = calibrate(test::even(truth), split_motions<dim, double>(still), matching());
    CHECK(balanced.best().held_out.error < 0.02);
}

TEST_CASE_TEMPLATE("the same network whatever the units", T, test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    BodyOptions<dim> body{.density = 1000, .clamped = test::small_specimen<dim>().clamps.front().nodes};
    body.record.training_motions = 2;
    body.record.held_out_motions = 2;
    body.record.frames = 16;
    body.record.training_equilibria = 18;
    body.how.matching_iterations = 4;
    const auto of = [&](double length, double modulus, double density) {
        auto mine = body;
        mine.density = 1000 * density;
        return calibrate(scaled(test::small_box<dim>(), length),
                         fem::NeoHookean{.young = 1e4 * modulus, .poisson = 0.3}, mine);
    };
    const auto one = of(1, 1, 1);
    for (const auto& [length, modulus, density] :
         {std::array{1e-9, 1., 1.}, std::array{1e9, 1., 1.}, std::array{1e-3, 1e9, 1.}, std::array{1., 1e-9, 1e9}}) {
        CAPTURE(length);
        CAPTURE(modulus);
        const auto other = of(length, modulus, density);
        CHECK(other.best().name == one.best().name);
        const Values<double> expected = one.best().network.stiffness * (modulus * std::pow(length, dim - 2));
        CHECK(test::relative_difference(other.best().network.stiffness, expected) < 1e-6);
        CHECK(test::relative(other.best().held_out.error, one.best().held_out.error, one.best().held_out.error) < 1e-4);
        const double time = length * std::sqrt(density / modulus);
        CHECK(test::relative(other.stable_step, one.stable_step * time, other.stable_step) < 1e-6);
        CHECK(test::relative(other.period, one.period * time, other.period) < 1e-6);
        CHECK(other.verdict == one.verdict);
    }
}

TEST_CASE("the damping of a recording may be told, and the time step's error is small beside the misfit") {
    const auto truth = test::hidden_network<2>();
    const std::vector<Motion<2, double>> recorded{falling(truth, 1), falling(truth, 0.2)};
    auto options = matching();
    options.damping_ratio = 0.07;
    const auto result = calibrate(test::even(truth), split_motions<2, double>(recorded), options);
    CHECK(result.damping_ratio > 0.04); // of the given network's period
    CHECK(result.damping_ratio < 0.1);
    CHECK(result.best().steps_per_frame >= 1);
    options.damping_ratio = 1;
    CHECK_THROWS_AS((void)calibrate(test::even(truth), split_motions<2, double>(recorded), options), InvalidArgument);
}

TEST_CASE_TEMPLATE("the damping of a recording is found with its stiffness, from where its decay says", T,
                   test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto truth = test::hidden_network<dim>();
    const double omega = lowest_frequency(truth, test::small_specimen<dim>().clamps.front().nodes).omega;
    const double beta = 2 * 0.05 / omega;
    for (const bool at_once : {false, true}) {
        CAPTURE(at_once);
        const std::vector<Motion<dim, double>> recorded{falling(truth, 1, at_once), falling(truth, 0.2, at_once),
                                                        falling(truth, -0.6, at_once)};
        if (!at_once) { // which excites motions that are not the principal one as well: a start all the same
            const auto principal = detail::principal_motion<dim>(recorded, truth.mass);
            CHECK(test::relative(principal.omega_squared, omega * omega, omega * omega) < 0.2);
            CHECK(principal.c / principal.omega_squared > beta / 3);
            CHECK(principal.c / principal.omega_squared < beta * 3);
        }
        auto options = matching();
        const auto result = calibrate(test::even(truth), split_motions<dim, double>(recorded), options);
        CHECK(test::relative(result.cases.stiffness_damping, beta, beta) < 0.05);
        CHECK(result.best().held_out.error < 0.02);
    }
}

TEST_CASE("times in another unit are remarked on, and refused where frames show nothing of the motion") {
    const auto truth = test::hidden_network<2>();
    CalibrateOptions options;
    options.method = Method::closed_form;
    const auto slower = [&](double factor) {
        std::vector<Motion<2, double>> recorded{falling(truth, 1), falling(truth, 0.2)};
        for (auto& motion : recorded) {
            for (double& time : motion.times) {
                time *= factor;
            }
        }
        return split_motions<2, double>(recorded);
    };
    CHECK(!warns(calibrate(truth, slower(1), options).warnings, WarningCode::other_unit));
    CHECK(warns(calibrate(truth, slower(60), options).warnings, WarningCode::other_unit));
    CHECK_THROWS_AS((void)calibrate(truth, slower(1000), options), InvalidArgument);
}
