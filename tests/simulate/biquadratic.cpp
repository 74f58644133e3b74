// SPDX-License-Identifier: BSD-3-Clause
#include "../network/biquadratic_example.hpp"
#include "eigenvalues.hpp"
#include "tolerance.hpp"

#include <springfit/closed_form/delingette.hpp>
#include <springfit/fem/statics.hpp>
#include <springfit/motion/record.hpp>
#include <springfit/simulate/biquadratic_euler.hpp>
#include <springfit/simulate/equilibrium.hpp>

using namespace springfit;

static_assert(Stepper<BiquadraticEuler<2, float>>);
static_assert(Reference<BiquadraticNetwork<2, double>>);
static_assert(Reference<BiquadraticNetwork<3, float>>);

namespace {

constexpr double h = 0.1;

template <int Dim, class Scalar>
BiquadraticNetwork<Dim, Scalar> sheet(double nu = 0.4) {
    const auto mesh = test::triangles<Dim, Scalar>();
    auto network = biquadratic_network(mesh, {.density = Scalar(10), .thickness = Scalar(h)});
    apply(delingette(mesh, {.young = 100, .poisson = nu, .thickness = h}), network);
    return network;
}

/// Thrown and stretched, free in space.
template <int Dim, class Scalar>
Scenario<Dim, Scalar> thrown(const BiquadraticNetwork<Dim, Scalar>& network) {
    Scenario<Dim, Scalar> scenario;
    scenario.initial_positions = Scalar(1.1) * network.rest_positions;
    scenario.initial_velocities = Points<Dim, Scalar>::Zero(Dim, network.n_nodes());
    scenario.initial_velocities.row(0).setConstant(1);
    scenario.initial_velocities.row(1) = network.rest_positions.row(0);
    return scenario;
}

} // namespace

TEST_CASE_TEMPLATE("momentum and angular momentum are kept, energy does not drift", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = sheet<dim, Scalar>();
    const auto recording = record(network, thrown<dim, Scalar>(network), {.dt = Scalar(0.01), .frames = 300});
    REQUIRE(recording.status == Status::converged);
    const auto& motion = recording.motion;
    const auto momentum = [&](std::size_t f) { return Vector<dim, Scalar>(motion.velocities[f] * network.mass); };
    const auto spin = [&](std::size_t f) {
        const Eigen::Matrix<Scalar, dim, dim> tensor =
            motion.positions[f] * network.mass.asDiagonal() * motion.velocities[f].transpose();
        return Eigen::Matrix<Scalar, dim, dim>(tensor - tensor.transpose());
    };
    const auto energy = [&](std::size_t f) {
        return elastic_energy<dim, Scalar>(network, motion.positions[f]) +
               (motion.velocities[f].colwise().squaredNorm() * network.mass).value() / 2;
    };
    CHECK((momentum(299) - momentum(0)).norm() < test::rounding<Scalar>(2000) * momentum(0).norm());
    CHECK((spin(299) - spin(0)).norm() < test::rounding<Scalar>(20000) * spin(0).norm());
    for (std::size_t f = 0; f < 300; ++f) {
        CHECK(test::relative(energy(f), energy(0), energy(0)) < Scalar(0.01));
    }
}

TEST_CASE("frames are second order in the sub-step, accelerations the network's own, damping takes energy") {
    auto network = sheet<2, double>();
    auto scenario = thrown<2, double>(network);
    scenario.clamps = {{{0, 1, 2, 3}, {}}};
    scenario.gravity = {{{0., -5.}, [](double time) { return std::cos(time); }}};
    const double longest = 0.4 * stable_step_at(network, network.rest_positions); // one sub-step a frame
    const auto run = [&](int finer) {
        BiquadraticEuler<2, double> stepper(network, {.step_fraction = 0.9});
        return record_stepper(stepper, scenario, {.dt = longest / finer, .frames = 60 * finer + 1}).motion;
    };
    const Points<2, double> exact = run(40).positions.back();
    const auto coarse = run(1);
    const double ratio = (coarse.positions.back() - exact).norm() / (run(2).positions.back() - exact).norm();
    CHECK(ratio > 3.5);
    CHECK(ratio < 4.5);
    Points<2, double> own;
    compute_accelerations<2, double>(network, coarse.positions[5], coarse.velocities[5], coarse.external_forces[5],
                                     own);
    own.leftCols(4).setZero(); // clamped
    CHECK((own - coarse.accelerations[5]).norm() < 1e-12 * own.norm());
    CHECK((coarse.positions[5].leftCols(4) - network.rest_positions.leftCols(4)).norm() == 0);

    scenario.gravity.clear();
    network.damping = 0.2;
    const auto damped = record(network, scenario, {.dt = 0.02, .frames = 100}).motion;
    const auto energy = [&](std::size_t f) {
        return elastic_energy<2, double>(network, damped.positions[f]) +
               (damped.velocities[f].colwise().squaredNorm() * network.mass).value() / 2;
    };
    for (std::size_t f = 1; f < 100; ++f) {
        CHECK(energy(f) < energy(f - 1));
    }
    CHECK(energy(99) < 0.1 * energy(0));
}

