// SPDX-License-Identifier: BSD-3-Clause
#include "allocations.hpp"

#include "threads.hpp"
#include "tolerance.hpp"

#include <Eigen/Dense>

#include <springfit/body/implicit_body.hpp>
#include <springfit/network/forces.hpp>
#include <springfit/simulate/stable_step.hpp>

#include "body/example.hpp"
#include "body/node_access.hpp"

using namespace springfit;

namespace {

/// Stretched and sheared, and compressed along the last axis, so that springs of either sign of c_1 are there.
template <int Dim, class Scalar>
Points<Dim, Scalar> deformed(const SpringNetwork<Dim, Scalar>& network) {
    Points<Dim, Scalar> x = test::thrown<Dim, Scalar>(network).initial_positions;
    x.row(Dim - 1) *= Scalar(0.6);
    return x;
}

/// The assembled Hessian of the incremental potential, whole.
template <int Dim, class Scalar>
DenseMatrix<Scalar> assembled(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& x, Scalar h,
                              HessianForm curvature) {
    auto matrix = network_matrix(network, FreeNodes(network.n_nodes(), {}));
    matrix.set_zero();
    add_stiffness<Dim, Scalar>(network, x, curvature, matrix);
    add_damping<Dim, Scalar>(network, x, 1 / h, matrix);
    for (Index i = 0; i < network.n_nodes(); ++i) {
        matrix.add_diagonal(i, network.mass(i) / (h * h));
    }
    const DenseMatrix<Scalar> lower = DenseMatrix<Scalar>(matrix.matrix());
    return lower.template selfadjointView<Eigen::Lower>();
}

template <int Dim, class Scalar>
Points<Dim, Scalar> waves(Index n, Scalar size) {
    Points<Dim, Scalar> result(Dim, n);
    for (Index i = 0; i < result.size(); ++i) {
        result.data()[i] = size * std::sin(static_cast<Scalar>(3 * i + 1));
    }
    return result;
}

} // namespace

TEST_CASE_TEMPLATE("the product is that of the assembled Hessian, and the derivative of the forces", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network_with_cells<dim, Scalar>(Scalar(0.01), -50, 300);
    const auto x = deformed(network);
    const auto d = waves<dim, Scalar>(network.n_nodes(), Scalar(0.1));
    const Scalar h = Scalar(0.1);
    ImplicitBody<dim, Scalar, Scalar> body(network);
    for (const bool exact : {false, true}) {
        body.write(x, Points<dim, Scalar>::Zero(dim, x.cols()));
        const Points<dim, Scalar> found = body.apply_hessian(d, h, exact);
        const auto matrix =
            assembled<dim, Scalar>(network, x, h, exact ? HessianForm::exact : HessianForm::positive_semidefinite);
        const Values<Scalar> expected = matrix * d.reshaped();
        CHECK(test::relative_difference(found.reshaped(), expected) < test::rounding<Scalar>(200));
    }
    if constexpr (std::same_as<Scalar, double>) {
        auto undamped = network;
        undamped.damping.setZero();
        ImplicitBody<dim, double, double> elastic(undamped);
        elastic.write(x, Points<dim, double>::Zero(dim, x.cols()));
        const double step = 1e-6;
        Points<dim, double> change = Points<dim, double>::Zero(dim, x.cols());
        add_elastic_forces<dim, double>(undamped, x - step * d, change);
        change = -change;
        add_elastic_forces<dim, double>(undamped, x + step * d, change);
        change /= -2 * step;
        change += (d * undamped.mass.asDiagonal()) / (h * h);
        CHECK(test::relative_difference(elastic.apply_hessian(d, h, true), change) < 1e-7);
    }
}

TEST_CASE_TEMPLATE("one iteration is Newton's step from the predicted positions", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network_with_cells<dim, Scalar>(0, 0, 100);
    const auto thrown = test::thrown<dim, Scalar>(network);
    const auto loads = waves<dim, Scalar>(network.n_nodes(), Scalar(1));
    const Scalar h = Scalar(0.05);
    const Points<dim, Scalar> y = thrown.initial_positions + h * thrown.initial_velocities;
    Points<dim, Scalar> forces = loads;
    add_elastic_forces<dim, Scalar>(network, y, forces);
    const auto matrix = assembled<dim, Scalar>(network, y, h, HessianForm::positive_semidefinite);
    const Values<Scalar> change = matrix.ldlt().solve(Values<Scalar>(forces.reshaped()));

    ImplicitBody<dim, Scalar> body(network, {.linear_tolerance = Scalar(1e-6)});
    body.write(thrown.initial_positions, thrown.initial_velocities);
    body.set_external_forces(loads);
    const auto report = body.step(h);
    CHECK(report.status == Status::iteration_limit);
    CHECK(report.iterations == 1);
    CHECK(report.linear_iterations > 0);
    Points<dim, Scalar> x, v;
    body.read(x, v);
    const Points<dim, Scalar> found = x - y;
    CHECK(test::relative_difference(found.reshaped(), change) < Scalar(2e-5)); // linear solves in single precision
    CHECK(test::relative_difference(v, (x - thrown.initial_positions) / h) < test::rounding<Scalar>(1000));
}

