// SPDX-License-Identifier: BSD-3-Clause
#include "eigenvalues.hpp"
#include "tolerance.hpp"

#include <numeric>
#include <random>

#include <springfit/mesh/structured.hpp>
#include <springfit/network/builders.hpp>
#include <springfit/network/forces.hpp>

using namespace springfit;

namespace {

template <int Dim, class Scalar>
SimplexCorners<Dim, Scalar> some_simplex() {
    SimplexCorners<Dim, double> corners;
    if constexpr (Dim == 2) {
        corners << 0.1, 1.3, 0.4, -0.2, 0.3, 0.9;
    } else {
        corners << 0.1, 1.3, 0.4, 0.3, -0.2, 0.3, 0.9, 0.2, 0.3, -0.1, 0.2, 1.1;
    }
    return corners.template cast<Scalar>();
}

template <int Dim, class Scalar>
auto jittered_mesh() {
    if constexpr (Dim == 2) {
        auto mesh = triangle_grid<Scalar>({2, 2}, {Scalar(1), Scalar(1)});
        jitter(mesh, Scalar(0.2), 1);
        return mesh;
    } else {
        auto mesh = tetrahedron_grid<Scalar>({1, 2, 1}, {Scalar(1), Scalar(2), Scalar(1)});
        jitter(mesh, Scalar(0.2), 1);
        return mesh;
    }
}

/// Springs and cells of both signs, and a state far from rest.
template <int Dim, class Scalar>
struct Example {
    SpringNetwork<Dim, Scalar> network = springs_along_edges(jittered_mesh<Dim, Scalar>(), {.volume = true});
    Points<Dim, Scalar> positions = network.rest_positions;
    Points<Dim, Scalar> velocities = network.rest_positions;

    Example() {
        std::mt19937 random(7);
        std::uniform_real_distribution<Scalar> unit(-1, 1);
        for (Index e = 0; e < network.n_springs(); ++e) {
            network.stiffness(e) = std::pow(Scalar(10), unit(random) / 2);
            network.damping(e) = (1 + unit(random)) / 4;
        }
        for (Index c = 0; c < network.n_cells(); ++c) {
            network.volume_stiffness(c) = 5 * unit(random);
            network.rest_volume(c) *= 1 + unit(random) / 10;
        }
        for (Index i = 0; i < network.n_nodes(); ++i) {
            for (int d = 0; d < Dim; ++d) {
                positions(d, i) += unit(random) / 10;
                velocities(d, i) = unit(random);
            }
        }
    }
};

template <int Dim, class Scalar>
Points<Dim, Scalar> elastic_forces(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& x) {
    Points<Dim, Scalar> forces = Points<Dim, Scalar>::Zero(Dim, network.n_nodes());
    add_elastic_forces<Dim, Scalar>(network, x, forces);
    return forces;
}

template <int Dim, class Scalar>
Points<Dim, Scalar> volume_forces(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& x) {
    Points<Dim, Scalar> forces = Points<Dim, Scalar>::Zero(Dim, network.n_nodes());
    add_volume_forces<Dim, Scalar>(network, x, forces);
    return forces;
}

template <int Dim>
DenseMatrix<double> hessian(const SpringNetwork<Dim, double>& network, const FreeNodes& free,
                            const Points<Dim, double>& x, HessianForm curvature) {
    auto matrix = network_matrix(network, free);
    add_stiffness<Dim, double>(network, x, curvature, matrix);
    const DenseMatrix<double> lower = matrix.matrix();
    return lower.template selfadjointView<Eigen::Lower>();
}

template <int Dim, class Scalar>
Eigen::Matrix<Scalar, Dim, Dim> some_rotation() {
    if constexpr (Dim == 2) {
        return Eigen::Rotation2D<Scalar>(Scalar(0.7)).toRotationMatrix();
    } else {
        return Eigen::AngleAxis<Scalar>(Scalar(0.7), Vector<3, Scalar>(1, -2, 3).normalized()).toRotationMatrix();
    }
}

} // namespace

