// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <numbers>

#include <springfit/closed_form/van_gelder.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/network/builders.hpp>
#include <springfit/score/frequency.hpp>

using namespace springfit;

namespace {

constexpr double pi = std::numbers::pi;

/// Masses of 0.3 kg in a row of springs of 50 N/m, the first node clamped; every mass is also held across the row by
/// stiff springs to clamped nodes, which resist motion along it only in second order.
template <int Dim, class Scalar>
std::pair<SpringNetwork<Dim, Scalar>, std::vector<int>> row(int n) {
    std::vector<std::array<int, 2>> ends;
    std::vector<Vector<Dim, Scalar>> nodes;
    std::vector<int> clamped{0};
    for (int i = 0; i <= n; ++i) {
        nodes.push_back(Scalar(i) * Vector<Dim, Scalar>::Unit(0));
        if (i > 0) {
            ends.push_back({i - 1, i});
        }
    }
    for (int i = 1; i <= n; ++i) {
        for (int d = 1; d < Dim; ++d) {
            clamped.push_back(static_cast<int>(nodes.size()));
            ends.push_back({i, clamped.back()});
            nodes.push_back(nodes[static_cast<std::size_t>(i)] + Vector<Dim, Scalar>::Unit(d));
        }
    }
    SpringNetwork<Dim, Scalar> network;
    network.rest_positions.resize(Dim, static_cast<Index>(nodes.size()));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        network.rest_positions.col(static_cast<Index>(i)) = nodes[i];
    }
    const auto springs = static_cast<Index>(ends.size());
    network.springs.resize(2, springs);
    for (Index e = 0; e < springs; ++e) {
        network.springs.col(e) << ends[static_cast<std::size_t>(e)][0], ends[static_cast<std::size_t>(e)][1];
    }
    network.stiffness.setConstant(springs, 500);
    network.stiffness.head(n).setConstant(50);
    network.rest_length.setOnes(springs);
    network.damping.setZero(springs);
    network.mass.setConstant(network.n_nodes(), Scalar(0.3));
    return {network, clamped};
}

template <class Mesh>
std::vector<int> left_end(const Mesh& mesh) {
    std::vector<int> nodes;
    for (Index i = 0; i < mesh.n_nodes(); ++i) {
        if (mesh.nodes(0, i) < 1e-9) {
            nodes.push_back(static_cast<int>(i));
        }
    }
    return nodes;
}

} // namespace

TEST_CASE_TEMPLATE("a row of masses and springs swings along itself", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    for (const int n : {1, 2, 12}) {
        const auto [network, clamped] = row<dim, Scalar>(n);
        const auto found = lowest_frequency(network, clamped);
        CHECK(found.status == Status::converged);
        const double expected = 2 * std::sqrt(50 / 0.3) * std::sin(pi / (2. * (2 * n + 1)));
        CHECK(test::relative(static_cast<double>(found.omega), expected, expected) <
              static_cast<double>(test::rounding<Scalar>(2000)) + 1e-8);
        // Its amplitude at node i is sin(i pi / (2 n + 1)).
        for (int i = 0; i <= n; ++i) {
            const double amplitude = std::sin(i * pi / (2 * n + 1)) / std::sin(n * pi / (2 * n + 1));
            CHECK(std::abs(static_cast<double>(found.mode(0, i)) - amplitude) < 2e-3);
        }
        CHECK(found.mode.bottomRows(dim - 1).cwiseAbs().maxCoeff() < 1e-3);
        // A tenth of the stiffness swings sqrt(10) times as slowly.
        auto softer = network;
        softer.stiffness /= 10;
        CHECK(test::relative(lowest_frequency(softer, clamped).omega * std::sqrt(Scalar(10)), found.omega,
                             found.omega) < test::rounding<Scalar>(2000));
    }
}

