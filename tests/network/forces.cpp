// SPDX-License-Identifier: BSD-3-Clause
#include "eigenvalues.hpp"
#include "tolerance.hpp"

#include <springfit/mesh/structured.hpp>
#include <springfit/network/builders.hpp>
#include <springfit/network/forces.hpp>

using namespace springfit;

namespace {

/// A jittered mesh with random stiffness over a decade, random damping, and a state far from rest.
template <int Dim, class Scalar>
struct Example {
    SpringNetwork<Dim, Scalar> network;
    Points<Dim, Scalar> positions;
    Points<Dim, Scalar> velocities;
};

template <int Dim, class Scalar>
Example<Dim, Scalar> example() {
    Example<Dim, Scalar> result;
    if constexpr (Dim == 2) {
        auto mesh = triangle_grid<Scalar>({3, 3}, {Scalar(1), Scalar(1)});
        jitter(mesh, Scalar(0.2), 1);
        result.network = springs_along_edges(mesh);
    } else {
        auto mesh = tetrahedron_grid<Scalar>({2, 2, 2}, {Scalar(1), Scalar(1), Scalar(1)});
        jitter(mesh, Scalar(0.2), 1);
        result.network = springs_along_edges(mesh);
    }
    std::mt19937 random(7);
    std::uniform_real_distribution<Scalar> unit(-1, 1);
    auto& network = result.network;
    for (Index e = 0; e < network.n_springs(); ++e) {
        network.stiffness(e) = std::pow(Scalar(10), unit(random) / 2);
        network.damping(e) = (1 + unit(random)) / 4;
        network.rest_length(e) *= 1 + unit(random) / 10;
    }
    result.positions = network.rest_positions;
    result.velocities = network.rest_positions;
    for (Index i = 0; i < network.n_nodes(); ++i) {
        for (int d = 0; d < Dim; ++d) {
            result.positions(d, i) += unit(random) / 10;
            result.velocities(d, i) = unit(random);
        }
    }
    return result;
}

template <class Matrix>
DenseMatrix<double> full(const Matrix& matrix) {
    const DenseMatrix<double> lower = matrix.matrix();
    return lower.template selfadjointView<Eigen::Lower>();
}

template <int Dim>
Eigen::Matrix<double, Dim, Dim> some_rotation() {
    if constexpr (Dim == 2) {
        return Eigen::Rotation2Dd(0.7).toRotationMatrix();
    } else {
        return Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix();
    }
}

template <int Dim, class Scalar>
Points<Dim, Scalar> spring_forces(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& x,
                                  const Points<Dim, Scalar>& v) {
    Points<Dim, Scalar> forces = Points<Dim, Scalar>::Zero(Dim, network.n_nodes());
    add_spring_forces<Dim, Scalar>(network, x, v, forces);
    return forces;
}

} // namespace

TEST_CASE_TEMPLATE("elastic forces are minus the gradient of the energy", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    auto [network, x, v] = example<dim, double>();
    Points<dim, double> forces = Points<dim, double>::Zero(dim, network.n_nodes());
    add_elastic_forces<dim, double>(network, x, forces);
    const double h = 1e-6;
    Points<dim, double> difference(dim, network.n_nodes());
    for (Index i = 0; i < network.n_nodes(); ++i) {
        for (int d = 0; d < dim; ++d) {
            auto shifted = x;
            shifted(d, i) += h;
            const double above = elastic_energy<dim, double>(network, shifted);
            shifted(d, i) -= 2 * h;
            difference(d, i) = -(above - elastic_energy<dim, double>(network, shifted)) / (2 * h);
        }
    }
    CHECK(test::relative_difference(difference, forces) < 1e-8);
}

TEST_CASE_TEMPLATE("the Hessian is the derivative of the forces", T, test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto given = example<dim, double>();
    const auto& network = given.network;
    const auto& x = given.positions;
    const auto& v = given.velocities;
    const FreeNodes free(network.n_nodes(), {1, 4});
    auto stiffness = network_matrix(network, free);
    add_stiffness<dim, double>(network, x, HessianForm::exact, stiffness);
    auto damping = network_matrix(network, free);
    add_damping<dim, double>(network, x, 1., damping);
    const Index n = dim * free.n_free();
    DenseMatrix<double> by_position(n, n);
    DenseMatrix<double> by_velocity(n, n);
    const Points<dim, double> still = Points<dim, double>::Zero(dim, network.n_nodes());
    const double h = 1e-6;
    for (Index c = 0; c < n; ++c) {
        const auto derivative = [&](const auto& forces_at) {
            Values<double> unit = Values<double>::Zero(n);
            unit(c) = h;
            return Values<double>(free.gather<dim, double>(forces_at(-unit) - forces_at(unit)) / (2 * h));
        };
        by_position.col(c) = derivative([&](const Values<double>& shift) {
            auto moved = x;
            free.scatter<dim, double>(free.gather<dim, double>(x) + shift, moved);
            return spring_forces<dim, double>(network, moved, still);
        });
        by_velocity.col(c) = derivative([&](const Values<double>& shift) {
            auto moved = v;
            free.scatter<dim, double>(free.gather<dim, double>(v) + shift, moved);
            return spring_forces<dim, double>(network, x, moved);
        });
    }
    CHECK(test::relative_difference(full(stiffness), by_position) < 1e-8);
    CHECK(test::relative_difference(full(damping), by_velocity) < 1e-8);
}