TEST_CASE_TEMPLATE("the stable step is below the true limit and not far below it", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto network = sheet<dim, double>();
    for (const double stretch : {1., 1.3, 0.8}) {
        const Points<dim, double> x = test::moved<dim, double>(stretch * network.rest_positions, 0.03, 4);
        auto matrix = network_matrix(network, FreeNodes(network.n_nodes(), {}));
        add_stiffness<dim, double>(network, x, HessianForm::exact, matrix);
        DenseMatrix<double> k = matrix.matrix();
        k = DenseMatrix<double>(k.selfadjointView<Eigen::Lower>());
        for (Index i = 0; i < network.n_nodes(); ++i) {
            k.middleCols<dim>(dim * i) /= std::sqrt(network.mass(i));
            k.middleRows<dim>(dim * i) /= std::sqrt(network.mass(i));
        }
        const double largest = test::eigenvalues(k).maxCoeff();
        const double limit = 2 / std::sqrt(largest);
        const double bound = stable_step_at<dim, double>(network, x);
        CHECK(bound < limit);
        CHECK(bound > 0.3 * limit);
    }
}

TEST_CASE("steps that would be too many, and motions that blow up, are reported") {
    const auto network = sheet<2, double>();
    BiquadraticEuler<2, double> few(network, {.max_substeps = 3});
    auto state = few.start({});
    CHECK(few.advance(state, {}, 10.) == Status::iteration_limit);
    CHECK_THROWS_AS((BiquadraticEuler<2, double>(network, {.step_fraction = 1.})), InvalidArgument);
    CHECK_THROWS_AS((void)few.advance(state, {}, 0.), InvalidArgument);
    Scenario<2, double> burst;
    burst.initial_velocities = 1e160 * network.rest_positions;
    BiquadraticEuler<2, double> stepper(network);
    state = stepper.start(burst);
    const Points<2, double> before = state.positions;
    CHECK(stepper.advance(state, burst, 0.01) == Status::diverged);
    CHECK(state.positions == before);
}

TEST_CASE_TEMPLATE("the equilibrium is that of the St Venant-Kirchhoff finite elements", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto mesh = test::triangles<dim, double>();
    const auto network = sheet<dim, double>();
    const fem::Model model{mesh, fem::StVenantKirchhoff{.young = 100, .poisson = 0.4}, 10., {.thickness = h}};
    Scenario<dim, double> scenario;
    scenario.clamps = {{{0, 1, 2, 3}, {}}};
    if (dim == 3) { // a membrane needs its rim held
        scenario.clamps.push_back({{12, 13, 14, 15}, {}});
    }
    Vector<dim, double> pull = Vector<dim, double>::Constant(3);
    scenario.gravity = {{pull, {}}};
    const auto found = equilibrium(network, scenario);
    // A flat membrane does not resist the first push across it, so the finite elements start where the springs end.
    const auto fem = fem::equilibrium(model, scenario, 0., {.tolerance = 1e-11}, found.positions);
    REQUIRE(fem.status == Status::converged);
    CHECK(found.status == Status::converged);
    CHECK(found.stable);
    const double way = (fem.state.positions - mesh.nodes).cwiseAbs().maxCoeff();
    CHECK(way > 0.02);
    CHECK((found.positions - fem.state.positions).cwiseAbs().maxCoeff() < 1e-6 * way);

    auto free = scenario;
    free.clamps.clear();
    free.gravity.clear();
    CHECK_FALSE(equilibrium(network, free).stable);
    CHECK_THROWS_AS((void)equilibrium(network, scenario, {.tolerance = 0.}), InvalidArgument);
}
