// SPDX-License-Identifier: BSD-3-Clause
#include "matrices.hpp"
#include "tolerance.hpp"

#include <springfit/closed_form/cauchy_split.hpp>
#include <springfit/closed_form/van_gelder.hpp>
#include <springfit/mesh/structured.hpp>

using namespace springfit;

namespace {

template <int Dim>
auto jittered_mesh() {
    if constexpr (Dim == 2) {
        auto mesh = triangle_grid<double>({4, 3}, {0.4, 0.3});
        jitter(mesh, 0.25, 3);
        return mesh;
    } else {
        auto mesh = tetrahedron_grid<double>({2, 2, 2}, {0.4, 0.3, 0.3});
        jitter(mesh, 0.2, 3);
        return mesh;
    }
}

constexpr double young = 2e5;
constexpr double thickness = 0.01;

/// A material of plane stress, plane strain or space with given lambda / mu, and mu the same for all.
IsotropicSolid solid_of(int dim, bool plane_strain, double ratio) {
    const double poisson = dim == 2 && !plane_strain ? ratio / (ratio + 2) : ratio / (2 * (ratio + 1));
    return {.young = young * (1 + poisson), .poisson = poisson, .thickness = thickness, .plane_strain = plane_strain};
}

template <int Dim, class Cell>
DenseMatrix<double> split_stiffness(const Mesh<Dim, double, Cell>& mesh, const IsotropicSolid& solid) {
    auto network = springs_along_edges(mesh, {.volume = true});
    apply(cauchy_split(mesh, network.springs, solid, {.signed_volume = true}), network);
    return test::network_stiffness(network);
}

} // namespace

TEST_CASE_TEMPLATE("at the Poisson ratio of a Cauchy solid the split is Van Gelder's and leaves the cells nothing", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto shape = jittered_mesh<dim>();
    auto mesh = Mesh<dim, Scalar, std::conditional_t<dim == 2, Tri3, Tet4>>{};
    mesh.nodes = shape.nodes.template cast<Scalar>();
    mesh.cells = shape.cells;
    const auto network = springs_along_edges(mesh);
    const IsotropicSolid solid{.young = young, .poisson = dim == 2 ? 1. / 3 : 1. / 4, .thickness = thickness};
    const auto split = cauchy_split(mesh, network.springs, solid, {.signed_volume = true});
    const auto plain = van_gelder(mesh, network.springs, solid);
    CHECK(test::relative_difference(split.springs.stiffness, plain.stiffness) < test::rounding<Scalar>());
    const Scalar mu = static_cast<Scalar>(young * (dim == 2 ? thickness * 3 / 8 : 2. / 5));
    CHECK(split.volume_stiffness.size() == mesh.n_cells());
    CHECK(split.volume_stiffness.cwiseAbs().maxCoeff() < test::rounding<Scalar>() * mu);
    CHECK(split.springs.n_clamped == 0);
}

TEST_CASE_TEMPLATE("a uniform dilation has the energy of the finite elements, on any mesh of any material", T,
                   test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto mesh = jittered_mesh<dim>();
    const Values<double> dilation = mesh.nodes.reshaped();
    DenseMatrix<double> remainder;
    for (const bool plane_strain : {false, true}) {
        if (dim == 3 && plane_strain) {
            continue;
        }
        for (const double ratio : {0., 0.5, 1., 1.9, 50.}) {
            if (dim == 2 && !plane_strain && ratio > 2) {
                continue; // lambda_2 of plane stress is below 2 mu
            }
            const IsotropicSolid solid = solid_of(dim, plane_strain, ratio);
            const auto split = split_stiffness<dim>(mesh, solid);
            const auto elements = test::element_stiffness<dim>(mesh, solid);
            const double energy = dilation.dot(elements * dilation);
            CHECK(test::relative(dilation.dot(split * dilation), energy, energy) < 1e-12);
            // The rest is the error of the springs in the Cauchy part: the same for every lambda, and not small.
            const DenseMatrix<double> difference = split - elements;
            if (remainder.size() == 0) {
                remainder = difference;
                CHECK(difference.norm() > 0.01 * elements.norm());
            }
            CHECK((difference - remainder).norm() < 1e-12 * elements.norm());
        }
    }
}

TEST_CASE("equilateral triangles: springs and cells are the finite elements at every Poisson ratio") {
    const auto mesh = equilateral_triangles<double>(4, 4, 0.3);
    for (const double poisson : {-0.3, 0., 0.25, 1. / 3, 0.45, 0.499}) {
        for (const bool plane_strain : {false, true}) {
            const IsotropicSolid solid{
                .young = young, .poisson = poisson, .thickness = thickness, .plane_strain = plane_strain};
            CHECK(test::relative_difference(split_stiffness<2>(mesh, solid), test::element_stiffness<2>(mesh, solid)) <
                  1e-12);
        }
    }
}