TEST_CASE("a slender cantilever swings as Euler and Bernoulli say") {
    const double length = 10;
    const double young = 1e6;
    const double density = 100;
    const auto mesh = quadratic(triangle_grid<double>({20, 2}, {length, 0.25}));
    const fem::Model model{mesh, fem::NeoHookean{young, 0.}, density};
    const auto found = lowest_frequency(model, left_end(mesh));
    CHECK(found.status == Status::converged);
    const double inertia = std::pow(0.25, 3) / 12;
    const double expected =
        std::pow(1.8751040687, 2) * std::sqrt(young * inertia / (density * 0.25 * std::pow(length, 4)));
    CHECK(test::relative(found.omega, expected, expected) < 3e-3); // shear and rotary inertia slow it by a little
}

TEST_CASE("a long row has the frequency of a continuous bar") {
    const auto [network, clamped] = row<2, double>(100);
    const double continuous = pi / (2 * 100.5) * std::sqrt(50 / 0.3); // pi c / (2 L), half a mass beyond the last
    CHECK(test::relative(lowest_frequency(network, clamped).omega, continuous, continuous) < 1e-4);
}

TEST_CASE("springs that equal the finite elements swing as these do") {
    const auto mesh = equilateral_triangles<double>(8, 4, 0.1);
    const fem::Model model{mesh, fem::LinearElastic{1e4, 1. / 3}, 1000.};
    auto network = springs_along_edges(mesh, {.density = 1000.});
    network.stiffness = van_gelder(mesh, network.springs, {.young = 1e4, .poisson = 1. / 3}).stiffness;
    std::vector<int> clamped;
    for (Index i = 0; i < mesh.n_nodes(); ++i) {
        if (mesh.nodes(1, i) < 1e-9) {
            clamped.push_back(static_cast<int>(i));
        }
    }
    const auto springs = lowest_frequency(network, clamped);
    const auto elements = lowest_frequency(model, clamped);
    CHECK(springs.status == Status::converged);
    CHECK(elements.status == Status::converged);
    CHECK(test::relative(springs.omega, elements.omega, elements.omega) < 1e-7);
    CHECK((springs.mode - elements.mode).norm() < 1e-3 * elements.mode.norm());
}

TEST_CASE("a solid with the mean dilatation has a frequency, a body that nothing holds has none") {
    const auto mesh = tetrahedron_grid<double>({4, 2, 2}, {2., 1., 1.});
    const fem::Model plain{mesh, fem::NeoHookean{1e4, 0.45}, 1000.};
    const fem::Model mean{mesh, fem::NeoHookean{1e4, 0.45}, 1000., {.dilatation = fem::Dilatation::mean}};
    const auto locked = lowest_frequency(plain, left_end(mesh));
    const auto found = lowest_frequency(mean, left_end(mesh));
    CHECK(found.status == Status::converged);
    CHECK(found.omega > 0);
    CHECK(found.omega < locked.omega);
    // Rayleigh's quotient of the mode.
    const FreeNodes free(mesh.n_nodes(), left_end(mesh));
    auto stiffness = mean.make_stiffness(free);
    mean.assemble(mesh.nodes, stiffness);
    const Values<double> mode = free.gather<3, double>(found.mode);
    Values<double> forces(mode.size());
    stiffness.matrix().multiply(mode, forces);
    const double inertia = (found.mode.colwise().squaredNorm() * mean.masses()).value();
    CHECK(test::relative(std::sqrt(mode.dot(forces) / inertia), found.omega, found.omega) < 1e-6);

    CHECK(lowest_frequency(mean, {}).status == Status::failed);
    CHECK(lowest_frequency(mean, {3}).omega == 0);
    std::vector<int> all;
    for (int i = 0; i < mesh.n_nodes(); ++i) {
        all.push_back(i);
    }
    CHECK_THROWS_WITH_AS((void)lowest_frequency(mean, all), "clamped: expected nodes left to move, found none",
                         InvalidArgument);
    CHECK_THROWS_AS((void)lowest_frequency(mean, {1000}), InvalidArgument);
    CHECK_THROWS_AS((void)lowest_frequency(mean, {3}, {.tolerance = 0.}), InvalidArgument);
    CHECK_THROWS_AS((void)lowest_frequency(mean, {3}, {.max_iterations = 0}), InvalidArgument);
    CHECK(lowest_frequency(mean, left_end(mesh), {.tolerance = 1e-15, .max_iterations = 1}).status ==
          Status::iteration_limit);
}