TEST_CASE_TEMPLATE("the signed volume of a simplex and its derivatives", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    SimplexCorners<dim, Scalar> unit = SimplexCorners<dim, Scalar>::Zero();
    unit.template rightCols<dim>().setIdentity();
    CHECK(test::relative(signed_volume<dim, Scalar>(unit), Scalar(1) / (dim == 2 ? 2 : 6), Scalar(1)) <
          test::rounding<Scalar>(4));
    unit.col(1).swap(unit.col(2));
    CHECK(signed_volume<dim, Scalar>(unit) < 0);

    const auto x = some_simplex<dim, Scalar>();
    const auto gradient = volume_gradient<dim, Scalar>(x);
    const Scalar volume = signed_volume<dim, Scalar>(x);
    CHECK(gradient.rowwise().sum().norm() < test::rounding<Scalar>() * gradient.norm());
    // V is homogeneous of degree Dim, and a polynomial of degree 1 in each coordinate: differences are exact.
    CHECK(test::relative(gradient.cwiseProduct(x).sum(), dim * volume, volume) < test::rounding<Scalar>());
    const auto hessian = volume_hessian<dim, Scalar>(x);
    CHECK((hessian - hessian.transpose()).norm() == 0);
    const Scalar h = Scalar(0.125);
    for (int a = 0; a <= dim; ++a) {
        for (int d = 0; d < dim; ++d) {
            auto above = x;
            auto below = x;
            above(d, a) += h;
            below(d, a) -= h;
            const Scalar slope = (signed_volume<dim, Scalar>(above) - signed_volume<dim, Scalar>(below)) / (2 * h);
            CHECK(test::relative(slope, gradient(d, a), gradient.norm()) < test::rounding<Scalar>());
            const SimplexCorners<dim, Scalar> change =
                (volume_gradient<dim, Scalar>(above) - volume_gradient<dim, Scalar>(below)) / (2 * h);
            const Eigen::Map<const Eigen::Matrix<Scalar, dim*(dim + 1), 1>> column(change.data());
            CHECK((column - hessian.col(dim * a + d)).norm() < test::rounding<Scalar>() * hessian.norm());
        }
    }
}

TEST_CASE_TEMPLATE("with cells, forces are minus the gradient of the energy and the Hessian is their derivative", T,
                   test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const Example<dim, double> example;
    const auto& network = example.network;
    const auto& x = example.positions;
    REQUIRE(network.volume_stiffness.minCoeff() < 0);
    const FreeNodes free(network.n_nodes(), {1, 4});
    const Index n = dim * free.n_free();
    const Points<dim, double> forces = elastic_forces<dim, double>(network, x);
    const Points<dim, double> still = Points<dim, double>::Zero(dim, network.n_nodes());
    Points<dim, double> all = still;
    add_spring_forces<dim, double>(network, x, still, all);
    CHECK(test::relative_difference(all, forces) < 1e-14);
    const double h = 1e-6;
    Values<double> slopes(n);
    DenseMatrix<double> by_position(n, n);
    for (Index c = 0; c < n; ++c) {
        const auto shifted = [&](double step) {
            Values<double> coordinates = free.gather<dim, double>(x);
            coordinates(c) += step;
            auto moved = x;
            free.scatter<dim, double>(coordinates, moved);
            return moved;
        };
        const Points<dim, double> above = shifted(h);
        const Points<dim, double> below = shifted(-h);
        slopes(c) =
            (elastic_energy<dim, double>(network, below) - elastic_energy<dim, double>(network, above)) / (2 * h);
        by_position.col(c) = free.gather<dim, double>(elastic_forces<dim, double>(network, below) -
                                                      elastic_forces<dim, double>(network, above)) /
                             (2 * h);
    }
    CHECK(test::relative_difference(slopes, free.gather<dim, double>(forces)) < 1e-8);
    CHECK(test::relative_difference(hessian<dim>(network, free, x, HessianForm::exact), by_position) < 1e-8);
}

TEST_CASE_TEMPLATE("the semidefinite Hessian of cells keeps what is positive at every position", T,
                   test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    Example<dim, double> example;
    auto& network = example.network;
    const FreeNodes free(network.n_nodes(), {});
    const auto smallest = [](const DenseMatrix<double>& matrix) { return test::eigenvalues(matrix)(0); };
    CHECK(smallest(hessian<dim>(network, free, 0.5 * example.positions, HessianForm::exact)) < -0.1);
    CHECK(smallest(hessian<dim>(network, free, 0.5 * example.positions, HessianForm::positive_semidefinite)) > -1e-12);
    // At rest there is no pressure: only cells of negative stiffness are left out.
    network.rest_volume = springs_along_edges(jittered_mesh<dim, double>(), {.volume = true}).rest_volume;
    auto positive = network;
    positive.volume_stiffness = network.volume_stiffness.cwiseMax(0.);
    const auto& rest = network.rest_positions;
    CHECK(test::relative_difference(hessian<dim>(network, free, rest, HessianForm::positive_semidefinite),
                                    hessian<dim>(positive, free, rest, HessianForm::exact)) < 1e-14);
}

