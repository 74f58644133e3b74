// SPDX-License-Identifier: BSD-3-Clause
#include "braced.hpp"
#include "tolerance.hpp"

#include <springfit/closed_form/cubic_cell.hpp>
#include <springfit/closed_form/san_vicente.hpp>
#include <springfit/network/forces.hpp>

using namespace springfit;
using test::braced;
using test::Bracing;

namespace {

struct Tension {
    double modulus;
    double contraction;
};

/// Modulus and contraction of a lattice in small tension along an axis, from its energy in two uniform strains.
template <class Scalar>
Tension tension(const SpringNetwork<3, Scalar>& network, int axis, double volume) {
    const auto twice = [&](Scalar along, Scalar across) {
        Eigen::Matrix<Scalar, 3, 3> strain = across * Eigen::Matrix<Scalar, 3, 3>::Identity();
        strain(axis, axis) = along;
        return 2 * static_cast<double>(test::spring_energy<3, Scalar>(network, strain)) / volume;
    };
    const double c11 = twice(1, 0);
    const double lateral = twice(0, 1); // 2 (C11 + C12)
    const double c12 = (twice(1, 1) - c11 - lateral) / 4;
    const double contraction = 2 * c12 / lateral;
    return {c11 - 2 * c12 * contraction, contraction};
}

} // namespace

TEST_CASE_TEMPLATE("tension along the axes is exact in small strain, every uniform strain at nu = 1/4", Scalar, float,
                   double) {
    const auto mesh = hex_grid<Scalar>({3, 2, 2}, {Scalar(0.6), Scalar(0.4), Scalar(0.4)});
    const double volume = 0.6 * 0.4 * 0.4;
    const auto rounding = static_cast<double>(test::rounding<Scalar>());
    auto network = braced(mesh, Bracing::both);
    for (const double nu : {0., 0.1, 0.25, 0.4, 0.48}) {
        const auto form = san_vicente(mesh, network.springs, {.young = 100, .poisson = nu});
        CHECK(form.n_clamped == 0);
        CHECK(form.caveat == (nu == 0.25 ? "" : "exact in tension along the axes of the cubes alone"));
        apply(form, network);
        for (int axis = 0; axis < 3; ++axis) {
            const auto found = tension<Scalar>(network, axis, volume);
            CHECK(test::relative(found.modulus, 100., 100.) < 10 * rounding);
            CHECK(std::abs(found.contraction - nu) < rounding);
        }
    }
    apply(san_vicente(mesh, network.springs, {.young = 100, .poisson = 0.25}), network);
    for (int trial = 0; trial < 5; ++trial) {
        const auto strain = test::random_strain<3, Scalar>();
        const Scalar expected = Scalar(volume) * test::elastic_density<3, Scalar>(strain, 40, 40);
        CHECK(test::relative(test::spring_energy<3, Scalar>(network, strain), expected, expected) <
              test::rounding<Scalar>());
    }
    // With one kind of diagonals nu = 1/4 leaves no choice.
    for (const Bracing bracing : {Bracing::faces, Bracing::bodies}) {
        const auto springs = braced(mesh, bracing).springs;
        const IsotropicSolid solid{.young = 100, .poisson = 0.25};
        CHECK(test::relative_difference(san_vicente(mesh, springs, solid).stiffness,
                                        cubic_cell(mesh, springs, solid).stiffness) < test::rounding<Scalar>());
    }
}

