// SPDX-License-Identifier: BSD-3-Clause
#include "threads.hpp"
#include "tolerance.hpp"

#include <numeric>

#include <springfit/body/spring_body.hpp>
#include <springfit/network/forces.hpp>
#include <springfit/simulate/stable_step.hpp>

#include "body/example.hpp"
#include "body/node_access.hpp"

using namespace springfit;

namespace {

template <int Dim, class Scalar>
struct Course {
    Points<Dim, Scalar> x, v;
};

template <int Dim, class Scalar>
Course<Dim, Scalar> start(const SpringNetwork<Dim, Scalar>& network) {
    const auto scenario = test::thrown<Dim, Scalar>(network);
    return {scenario.initial_positions, scenario.initial_velocities};
}

template <int Dim, class Scalar>
Points<Dim, Scalar> loads(const SpringNetwork<Dim, Scalar>& network) {
    Points<Dim, Scalar> forces(Dim, network.n_nodes());
    for (Index i = 0; i < forces.size(); ++i) {
        forces.data()[i] = std::sin(static_cast<Scalar>(i));
    }
    return forces;
}

/// The definition: v += h a, x += h v, clamped nodes as they go.
template <int Dim, class Scalar>
Course<Dim, Scalar> by_definition(const SpringNetwork<Dim, Scalar>& network, const std::vector<int>& clamped, Scalar h,
                                  int steps) {
    Course<Dim, Scalar> course = start(network);
    Points<Dim, Scalar> a;
    for (int s = 0; s < steps; ++s) {
        compute_accelerations<Dim, Scalar>(network, course.x, course.v, loads(network), a);
        for (int node : clamped) {
            a.col(node).setZero();
        }
        course.v += h * a;
        course.x += h * course.v;
    }
    return course;
}

template <int Dim, class Scalar>
Course<Dim, Scalar> by_body(const SpringNetwork<Dim, Scalar>& network, const std::vector<int>& clamped, Scalar h,
                            int steps, const Execution& execution = {}) {
    Course<Dim, Scalar> course = start(network);
    SpringBody<Dim, Scalar> body(network, execution);
    body.write(course.x, course.v);
    body.set_external_forces(loads(network));
    body.set_clamped(clamped);
    for (int s = 0; s < steps; ++s) {
        body.step(h);
    }
    body.read(course.x, course.v);
    return course;
}

/// Large enough for two domains.
template <int Dim, class Scalar>
SpringNetwork<Dim, Scalar> large_network() {
    return test::random_network_with_cells<Dim, Scalar>(Scalar(0.01), -10, 100, Dim == 2 ? 150 : 26);
}

} // namespace

TEST_CASE_TEMPLATE("a body takes the steps of the definition", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network_with_cells<dim, Scalar>(Scalar(0.01), -10, 100);
    const Scalar h = stable_step(network) / 4;
    const auto expected = by_definition<dim, Scalar>(network, {0, 3}, h, 20);
    const auto found = by_body<dim, Scalar>(network, {0, 3}, h, 20);
    CHECK((found.x - expected.x).cwiseAbs().maxCoeff() < test::rounding<Scalar>(200));
    CHECK((found.v - expected.v).cwiseAbs().maxCoeff() <
          test::rounding<Scalar>(200) * expected.v.cwiseAbs().maxCoeff() / h);
    CHECK((found.x - network.rest_positions).cwiseAbs().maxCoeff() > Scalar(0.01));
}

TEST_CASE_TEMPLATE("domains change neither the motion nor its bits", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = large_network<dim, Scalar>();
    REQUIRE(detail::PackedSprings<dim, Scalar>(network).domains().size() > 1);
    const Scalar h = stable_step(network) / 4;
    const auto expected = by_definition<dim, Scalar>(network, {5}, h, 3);
    const auto found = by_body<dim, Scalar>(network, {5}, h, 3);
    CHECK((found.x - expected.x).cwiseAbs().maxCoeff() < test::rounding<Scalar>(200));
    const auto again = by_body<dim, Scalar>(network, {5}, h, 3, test::backwards_on_threads());
    CHECK(again.x == found.x);
    CHECK(again.v == found.v);
}

