// SPDX-License-Identifier: BSD-3-Clause
#include "allocations.hpp"

#include "tolerance.hpp"

#include <springfit/motion/record.hpp>
#include <springfit/simulate/symplectic_euler.hpp>

#include "body/example.hpp"

using namespace springfit;

static_assert(Stepper<SymplecticEuler<2, float>>);
static_assert(Stepper<SymplecticEuler<3, double>>);
static_assert(Reference<SpringNetwork<2, double>>);
static_assert(Reference<SpringNetwork<3, float>>);

namespace {

template <int Dim, class Scalar>
Scalar total_energy(const SpringNetwork<Dim, Scalar>& network, const State<Dim, Scalar>& state) {
    return elastic_energy<Dim, Scalar>(network, state.positions) +
           (state.velocities.colwise().squaredNorm() * network.mass).value() / 2;
}

/// The state at the end of `frames` steps of dt.
template <int Dim, class Scalar>
State<Dim, Scalar> run(const SpringNetwork<Dim, Scalar>& network, const Scenario<Dim, Scalar>& scenario, Scalar dt,
                       int frames, Scalar fraction) {
    SymplecticEuler<Dim, Scalar> stepper(network, {.step_fraction = fraction, .max_substeps = 1000000});
    auto state = stepper.start(scenario);
    for (int f = 0; f < frames; ++f) {
        REQUIRE(stepper.advance(state, scenario, dt) == Status::converged);
    }
    return state;
}

} // namespace

TEST_CASE_TEMPLATE("two masses swing with the frequency and the damping ratio of theory", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    for (const double damping : {0., 1., 3.}) {
        const auto network = test::two_masses<dim, double>(100, damping);
        const double inverse_mass = 4. / 3;
        const double omega = std::sqrt(100 * inverse_mass);
        const double zeta = damping * inverse_mass / (2 * omega);
        const double ringing = omega * std::sqrt(1 - zeta * zeta);
        Scenario<dim, double> scenario;
        scenario.initial_positions = network.rest_positions;
        scenario.initial_positions(0, 1) += 0.3;
        double error[2];
        for (int level = 0; level < 2; ++level) {
            SymplecticEuler<dim, double> stepper(network, {.step_fraction = level == 0 ? 0.02 : 0.01});
            auto state = stepper.start(scenario);
            error[level] = 0;
            for (int f = 1; f <= 40; ++f) {
                REQUIRE(stepper.advance(state, scenario, 0.05) == Status::converged);
                const double t = state.time;
                const double swing =
                    0.3 * std::exp(-zeta * omega * t) *
                    (std::cos(ringing * t) + zeta / std::sqrt(1 - zeta * zeta) * std::sin(ringing * t));
                error[level] =
                    std::max(error[level], std::abs(state.positions(0, 1) - state.positions(0, 0) - 1 - swing));
            }
        }
        CHECK(error[0] < 0.003);
        CHECK(error[1] < error[0] / (damping > 0 ? 1.8 : 3.5)); // first order in the damping, second order without
    }
}

TEST_CASE_TEMPLATE("momentum and angular momentum are kept, energy does not drift", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network<dim, Scalar>(0);
    const auto scenario = test::thrown<dim, Scalar>(network);
    SymplecticEuler<dim, Scalar> stepper(network);
    auto state = stepper.start(scenario);
    const auto momentum = [&](const State<dim, Scalar>& s) { return Vector<dim, Scalar>(s.velocities * network.mass); };
    const auto angular = [&](const State<dim, Scalar>& s) {
        const Eigen::Matrix<Scalar, dim, dim> tensor =
            s.positions * network.mass.asDiagonal() * s.velocities.transpose();
        return Eigen::Matrix<Scalar, dim, dim>(tensor - tensor.transpose());
    };
    const Vector<dim, Scalar> momentum_0 = momentum(state);
    const Eigen::Matrix<Scalar, dim, dim> angular_0 = angular(state);
    const Scalar energy_0 = total_energy<dim, Scalar>(network, state);
    Scalar early = 0;
    Scalar late = 0;
    const int frames = 400;
    for (int f = 0; f < frames; ++f) {
        REQUIRE(stepper.advance(state, scenario, Scalar(0.01)) == Status::converged);
        const Scalar energy = total_energy<dim, Scalar>(network, state) / energy_0;
        CHECK(std::abs(energy - 1) < Scalar(0.05));
        early += f < frames / 4 ? energy : 0;
        late += f >= frames - frames / 4 ? energy : 0;
    }
    CHECK(std::abs(late - early) / (frames / 4) < Scalar(0.005));
    CHECK((momentum(state) - momentum_0).norm() < test::rounding<Scalar>(2000) * momentum_0.norm());
    CHECK((angular(state) - angular_0).norm() < test::rounding<Scalar>(2000) * angular_0.norm());
}