TEST_CASE_TEMPLATE("many iterations reach balance in either precision of the linear solves, and keep momentum", T,
                   test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto network = test::random_network_with_cells<dim, double>(0.01, 0, 100);
    const auto thrown = test::thrown<dim, double>(network);
    const auto run = [&]<class Linear>(Linear) {
        ImplicitBody<dim, double, Linear> body(network, {.max_iterations = 50});
        body.write(thrown.initial_positions, thrown.initial_velocities);
        for (int s = 0; s < 10; ++s) {
            REQUIRE(body.step(0.1).status == Status::converged);
        }
        Points<dim, double> x, v;
        body.read(x, v);
        const Vector<dim, double> momentum = thrown.initial_velocities * network.mass;
        const Vector<dim, double> now = v * network.mass;
        CHECK((now - momentum).norm() < 1e-6 * momentum.norm());
        return x;
    };
    const auto single = run(1.f);
    const auto whole = run(1.);
    CHECK((single - whole).cwiseAbs().maxCoeff() < 1e-6);
    CHECK((single - thrown.initial_positions).norm() > 0.1);
}

TEST_CASE_TEMPLATE("domains change neither the implicit step nor its bits", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network_with_cells<dim, Scalar>(0, 10, 100, dim == 2 ? 150 : 26);
    REQUIRE(detail::PackedSprings<dim, Scalar>(network).domains().size() > 1);
    const auto thrown = test::thrown<dim, Scalar>(network, Scalar(0.01));
    const Scalar h = 5 * stable_step(network);
    Points<dim, Scalar> x[2], v[2];
    for (int run = 0; run < 2; ++run) {
        ImplicitBody<dim, Scalar> body(network, {.max_iterations = 30, .tolerance = Scalar(1e-6)},
                                       run == 0 ? Execution() : test::backwards_on_threads());
        body.write(thrown.initial_positions, thrown.initial_velocities);
        body.set_clamped({5});
        CHECK(body.step(h).status == Status::converged);
        body.read(x[run], v[run]);
    }
    CHECK(x[0] == x[1]);
    CHECK(v[0] == v[1]);
    CHECK(v[0].col(5) == thrown.initial_velocities.col(5));
    Points<dim, Scalar> a;
    compute_accelerations<dim, Scalar>(network, x[0], v[0], Points<dim, Scalar>::Zero(dim, x[0].cols()), a);
    Points<dim, Scalar> rate = (v[0] - thrown.initial_velocities) / h;
    a.col(5).setZero();
    rate.col(5).setZero();
    // Forces are known as well as positions, which round, times the stiffness at a node.
    Values<Scalar> stiffness = network.mass / (h * h);
    for (Index e = 0; e < network.n_springs(); ++e) {
        stiffness(network.springs(0, e)) += network.stiffness(e);
        stiffness(network.springs(1, e)) += network.stiffness(e);
    }
    const Scalar rounding = test::rounding<Scalar>(20) * stiffness.maxCoeff() * x[0].cwiseAbs().maxCoeff();
    const Points<dim, Scalar> forces = a * network.mass.asDiagonal();
    const Points<dim, Scalar> unbalanced = (rate - a) * network.mass.asDiagonal();
    CHECK(unbalanced.cwiseAbs().maxCoeff() < std::max(Scalar(1e-5) * forces.cwiseAbs().maxCoeff(), rounding));
}

TEST_CASE_TEMPLATE("an implicit step allocates nothing", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network_with_cells<dim, Scalar>(Scalar(0.01), -10, 100);
    ImplicitBody<dim, Scalar> body(network, {.max_iterations = 5});
    body.set_external_forces(Points<dim, Scalar>::Ones(dim, network.n_nodes()));
    const long before = test::n_allocations;
    Eigen::internal::set_is_malloc_allowed(false);
    for (int s = 0; s < 5; ++s) {
        (void)body.step(Scalar(0.05));
    }
    Eigen::internal::set_is_malloc_allowed(true);
    CHECK(test::n_allocations == before);
    CHECK(body.position(0) != network.rest_positions.col(0));
}

TEST_CASE_TEMPLATE("an implicit step that is not finite leaves the body as it was", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network<dim, Scalar>(0);
    ImplicitBody<dim, Scalar> body(network);
    Points<dim, Scalar> loads = Points<dim, Scalar>::Zero(dim, network.n_nodes());
    loads(0, 1) = std::numeric_limits<Scalar>::quiet_NaN();
    body.set_external_forces(loads);
    const Vector<dim, Scalar> velocity = Vector<dim, Scalar>::Ones();
    body.set_velocity(1, velocity);
    CHECK(body.step(Scalar(0.1)).status == Status::diverged);
    CHECK(body.position(1) == network.rest_positions.col(1));
    CHECK(body.velocity(1) == velocity);
}

TEST_CASE_TEMPLATE("nodes are set and read one by one", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network_with_cells<dim, Scalar>(Scalar(0.01), -10, 100);
    const ImplicitBody<dim, Scalar> body(network);
    test::check_node_access(body, body, {0, 3}, stable_step(network) / 4);
}

TEST_CASE("options, sizes and steps of an implicit body out of range are refused") {
    const auto network = test::random_network<2, double>(0);
    using Body = ImplicitBody<2, double>;
    CHECK_THROWS_AS(Body(network, {.max_iterations = 0}), InvalidArgument);
    CHECK_THROWS_AS(Body(network, {.linear_tolerance = 1}), InvalidArgument);
    CHECK_THROWS_AS(Body(network, {.max_linear_iterations = 0}), InvalidArgument);
    CHECK_THROWS_AS(Body(network, {.tolerance = std::nan("")}), InvalidArgument);
    Body body(network);
    const Points<2, double> few = Points<2, double>::Zero(2, 3);
    CHECK_THROWS_AS(body.write(few, few), InvalidArgument);
    CHECK_THROWS_AS(body.set_external_forces(few), InvalidArgument);
    CHECK_THROWS_AS(body.set_clamped({-1}), InvalidArgument);
    CHECK_THROWS_AS((void)body.step(0), InvalidArgument);
}