TEST_CASE_TEMPLATE("numbers of nodes do not matter", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network<dim, Scalar>(Scalar(0.01), 4);
    std::vector<int> number(static_cast<std::size_t>(network.n_nodes()));
    std::iota(number.begin(), number.end(), 0);
    std::mt19937 random(4);
    std::shuffle(number.begin(), number.end(), random);
    auto renumbered = network;
    for (Index i = 0; i < network.n_nodes(); ++i) {
        renumbered.rest_positions.col(number[static_cast<std::size_t>(i)]) = network.rest_positions.col(i);
        renumbered.mass(number[static_cast<std::size_t>(i)]) = network.mass(i);
    }
    for (int& node : renumbered.springs.reshaped()) {
        node = number[static_cast<std::size_t>(node)];
    }
    const Scalar h = stable_step(network) / 4;
    SpringBody<dim, Scalar> body(network);
    SpringBody<dim, Scalar> other(renumbered);
    const auto a = start(network);
    const auto b = start(renumbered);
    body.write(a.x, a.v);
    other.write(b.x, b.v);
    for (int s = 0; s < 20; ++s) {
        body.step(h);
        other.step(h);
    }
    for (int i = 0; i < static_cast<int>(network.n_nodes()); ++i) {
        const int own = number[static_cast<std::size_t>(i)];
        CHECK((body.position(i) - other.position(own)).norm() < test::rounding<Scalar>(200));
    }
}

TEST_CASE_TEMPLATE("ends that meet pull with no force", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::two_masses<dim, Scalar>(Scalar(1e6), 1);
    SpringBody<dim, Scalar> body(network);
    const Points<dim, Scalar> zero = Points<dim, Scalar>::Zero(dim, 2);
    body.write(zero, zero);
    body.step(Scalar(0.01));
    CHECK(body.position(0) == zero.col(0));
    CHECK(body.position(1) == zero.col(1));
    CHECK(body.velocity(1) == zero.col(1));
}

TEST_CASE_TEMPLATE("joined nodes are near each other in the locality order", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    auto network = test::random_network<dim, Scalar>(0, 12);
    std::vector<int> number(static_cast<std::size_t>(network.n_nodes()));
    std::iota(number.begin(), number.end(), 0);
    std::mt19937 random(4);
    std::shuffle(number.begin(), number.end(), random);
    for (int& node : network.springs.reshaped()) {
        node = number[static_cast<std::size_t>(node)];
    }
    const auto order = locality_order(network.n_nodes(), network.springs);
    std::vector<int> place(order.size(), -1);
    for (std::size_t p = 0; p < order.size(); ++p) {
        place[static_cast<std::size_t>(order[p])] = static_cast<int>(p);
    }
    CHECK(std::find(place.begin(), place.end(), -1) == place.end()); // every node once
    int widest = 0;
    for (Index e = 0; e < network.n_springs(); ++e) {
        widest = std::max(widest, std::abs(place[static_cast<std::size_t>(network.springs(0, e))] -
                                           place[static_cast<std::size_t>(network.springs(1, e))]));
    }
    CHECK(widest < (dim == 2 ? 40 : 400)); // of 13 * 14 and 13^3 nodes
}

TEST_CASE_TEMPLATE("nodes are set and read one by one", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network_with_cells<dim, Scalar>(Scalar(0.01), -10, 100);
    const SpringBody<dim, Scalar> body(network);
    test::check_node_access(body, body, {0, 3}, stable_step(network) / 4);
}

TEST_CASE("wrong sizes and numbers are refused") {
    const auto network = test::random_network<2, double>(0);
    SpringBody<2, double> body(network);
    const Points<2, double> few = Points<2, double>::Zero(2, 3);
    CHECK_THROWS_AS(body.write(few, few), InvalidArgument);
    CHECK_THROWS_AS(body.set_external_forces(few), InvalidArgument);
    CHECK_THROWS_AS(body.set_clamped({-1}), InvalidArgument);
    auto broken = network;
    broken.mass(0) = -1;
    CHECK_THROWS_AS((SpringBody<2, double>(broken)), InvalidArgument);
}