TEST_CASE("in the mean over the orientations of a tetrahedron every uniform strain has the energy of the material") {
    auto mesh = jittered_mesh<3>();
    mesh.cells = mesh.cells.leftCols(1).eval();
    for (int a = 0; a < 4; ++a) {
        mesh.cells(a, 0) = a;
    }
    mesh.nodes = Points<3, double>{{0.1, 1.3, 0.4, 0.3}, {-0.2, 0.3, 0.9, 0.2}, {0.3, -0.1, 0.2, 1.1}};
    const IsotropicSolid solid{.young = young, .poisson = 0.4};
    const auto split = split_stiffness<3>(mesh, solid);
    const auto elements = test::element_stiffness<3>(mesh, solid);
    Eigen::Matrix3d strain;
    strain << 1, 0.3, 0.2, 0.3, -0.5, 0.7, 0.2, 0.7, 0.4;
    // The energy is a polynomial of degree 4 in the turn. One axis sent to the corners of an icosahedron, with five
    // turns about each, averages such a polynomial exactly.
    const double golden = (1 + std::sqrt(5.)) / 2;
    double mean = 0;
    int turns = 0;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double one : {-1., 1.}) {
            for (const double two : {-golden, golden}) {
                Eigen::Vector3d corner = Eigen::Vector3d::Zero();
                corner(axis) = one;
                corner((axis + 1) % 3) = two;
                corner.normalize();
                const auto to_corner =
                    Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d(0, 1, golden).normalized(), corner);
                for (int fifth = 0; fifth < 5; ++fifth) {
                    const Eigen::Matrix3d turn =
                        (Eigen::AngleAxisd(2 * EIGEN_PI * fifth / 5, corner) * to_corner).toRotationMatrix();
                    const Points<3, double> u = turn.transpose() * strain * turn * mesh.nodes;
                    const Values<double> x = u.reshaped();
                    mean += x.dot(split * x);
                    ++turns;
                }
            }
        }
    }
    mean /= turns;
    const Points<3, double> u = strain * mesh.nodes;
    const Values<double> x = u.reshaped();
    const double expected = x.dot(elements * x);
    CHECK(test::relative(mean, expected, expected) < 1e-12);
    CHECK(test::relative(x.dot(split * x), expected, expected) > 1e-3);
}

TEST_CASE("a negative volume stiffness is set to 0 unless asked for, and what it is exact for is said") {
    const auto mesh = jittered_mesh<3>();
    auto network = springs_along_edges(mesh, {.volume = true});
    const IsotropicSolid soft{.young = young, .poisson = 0.1};
    const double mu = young / 2.2;
    const double lambda = young * 0.1 / (1.1 * 0.8);
    const auto clamped = cauchy_split(mesh, network.springs, soft);
    CHECK(clamped.volume_stiffness.cwiseAbs().maxCoeff() == 0);
    CHECK(clamped.springs.caveat == "not exact where a negative volume stiffness was set to 0");
    const auto kept = cauchy_split(mesh, network.springs, soft, {.signed_volume = true});
    CHECK((kept.volume_stiffness.array() - (lambda - mu)).abs().maxCoeff() < 1e-12 * mu);
    CHECK(kept.springs.caveat == "exact for uniform dilation alone");
    CHECK(kept.springs.stiffness == clamped.springs.stiffness);

    const auto triangles = equilateral_triangles<double>(3, 3, 0.3);
    const auto plane = springs_along_edges(triangles);
    CHECK(cauchy_split(triangles, plane.springs, {.young = young, .poisson = 0.45}).springs.caveat.empty());
    CHECK_FALSE(cauchy_split(triangles, plane.springs, {.young = young, .poisson = 0.2}).springs.caveat.empty());

    apply(kept, network);
    CHECK(network.volume_stiffness == kept.volume_stiffness);
    auto springs_alone = springs_along_edges(mesh);
    CHECK_THROWS_AS(apply(kept, springs_alone), InvalidArgument);
    CHECK_THROWS_AS((void)cauchy_split(mesh, network.springs, {.young = -1, .poisson = 0.3}), InvalidArgument);
    CHECK_THROWS_AS((void)cauchy_split(mesh, network.springs, {.young = 1, .poisson = 0.5}), InvalidArgument);
    CHECK_THROWS_AS((void)cauchy_split(mesh, NodePairs(network.springs.leftCols(3)), soft), InvalidArgument);
}
