// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/cases/strain.hpp>
#include <springfit/fem/statics.hpp>
#include <springfit/motion/record_static.hpp>
#include <springfit/network/builders.hpp>
#include <springfit/simulate/static_solver.hpp>

#include "specimens.hpp"

using namespace springfit;

namespace {

/// A straight chain of n pairs, 1 m each.
template <int Dim, class Scalar>
std::pair<NodePairs, Points<Dim, Scalar>> chain(int n) {
    NodePairs pairs(2, n);
    Points<Dim, Scalar> rest = Points<Dim, Scalar>::Zero(Dim, n + 1);
    for (int e = 0; e < n; ++e) {
        pairs.col(e) << e, e + 1;
        rest(0, e + 1) = static_cast<Scalar>(e + 1);
    }
    return {pairs, rest};
}

} // namespace

TEST_CASE_TEMPLATE("a uniform stretch strains all edges alike, a turn none", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto body = test::box_body<dim, Scalar>();
    NodePairs pairs(2, body.n_nodes() - 1);
    for (int e = 0; e < pairs.cols(); ++e) {
        pairs.col(e) << e + 1, e;
    }
    const auto& x = body.rest_positions;
    const auto stretched = edge_strain(pairs, x, Scalar(0.8) * x);
    for (const Scalar strain : {stretched.rms, stretched.max, stretched.percentile_95}) {
        CHECK(test::relative(strain, Scalar(0.2), Scalar(0.2)) < test::rounding<Scalar>());
    }
    Eigen::Matrix<Scalar, dim, dim> turn = Eigen::Matrix<Scalar, dim, dim>::Identity();
    turn.template topLeftCorner<2, 2>() = Eigen::Rotation2D<Scalar>(Scalar(2)).toRotationMatrix();
    CHECK(edge_strain(pairs, x, turn * x).max < test::rounding<Scalar>());
    // A small turn does not strain the linear measure, a linear displacement strains it in proportion.
    Points<dim, Scalar> spin = Points<dim, Scalar>::Zero(dim, x.cols());
    spin.row(0) = -x.row(1);
    spin.row(1) = x.row(0);
    CHECK(linear_edge_strain(pairs, x, spin).max < test::rounding<Scalar>());
    const auto linear = linear_edge_strain(pairs, x, Scalar(-7) * x);
    CHECK(test::relative(linear.rms, Scalar(7), Scalar(7)) < test::rounding<Scalar>());
}

TEST_CASE("summary of different strains") {
    const auto [pairs, rest] = chain<2, double>(40);
    Points<2, double> moved = rest;
    double sum = 0;
    for (int e = 0; e < 40; ++e) { // strains 1 %, -2 %, 3 %, ..., -40 %
        const double strain = (e % 2 == 0 ? 0.01 : -0.01) * (e + 1);
        moved(0, e + 1) = moved(0, e) + 1 + strain;
        sum += strain * strain;
    }
    for (const auto& found : {edge_strain(pairs, rest, moved), linear_edge_strain(pairs, rest, moved - rest)}) {
        CHECK(test::relative(found.rms, std::sqrt(sum / 40), 1.) < 1e-14);
        CHECK(test::relative(found.max, 0.4, 1.) < 1e-14);
        CHECK(test::relative(found.percentile_95, 0.38, 1.) < 1e-14); // two edges of forty are strained more
    }
    CHECK(edge_strain(NodePairs(2, 0), rest, moved).max == 0);
    const auto [one, ends] = chain<2, double>(1);
    CHECK(edge_strain(one, ends, 3 * ends).percentile_95 == 2);
    CHECK_THROWS_AS((void)edge_strain(pairs, rest, ends), InvalidArgument);
    CHECK_THROWS_AS((void)edge_strain(pairs, ends, ends), InvalidArgument);
    CHECK_THROWS_WITH_AS((void)edge_strain(one, Points<2, double>(0 * ends), ends),
                         "pairs: expected a positive rest length, found none at pair 0", InvalidArgument);
}