TEST_CASE("the stresses of a stretched lattice are the derivatives of its energy") {
    const auto cube = hex_grid<double>({1, 1, 1}, {1., 1., 1.});
    auto network = braced(cube, Bracing::both);
    const double across = 0.83;
    const double along = 1.4;
    const double step = 1e-6;
    const auto energy = [&](double x, double y) {
        const Points<3, double> positions = Vector<3, double>(x, y, y).asDiagonal() * network.rest_positions;
        return elastic_energy<3, double>(network, positions);
    };
    const auto stress = detail::cube_stress(along, across);
    for (int kind = 0; kind < 3; ++kind) {
        for (Index e = 0; e < network.n_springs(); ++e) {
            const double length2 = network.rest_length(e) * network.rest_length(e);
            network.stiffness(e) = std::lround(length2) == kind + 1 ? 1 : 0;
        }
        CHECK(test::relative(stress(0, kind),
                             (energy(along + step, across) - energy(along - step, across)) / (2 * step), 1.) < 1e-8);
        CHECK(test::relative(stress(1, kind),
                             (energy(along, across + step) - energy(along, across - step)) / (4 * step), 1.) < 1e-8);
    }
    const auto rate = detail::cube_stress_rate(0.3);
    CHECK(test::relative_difference(detail::cube_stress(1 + 1e-7, 1 - 0.3e-7) / 1e-7, rate) < 1e-6);
}

TEST_CASE("the curves of a lattice give back its stiffness; curves that it cannot follow are told") {
    const auto mesh = hex_grid<double>({1, 1, 1}, {0.5, 0.5, 0.5});
    const auto springs = braced(mesh, Bracing::both).springs;
    const Vector<3, double> stiffness(30, 12, 25); // of a unit cube
    const auto contraction = [&](double strain) {  // where nothing pulls across, by bisection
        double low = 0;
        double high = 0.5;
        for (int halving = 0; halving < 60; ++halving) {
            const double middle = (low + high) / 2;
            const double across = (detail::cube_stress(1 + strain, 1 - middle) * stiffness)(1);
            (across > 0 ? low : high) = middle;
        }
        return low;
    };
    TensileCurves curves{.largest_strain = 0.4};
    curves.contraction = contraction;
    curves.stress = [&](double strain) {
        return (detail::cube_stress(1 + strain, 1 - contraction(strain)) * stiffness)(0);
    };
    const auto form = san_vicente(mesh, springs, {.young = 100, .poisson = 0.3}, curves);
    CHECK(form.caveat == "exact in tension along the axes of the cubes alone");
    for (Index e = 0; e < springs.cols(); ++e) {
        const double length = (mesh.nodes.col(springs(0, e)) - mesh.nodes.col(springs(1, e))).norm() / 0.5;
        const double expected = 0.5 * stiffness(std::lround(length * length) - 1);
        CHECK(test::relative(form.stiffness(e), expected, expected) < 1e-6);
    }
    const auto auxetic = san_vicente(mesh, springs, {.young = 100, .poisson = -0.3});
    CHECK(auxetic.caveat.substr(0, 6) == "misses");
    CHECK(auxetic.stiffness.minCoeff() >= 0);
    CHECK(auxetic.stiffness.maxCoeff() > 0);
}

TEST_CASE("what is no cube, has no braces or cannot be a curve is refused") {
    const IsotropicSolid solid{.young = 1, .poisson = 0.25};
    const auto box = hex_grid<double>({1, 1, 1}, {1., 1., 2.});
    CHECK_THROWS_WITH_AS((void)san_vicente(box, braced(box, Bracing::both).springs, solid),
                         "mesh: expected cubes (cubic_cell and baudet take boxes), found cell 0 with sides 1 1 2",
                         InvalidArgument);
    const auto cube = hex_grid<double>({1, 1, 1}, {1., 1., 1.});
    const auto springs = braced(cube, Bracing::both).springs;
    CHECK_THROWS_AS((void)san_vicente(cube, edges(cube), solid), InvalidArgument);
    const auto refused = [&](const TensileCurves& curves) {
        CHECK_THROWS_AS((void)san_vicente(cube, springs, solid, curves), InvalidArgument);
    };
    refused({.largest_strain = -1});
    refused({.stress = [](double strain) { return strain; }});
    refused({.largest_strain = 0.1, .stress = [](double) { return std::nan(""); }});
    refused({.largest_strain = 0.1, .contraction = [](double) { return 1.; }});
    refused({.largest_strain = 0.1, .samples = 0});
}