TEST_CASE_TEMPLATE("cells conserve momentum, turn with the body and do nothing in a rigid motion", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const Example<dim, Scalar> example;
    auto network = example.network;
    const auto& x = example.positions;
    const Points<dim, Scalar> forces = volume_forces<dim, Scalar>(network, x);
    const Scalar size = forces.cwiseAbs().sum();
    CHECK(forces.rowwise().sum().norm() < test::rounding<Scalar>() * size);
    const Eigen::Matrix<Scalar, dim, dim> moment = forces * x.transpose();
    CHECK((moment - moment.transpose()).norm() < test::rounding<Scalar>() * size);
    const Eigen::Matrix<Scalar, dim, dim> rotation = some_rotation<dim, Scalar>();
    const Vector<dim, Scalar> shift = Vector<dim, Scalar>::LinSpaced(1, 2);
    const Points<dim, Scalar> turned = (rotation * x).colwise() + shift;
    CHECK(test::relative_difference(volume_forces<dim, Scalar>(network, turned), rotation * forces) <
          test::rounding<Scalar>(1000));

    add_volume_cells(network, jittered_mesh<dim, Scalar>());
    CHECK(network.volume_stiffness.cwiseAbs().maxCoeff() == 0);
    network.volume_stiffness.setConstant(5);
    CHECK(volume_forces<dim, Scalar>(network, network.rest_positions).cwiseAbs().maxCoeff() == 0);
    const Points<dim, Scalar> moved = (rotation * network.rest_positions).colwise() + shift;
    CHECK(volume_forces<dim, Scalar>(network, moved).cwiseAbs().maxCoeff() < test::rounding<Scalar>(1000));
    CHECK(volume_energy<dim, Scalar>(network, moved) < test::rounding<Scalar>());
}

TEST_CASE_TEMPLATE("the pressure of one cell, by hand: swollen, flat and inverted", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto rest = some_simplex<dim, Scalar>();
    SpringNetwork<dim, Scalar> network = springs_from_list<dim, Scalar>(rest, NodePairs(2, 0));
    network.cells = Eigen::Matrix<int, dim + 1, 1>::LinSpaced(0, dim);
    const Scalar volume = signed_volume<dim, Scalar>(rest);
    network.rest_volume = Values<Scalar>::Constant(1, volume);
    network.volume_stiffness = Values<Scalar>::Constant(1, 7);
    validate(network);
    const auto gradient = volume_gradient<dim, Scalar>(rest);
    for (const Scalar scale : {Scalar(2), Scalar(1), Scalar(0.5), Scalar(0)}) {
        // Scaled by s: V / V_0 = s^Dim, p = kappa (s^Dim - 1), facets grow by s^(Dim - 1).
        const Scalar dilation = std::pow(scale, Scalar(dim)) - 1;
        const Points<dim, Scalar> x = scale * rest;
        const Points<dim, Scalar> expected = -7 * dilation * std::pow(scale, Scalar(dim - 1)) * gradient;
        CHECK((volume_forces<dim, Scalar>(network, x) - expected).norm() <= test::rounding<Scalar>() * gradient.norm());
        const Scalar energy = 7 * volume * dilation * dilation / 2;
        CHECK(test::relative(elastic_energy<dim, Scalar>(network, x), energy, energy + volume) <
              test::rounding<Scalar>());
    }
    // Mirrored: V = -V_0, and the force drives it back through the flat state.
    Points<dim, Scalar> mirrored = rest;
    mirrored.row(0) *= -1;
    Points<dim, Scalar> expected = 14 * volume_gradient<dim, Scalar>(SimplexCorners<dim, Scalar>(mirrored));
    CHECK(test::relative_difference(volume_forces<dim, Scalar>(network, mirrored), expected) <
          test::rounding<Scalar>());
    CHECK(test::relative(elastic_energy<dim, Scalar>(network, mirrored), 14 * volume, volume) <
          test::rounding<Scalar>());
}