TEST_CASE_TEMPLATE("frames are second order in the sub-step", T, test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto network = test::random_network<dim, double>(0);
    auto scenario = test::thrown<dim, double>(network, 0.05);
    scenario.clamps.push_back({{0, 1}, [](const Vector<dim, double>& rest, double t) {
                                   return Vector<dim, double>(rest + 0.1 * (1 - std::cos(3 * t)) *
                                                                         Vector<dim, double>::Ones());
                               }});
    scenario.gravity.push_back({Vector<dim, double>::Constant(-3), [](double t) { return std::sin(4 * t); }});
    const double step = 16 * stable_step(network) * 0.99;
    const auto exact = run<dim, double>(network, scenario, step, 2, 1. / 128);
    const auto coarse = run<dim, double>(network, scenario, step, 2, 0.25);
    const auto fine = run<dim, double>(network, scenario, step, 2, 0.125);
    const auto free = Eigen::seqN(2, network.n_nodes() - 2); // a clamped node's velocity is that of its last sub-step
    const auto error = [&](const Points<dim, double>& a, const Points<dim, double>& b) {
        return (a - b)(Eigen::all, free).norm();
    };
    const double ratio = error(coarse.positions, exact.positions) / error(fine.positions, exact.positions);
    const double speed_ratio = error(coarse.velocities, exact.velocities) / error(fine.velocities, exact.velocities);
    CHECK(ratio > 3);
    CHECK(ratio < 5);
    CHECK(speed_ratio > 3);
    CHECK(speed_ratio < 5);
}

TEST_CASE_TEMPLATE("recorded accelerations are the network's own, and clamps and loads act", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network<dim, Scalar>(Scalar(0.01));
    auto scenario = test::thrown<dim, Scalar>(network, Scalar(0.05));
    scenario.clamps.push_back({{2, 3}, {}});
    scenario.clamps.push_back({{0}, [](const Vector<dim, Scalar>& rest, Scalar t) {
                                   return Vector<dim, Scalar>(rest + t * t * Vector<dim, Scalar>::Unit(1));
                               }});
    scenario.gravity.push_back({Vector<dim, Scalar>::Unit(0) * Scalar(2), [](Scalar t) { return 1 + t; }});
    scenario.loads.push_back({{5, 6}, Points<dim, Scalar>::Constant(dim, 2, Scalar(0.3)), {}});
    const auto recording = record(network, scenario, {.dt = Scalar(0.01), .frames = 20});
    CHECK(recording.status == Status::converged);
    const auto& motion = recording.motion;
    CHECK_NOTHROW(validate(motion));
    CHECK(motion.clamped == std::vector<int>{0, 2, 3});
    for (std::size_t t = 0; t < motion.times.size(); ++t) {
        Points<dim, Scalar> accelerations;
        compute_accelerations<dim, Scalar>(network, motion.positions[t], motion.velocities[t],
                                           motion.external_forces[t], accelerations);
        for (Index i = 0; i < network.n_nodes(); ++i) {
            if (i == 2 || i == 3) {
                CHECK(motion.positions[t].col(i) == network.rest_positions.col(i));
                CHECK(motion.velocities[t].col(i).norm() == 0);
                CHECK(motion.accelerations[t].col(i).norm() == 0);
            } else if (i == 0) {
                const Scalar time = motion.times[t];
                const Vector<dim, Scalar> goal =
                    network.rest_positions.col(0) + time * time * Vector<dim, Scalar>::Unit(1);
                CHECK((motion.positions[t].col(0) - goal).norm() <= test::rounding<Scalar>(10));
                CHECK(std::abs(motion.velocities[t](1, 0) - 2 * time) < Scalar(0.02));
            } else {
                CHECK((accelerations.col(i) - motion.accelerations[t].col(i)).norm() <=
                      test::rounding<Scalar>(10000) * (1 + accelerations.col(i).norm()));
            }
        }
    }
}

