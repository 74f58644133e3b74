// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <string>

#include <springfit/mesh/structured.hpp>
#include <springfit/network/builders.hpp>
#include <springfit/network/damping.hpp>

using namespace springfit;

namespace {

template <class Call>
std::string refusal(const Call& call) {
    try {
        call();
    } catch (const InvalidArgument& error) {
        return error.what();
    }
    return "accepted";
}

NodePairs pairs_of(std::initializer_list<std::array<int, 2>> list) {
    NodePairs pairs(2, static_cast<Index>(list.size()));
    Index e = 0;
    for (const auto& pair : list) {
        pairs.col(e++) << pair[0], pair[1];
    }
    return pairs;
}

} // namespace

TEST_CASE_TEMPLATE("springs along edges are valid, at rest and as many as the mesh has edges", Scalar, float, double) {
    const auto check = [](const auto& mesh, const SpringOptions<Scalar>& options, Index expected) {
        const auto network = springs_along_edges(mesh, options);
        CHECK(network.n_springs() == expected);
        for (Index e = 0; e < network.n_springs(); ++e) {
            const Scalar length =
                (network.rest_positions.col(network.springs(0, e)) - network.rest_positions.col(network.springs(1, e)))
                    .norm();
            CHECK(network.rest_length(e) == length);
            CHECK(network.stiffness(e) == 0);
            CHECK(network.damping(e) == 0);
        }
        CHECK_NOTHROW(validate(network));
    };
    const auto triangles = triangle_grid<Scalar>({3, 2}, {Scalar(3), Scalar(2)});
    check(triangles, {}, edges(triangles).cols());
    check(triangles, {.second_ring = true}, edges(triangles).cols() + second_ring(triangles).cols());
    check(membrane(triangles), {.second_ring = true}, edges(triangles).cols() + second_ring(triangles).cols());
    const auto quads = quad_grid<Scalar>({3, 2}, {Scalar(3), Scalar(2)});
    check(quads, {.diagonals = true}, 17 + 12);
    const auto tets = tetrahedron_grid<Scalar>({2, 2, 1}, {Scalar(1), Scalar(1), Scalar(1)});
    check(tets, {.diagonals = true}, edges(tets).cols());
    const auto hexes = hex_grid<Scalar>({2, 1, 1}, {Scalar(2), Scalar(1), Scalar(1)});
    check(hexes, {.diagonals = true}, 20 + 11 * 2 + 2 * 4);
}

TEST_CASE("springs of a quadratic mesh join its corners alone, whatever their numbers") {
    const auto linear = tetrahedron_grid<double>({2, 1, 1}, {2., 1., 1.});
    auto mesh = quadratic(linear);
    const Index n = mesh.n_nodes();
    // Number the nodes backwards: the corners are then the last nodes, in reverse order.
    mesh.nodes = mesh.nodes.rowwise().reverse().eval();
    mesh.cells = (static_cast<int>(n) - 1 - mesh.cells.array()).matrix().eval();
    const auto network = springs_along_edges(mesh);
    const auto expected = springs_along_edges(linear);
    CHECK(network.n_nodes() == expected.n_nodes());
    CHECK(network.n_springs() == expected.n_springs());
    CHECK((network.rest_positions - expected.rest_positions.rowwise().reverse()).norm() == 0);
    CHECK((network.mass - expected.mass.reverse()).norm() < 1e-15);
    const SpringLookup lookup(network.springs);
    for (Index e = 0; e < expected.n_springs(); ++e) {
        const int last = static_cast<int>(network.n_nodes()) - 1;
        CHECK(lookup.find(last - expected.springs(0, e), last - expected.springs(1, e)) >= 0);
    }
    CHECK(corner_nodes(mesh).front() == n - linear.n_nodes());
}

TEST_CASE("springs that cannot be are refused by name") {
    Points<2, double> nodes(2, 4);
    nodes << 0, 1, 1, 0, 0, 0, 1, 0; // node 3 lies on node 0
    const auto build = [&](const NodePairs& pairs) {
        return refusal([&] { (void)springs_from_list<2, double>(nodes, pairs); });
    };
    CHECK(build(pairs_of({{0, 1}, {1, 2}})) == "accepted");
    CHECK(build(pairs_of({{0, 1}, {1, 2}, {1, 0}})) ==
          "springs: expected each pair of nodes once, found springs 0 and 2 both from 0 to 1");
    CHECK(build(pairs_of({{0, 1}, {2, 2}})) == "springs: expected two different ends, found spring 1 from 2 to 2");
    CHECK(build(pairs_of({{0, 3}})) ==
          "springs: expected a positive rest length, found spring 0 from 0 to 3 of length 0");
    CHECK(build(pairs_of({{0, 4}})) == "springs: expected node numbers in [0, 4), found spring 0 from 0 to 4");
    CHECK(build(pairs_of({{-1, 2}})) == "springs: expected node numbers in [0, 4), found spring 0 from -1 to 2");
    nodes(0, 1) = std::nan("");
    CHECK(build(pairs_of({{0, 1}})) != "accepted");
    nodes(0, 1) = 1;
    CHECK(refusal([&] { (void)springs_from_list<2, double>(nodes, pairs_of({{0, 1}}), Values<double>::Ones(3)); }) ==
          "mass: expected 4 values, one per node, found 3");
    const auto quads = quad_grid<double>({1, 1}, {1., 1.});
    CHECK(refusal([&] { (void)springs_along_edges(quads, {.second_ring = true}); }) ==
          "second_ring: expected triangles or tetrahedra, found quadrilateral");
    CHECK(refusal([&] { (void)springs_along_edges(quads, {.density = std::nan("")}); }) ==
          "density: expected a positive density, found nan");
    CHECK(refusal([&] { (void)springs_along_edges(quads, {.thickness = 0}); }) ==
          "thickness: expected a positive thickness, found 0");
}

TEST_CASE("a spring is found from either end") {
    const NodePairs pairs = pairs_of({{4, 1}, {0, 2}, {2, 4}});
    const SpringLookup lookup(pairs);
    CHECK(lookup.find(1, 4) == 0);
    CHECK(lookup.find(4, 1) == 0);
    CHECK(lookup.find(2, 0) == 1);
    CHECK(lookup.find(4, 2) == 2);
    CHECK(lookup.find(0, 1) == -1);
    CHECK(lookup.find(4, 7) == -1);
}

TEST_CASE_TEMPLATE("damping rules", Scalar, float, double) {
    Points<2, Scalar> nodes(2, 3);
    nodes << 0, 1, 2, 0, 0, 0;
    Values<Scalar> masses(3);
    masses << 1, 3, 5;
    auto network = springs_from_list<2, Scalar>(nodes, pairs_of({{0, 1}, {1, 2}}), masses);
    network.stiffness << 100, 50;
    const Values<Scalar> proportional = stiffness_proportional_damping(network, Scalar(0.25));
    CHECK(proportional(0) == 25);
    CHECK(proportional(1) == Scalar(12.5));
    const Values<Scalar> rule = mass_stiffness_damping(network, Scalar(0.5));
    CHECK(test::relative(rule(0), Scalar(20), Scalar(20)) < test::rounding<Scalar>());
    CHECK(test::relative(rule(1), Scalar(20), Scalar(20)) < test::rounding<Scalar>());
    CHECK_THROWS_AS((void)stiffness_proportional_damping(network, Scalar(-1)), InvalidArgument);
    CHECK_THROWS_AS((void)mass_stiffness_damping(network, std::numeric_limits<Scalar>::quiet_NaN()), InvalidArgument);
}