TEST_CASE("cells of every kind of mesh fill the body once, and those of neighbours meet") {
    const auto check = [](const auto& mesh, Index expected) {
        const auto network = springs_along_edges(mesh, {.volume = true});
        CHECK(network.n_cells() == expected);
        CHECK(network.volume_stiffness.size() == expected);
        const double total = cell_volumes(corner_mesh(mesh)).sum();
        CHECK(test::relative(network.rest_volume.sum(), total, total) < 1e-14);
        validate(network);
        return network;
    };
    auto triangles = triangle_grid<double>({3, 2}, {1.5, 1.});
    jitter(triangles, 0.2, 1);
    check(triangles, triangles.n_cells());
    auto quads = quad_grid<double>({3, 2}, {1.5, 1.});
    jitter(quads, 0.2, 1);
    const auto split = check(quads, 12);
    CHECK(split.cells.col(0).minCoeff() == quads.cells.col(0).minCoeff());
    auto tets = tetrahedron_grid<double>({2, 1, 1}, {2., 1., 1.});
    jitter(tets, 0.1, 1);
    check(tets, tets.n_cells());
    auto hexes = hex_grid<double>({2, 2, 2}, {1., 1., 1.});
    const auto pieces = check(hexes, 48);
    // The pieces are a mesh: every facet inside the body is shared by two of them, so the boundary has two triangles a
    // face of the 24 outer ones, however the corners of the hexahedra are numbered and turned.
    const auto conforms = [](const SpringNetwork<3, double>& network) {
        const Mesh<3, double, Tet4> mesh{network.rest_positions, network.cells};
        return boundary_facets(mesh).size() == 48;
    };
    CHECK(conforms(pieces));
    std::vector<int> order(static_cast<std::size_t>(hexes.n_nodes()));
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(3));
    auto shuffled = hexes;
    for (Index i = 0; i < hexes.n_nodes(); ++i) {
        shuffled.nodes.col(order[static_cast<std::size_t>(i)]) = hexes.nodes.col(i);
    }
    shuffled.cells = hexes.cells.unaryExpr([&](int node) { return order[static_cast<std::size_t>(node)]; });
    CHECK(conforms(check(shuffled, 48)));

    check(quadratic(tets), tets.n_cells());
}

TEST_CASE("cells that cannot hold a volume are refused") {
    auto mesh = triangle_grid<double>({2, 2}, {1., 1.});
    const auto cloth = membrane(mesh);
    CHECK_THROWS_AS((void)springs_along_edges(cloth, {.volume = true}), InvalidArgument);
    CHECK(springs_along_edges(cloth).n_cells() == 0);
    auto network = springs_along_edges(mesh);
    CHECK_THROWS_AS(add_volume_cells(network, triangle_grid<double>({3, 2}, {1., 1.})), InvalidArgument);
    auto inverted = mesh;
    inverted.cells.col(0).reverseInPlace();
    CHECK_THROWS_AS(add_volume_cells(network, inverted), InvalidArgument);
    CHECK(network.n_cells() == 0);
    add_volume_cells(network, mesh);
    validate(network);
    add_volume_cells(network, mesh); // not twice
    CHECK(network.n_cells() == mesh.n_cells());

    const auto refuses = [&](const auto& change, std::string_view name) {
        auto changed = network;
        change(changed);
        try {
            validate(changed);
            FAIL("accepted");
        } catch (const InvalidArgument& error) {
            CHECK(std::string_view(error.what()).find(name) != std::string_view::npos);
        }
    };
    refuses([](auto& n) { n.cells.col(1).reverseInPlace(); }, "cells");
    refuses([](auto& n) { n.cells(0, 1) = 99; }, "cells");
    refuses([](auto& n) { n.cells(0, 1) = n.cells(1, 1); }, "cells");
    refuses([](auto& n) { n.rest_volume(0) = 0; }, "rest_volume");
    refuses([](auto& n) { n.rest_volume.conservativeResize(1); }, "rest_volume");
    refuses([](auto& n) { n.volume_stiffness(0) = std::nan(""); }, "volume_stiffness");
    refuses([](auto& n) { n.volume_stiffness.resize(0); }, "volume_stiffness");
}