TEST_CASE_TEMPLATE("the semidefinite Hessian drops negative curvature alone", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    auto [network, x, v] = example<dim, double>();
    const FreeNodes free(network.n_nodes(), {});
    const auto assemble = [&, &net = network](const Points<dim, double>& at, HessianForm curvature) {
        auto matrix = network_matrix(net, free);
        add_stiffness<dim, double>(net, at, curvature, matrix);
        return full(matrix);
    };
    const auto smallest = [](const DenseMatrix<double>& matrix) { return test::eigenvalues(matrix)(0); };
    const Points<dim, double> squeezed = 0.5 * x;
    CHECK(smallest(assemble(squeezed, HessianForm::exact)) < -0.1);
    CHECK(smallest(assemble(squeezed, HessianForm::positive_semidefinite)) > -1e-12);
    const Points<dim, double> stretched = 2 * network.rest_positions;
    CHECK((assemble(stretched, HessianForm::exact) - assemble(stretched, HessianForm::positive_semidefinite)).norm() ==
          0);
}

TEST_CASE_TEMPLATE("spring forces conserve momentum, turn with the body, and damping only takes energy", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    auto [network, x, v] = example<dim, Scalar>();
    const Points<dim, Scalar> forces = spring_forces<dim, Scalar>(network, x, v);
    const Scalar size = forces.cwiseAbs().sum();
    CHECK(forces.rowwise().sum().norm() < test::rounding<Scalar>() * size);
    const Eigen::Matrix<Scalar, dim, dim> moment = forces * x.transpose();
    CHECK((moment - moment.transpose()).norm() < test::rounding<Scalar>() * size);

    Points<dim, Scalar> elastic = Points<dim, Scalar>::Zero(dim, network.n_nodes());
    add_elastic_forces<dim, Scalar>(network, x, elastic);
    const Points<dim, Scalar> damping_forces = forces - elastic;
    CHECK(damping_forces.cwiseProduct(v).sum() < 0);

    const Eigen::Matrix<Scalar, dim, dim> rotation = some_rotation<dim>().template cast<Scalar>();
    const Vector<dim, Scalar> shift = Vector<dim, Scalar>::LinSpaced(1, 2);
    const Points<dim, Scalar> turned = (rotation * x).colwise() + shift;
    // A rigid motion on top of the velocities changes nothing either: add omega x (x - shift).
    Eigen::Matrix<Scalar, dim, dim> spin = Eigen::Matrix<Scalar, dim, dim>::Zero();
    spin(0, 1) = 3;
    spin(1, 0) = -3;
    const Points<dim, Scalar> turned_velocities = rotation * (v + spin * x);
    CHECK(test::relative_difference(spring_forces<dim, Scalar>(network, turned, turned_velocities), rotation * forces) <
          test::rounding<Scalar>(1000));
}

TEST_CASE_TEMPLATE("forces do not depend on the order or direction of springs, and scale with the units", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    auto [network, x, v] = example<dim, Scalar>();
    const Points<dim, Scalar> forces = spring_forces<dim, Scalar>(network, x, v);
    auto reversed = network;
    reversed.springs = network.springs.colwise().reverse().rowwise().reverse().eval();
    reversed.stiffness.reverseInPlace();
    reversed.rest_length.reverseInPlace();
    reversed.damping.reverseInPlace();
    CHECK(test::relative_difference(spring_forces<dim, Scalar>(reversed, x, v), forces) < test::rounding<Scalar>());

    auto millimetres = network; // k [N/m] -> N/mm, the same forces in N
    millimetres.stiffness /= Scalar(1000);
    millimetres.damping /= Scalar(1000);
    millimetres.rest_length *= Scalar(1000);
    CHECK(test::relative_difference(spring_forces<dim, Scalar>(millimetres, Scalar(1000) * x, Scalar(1000) * v),
                                    forces) < test::rounding<Scalar>());
    Points<dim, Scalar> accelerations;
    compute_accelerations<dim, Scalar>(network, x, v, Points<dim, Scalar>::Ones(dim, network.n_nodes()), accelerations);
    for (Index i = 0; i < network.n_nodes(); ++i) {
        CHECK((network.mass(i) * accelerations.col(i) - forces.col(i) - Vector<dim, Scalar>::Ones()).norm() <
              test::rounding<Scalar>() * (1 + forces.col(i).norm()));
    }
}

TEST_CASE("one spring, by hand, and none where its ends meet") {
    Points<3, double> rest(3, 2);
    rest << 0, 2, 0, 0, 0, 0;
    NodePairs pair(2, 1);
    pair << 0, 1;
    auto network = springs_from_list<3, double>(rest, pair);
    network.stiffness << 10;
    network.damping << 4;
    Points<3, double> x(3, 2);
    x << 0, 3, 0, 0, 0, 4; // length 5, stretch 3
    Points<3, double> v(3, 2);
    v << 0, 5, 0, 7, 0, 0; // rate 5 * 3/5 = 3
    const Points<3, double> forces = spring_forces<3, double>(network, x, v);
    CHECK(test::relative(forces(0, 0), 42 * 0.6, 42.) < 1e-15);
    CHECK(forces(1, 0) == 0);
    CHECK(test::relative(forces(2, 0), 42 * 0.8, 42.) < 1e-15);
    CHECK((forces.col(0) + forces.col(1)).norm() == 0);
    CHECK(test::relative(elastic_energy<3, double>(network, x), 45., 45.) < 1e-15);
    CHECK(spring_forces<3, double>(network, Points<3, double>::Zero(3, 2), v).norm() == 0);
}