TEST_CASE_TEMPLATE("loads are scaled to the strain that is wanted", T, test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto mesh = [] {
        if constexpr (dim == 2) {
            return triangle_grid<double>({6, 3}, {2., 1.});
        } else {
            return tetrahedron_grid<double>({6, 3, 3}, {2., 1., 1.});
        }
    }();
    const fem::Model model{mesh, fem::LinearElastic{1e4, 0.3}, 1000.};
    const Specimen<dim, double> body{mesh.nodes, model.masses(), boundary_nodes(mesh), {}};
    const auto all = random_load_cases(body, {.training = 6, .clamps = 2});
    auto cases = scenarios_with(all, CaseRole::training);
    const auto unseen = scenarios_with(all, CaseRole::unseen_kind);
    cases.insert(cases.end(), unseen.begin(), unseen.end());
    const NodePairs pairs = edges(mesh);
    const auto respond = [&](const auto& scenarios) { return linear_responses(model, scenarios); };
    const auto plain = cases;
    const auto factors = scale_to_strain(cases, pairs, mesh.nodes, 0.1, respond);
    const auto responses = respond(cases);
    for (std::size_t c = 0; c < cases.size(); ++c) {
        CHECK(factors[c] > 0);
        CHECK(cases[c].loads[0].forces == factors[c] * plain[c].loads[0].forces);
        const auto strain = linear_edge_strain(pairs, mesh.nodes, responses[c]);
        CHECK(test::relative(std::max(strain.percentile_95, strain.max / 4), 0.1, 0.1) < 1e-6);
        // For a linear material the answer to all of the load is the linear one.
        const auto [motion, status] = record_static(model, cases[c]);
        CHECK(status == Status::converged);
        CHECK(test::relative_difference(motion.positions[0] - mesh.nodes, responses[c]) < 1e-6);
    }
    // Nothing to scale by: the loads stay.
    cases = {plain[0], plain[1]};
    CHECK(scale_to_strain(cases, pairs, mesh.nodes, 0.1, [&](const auto&) {
              return std::vector<Points<dim, double>>{Points<dim, double>(dim, 0),
                                                      Points<dim, double>::Ones(dim, mesh.n_nodes())};
          }) == std::vector<double>{0., 0.});
    CHECK(cases[0].loads[0].forces == plain[0].loads[0].forces);
    CHECK_THROWS_AS((void)scale_to_strain(cases, pairs, mesh.nodes, 0., respond), InvalidArgument);
    CHECK_THROWS_AS((void)scale_to_strain(cases, pairs, mesh.nodes, 0.1,
                                          [](const auto&) { return std::vector<Points<dim, double>>(); }),
                    InvalidArgument);
}

TEST_CASE("a flat sheet in space answers loads in its plane as the plane body does") {
    const auto plane = triangle_grid<double>({8, 4}, {2., 1.});
    const auto sheet = membrane(plane);
    const fem::LinearElastic material{1e4, 0.3};
    const fem::Model flat{plane, material, 1000., {.thickness = 0.1}};
    const fem::Model spatial{sheet, material, 1000., {.thickness = 0.1}};
    auto body = test::sheet_body<double>();
    body.masses = spatial.masses();
    auto cases = scenarios_with(random_load_cases(body, {.training = 6, .clamps = 2}), CaseRole::training);
    const auto factors = scale_to_strain(cases, edges(sheet), sheet.nodes, 0.02,
                                         [&](const auto& scenarios) { return linear_responses(spatial, scenarios); });
    const auto recordings = record_statics(spatial, cases);
    auto network = springs_along_edges(sheet, {.density = 1000., .thickness = 0.1});
    network.stiffness.setConstant(300);
    auto plane_network = springs_along_edges(plane, {.density = 1000., .thickness = 0.1});
    plane_network.stiffness = network.stiffness;
    for (std::size_t c = 0; c < cases.size(); ++c) {
        CHECK(factors[c] > 0);
        CHECK(recordings[c].status == Status::converged);
        Scenario<2, double> below;
        below.clamps = {{cases[c].clamps[0].nodes, {}}};
        below.loads = {{cases[c].loads[0].nodes, cases[c].loads[0].forces.topRows<2>(), {}}};
        const auto same = [](const Points<3, double>& found, const Points<2, double>& expected) {
            CHECK(found.row(2).norm() == 0);
            CHECK((found.topRows<2>() - expected).norm() < 1e-5 * expected.norm());
        };
        same(linear_responses(spatial, {cases[c]})[0], linear_responses(flat, {below})[0]);
        same(linear_responses(network, {cases[c]})[0], linear_responses(plane_network, {below})[0]);
        // Nothing holds it across its plane.
        cases[c].gravity = {{Vector<3, double>::UnitZ(), {}}};
        CHECK(linear_responses(spatial, {cases[c]})[0].cols() == 0);
        CHECK(linear_responses(network, {cases[c]})[0].cols() == 0);
    }
}