TEST_CASE_TEMPLATE("a body without loads stays at rest, and motion does not depend on numbering", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network<dim, Scalar>(Scalar(0.001));
    const auto still = run<dim, Scalar>(network, {}, Scalar(0.1), 5, Scalar(0.5));
    CHECK((still.positions - network.rest_positions).norm() < test::rounding<Scalar>(1000));

    const int n = static_cast<int>(network.n_nodes());
    auto reversed = network;
    reversed.rest_positions = network.rest_positions.rowwise().reverse().eval();
    reversed.mass.reverseInPlace();
    reversed.springs = (n - 1 - network.springs.array()).matrix().eval();
    const auto scenario = test::thrown<dim, Scalar>(network);
    auto turned = scenario;
    turned.initial_positions = scenario.initial_positions.rowwise().reverse().eval();
    turned.initial_velocities = scenario.initial_velocities.rowwise().reverse().eval();
    const auto a = run<dim, Scalar>(network, scenario, Scalar(0.1), 5, Scalar(0.5));
    const auto b = run<dim, Scalar>(reversed, turned, Scalar(0.1), 5, Scalar(0.5));
    CHECK(test::relative_difference(b.positions.rowwise().reverse(), a.positions) < test::rounding<Scalar>(10000));
}

TEST_CASE("a motion that is not finite is undone, and a step too stiff is refused before it is tried") {
    const auto network = test::random_network<3, double>(0.01);
    SymplecticEuler<3, double> stepper(network);
    Scenario<3, double> scenario;
    scenario.initial_velocities = Points<3, double>::Random(3, network.n_nodes()) * 1e200;
    auto state = stepper.start(scenario);
    state.accelerations.setZero();
    const auto before = state;
    CHECK(stepper.advance(state, scenario, 0.1) == Status::diverged);
    CHECK(state.time == before.time);
    CHECK(state.positions == before.positions);
    CHECK(state.velocities == before.velocities);

    auto stiff = network;
    stiff.stiffness *= 1e12;
    SymplecticEuler<3, double> slow(stiff, {.max_substeps = 500});
    auto start = slow.start({});
    CHECK(slow.n_substeps(0.1) > 500);
    CHECK(slow.advance(start, {}, 0.1) == Status::iteration_limit);
    CHECK(start.time == 0);
    stiff.stiffness *= 1e100;
    CHECK((SymplecticEuler<3, double>(stiff).n_substeps(0.1)) == std::numeric_limits<int>::max());

    CHECK_THROWS_AS((SymplecticEuler<3, double>(network, {.step_fraction = 1})), InvalidArgument);
    CHECK_THROWS_AS((SymplecticEuler<3, double>(network, {.max_substeps = 0})), InvalidArgument);
    CHECK_THROWS_AS((void)stepper.advance(state, {}, std::nan("")), InvalidArgument);
}

TEST_CASE_TEMPLATE("with cells, energy and momentum are kept far from rest, also where the step has to shrink", T,
                   test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto network = test::random_network_with_cells<dim, double>(0, 200, 2000);
    const auto scenario = test::thrown<dim, double>(network, 0.3);
    CHECK(stable_step_at<dim, double>(network, scenario.initial_positions) < 0.9 * stable_step(network));
    SymplecticEuler<dim, double> stepper(network, {.step_fraction = 0.1, .max_substeps = 100000});
    auto state = stepper.start(scenario);
    const double energy = total_energy<dim, double>(network, state);
    const Vector<dim, double> momentum = state.velocities * network.mass;
    for (int f = 0; f < 50; ++f) {
        REQUIRE(stepper.advance(state, scenario, 0.05) == Status::converged);
        CHECK(test::relative(total_energy<dim, double>(network, state), energy, energy) < 0.01);
        const Vector<dim, double> now = state.velocities * network.mass;
        CHECK((now - momentum).norm() < 1e-9 * momentum.norm());
    }
}

TEST_CASE_TEMPLATE("the explicit step allocates nothing", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network_with_cells<dim, Scalar>(Scalar(0.01), -10, 100);
    SpringBody<dim, Scalar> body(network);
    body.set_external_forces(Points<dim, Scalar>::Ones(dim, network.n_nodes()));
    const long before = test::n_allocations;
    Eigen::internal::set_is_malloc_allowed(false);
    for (int s = 0; s < 10; ++s) {
        body.step(Scalar(0.001));
    }
    Eigen::internal::set_is_malloc_allowed(true);
    CHECK(test::n_allocations == before);
    CHECK(body.position(0) != network.rest_positions.col(0));
}
