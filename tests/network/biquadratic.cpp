// SPDX-License-Identifier: BSD-3-Clause
#include "biquadratic_example.hpp"
#include "eigenvalues.hpp"
#include "tolerance.hpp"

#include <springfit/network/biquadratic_forces.hpp>

using namespace springfit;

namespace {

template <int Dim, class Scalar>
Points<Dim, Scalar> elastic_forces(const BiquadraticNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& x) {
    Points<Dim, Scalar> forces = Points<Dim, Scalar>::Zero(Dim, network.n_nodes());
    add_elastic_forces<Dim, Scalar>(network, x, forces);
    return forces;
}

} // namespace

TEST_CASE_TEMPLATE("forces and Hessian are the derivatives of the energy", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto network = test::random_biquadratic<dim, double>();
    const auto x = test::moved<dim, double>(network.rest_positions, 0.05, 2);
    const auto forces = elastic_forces<dim, double>(network, x);
    const FreeNodes free(network.n_nodes(), {0, 3});
    auto matrix = network_matrix(network, free);
    add_stiffness<dim, double>(network, x, HessianForm::exact, matrix);
    const double h = 1e-6;
    for (unsigned seed = 3; seed < 6; ++seed) {
        Points<dim, double> direction = test::moved<dim, double>(Points<dim, double>::Zero(dim, x.cols()), 1, seed);
        direction.col(0).setZero();
        direction.col(3).setZero();
        const Points<dim, double> ahead = x + h * direction;
        const Points<dim, double> behind = x - h * direction;
        const double slope =
            (elastic_energy<dim, double>(network, ahead) - elastic_energy<dim, double>(network, behind)) / (2 * h);
        CHECK(test::relative(slope, -forces.cwiseProduct(direction).sum(), forces.norm() * direction.norm()) < 1e-8);
        const Points<dim, double> change =
            (elastic_forces<dim, double>(network, behind) - elastic_forces<dim, double>(network, ahead)) / (2 * h);
        const Values<double> expected = free.gather<dim, double>(change);
        const Values<double> along = free.gather<dim, double>(direction);
        const Values<double> product = matrix.matrix().template selfadjointView<Eigen::Lower>() * along;
        CHECK((product - expected).norm() < 1e-7 * expected.norm());
    }
    // Without the negative geometric parts no direction has less curvature.
    auto semidefinite = network_matrix(network, free);
    add_stiffness<dim, double>(network, x, HessianForm::positive_semidefinite, semidefinite);
    const DenseMatrix<double> more = DenseMatrix<double>(semidefinite.matrix()) - DenseMatrix<double>(matrix.matrix());
    const Values<double> eigenvalues = test::eigenvalues(more);
    CHECK(eigenvalues.maxCoeff() > 0);
    CHECK(eigenvalues.minCoeff() > -1e-12 * eigenvalues.maxCoeff());
}

TEST_CASE_TEMPLATE("momentum is kept, rigid motion makes no force, damping takes energy", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    auto network = test::random_biquadratic<dim, Scalar>();
    network.damping = Scalar(0.3);
    network.angular /= 4; // S positive definite in every triangle
    const auto x = test::moved<dim, Scalar>(network.rest_positions, Scalar(0.1), 2);
    const auto v = test::moved<dim, Scalar>(Points<dim, Scalar>::Zero(dim, x.cols()), Scalar(1), 3);
    Points<dim, Scalar> forces = Points<dim, Scalar>::Zero(dim, x.cols());
    add_forces<dim, Scalar>(network, x, v, forces);
    const Scalar size = forces.norm();
    CHECK(forces.rowwise().sum().norm() < test::rounding<Scalar>() * size);
    const Eigen::Matrix<Scalar, dim, dim> torque = x * forces.transpose() - forces * x.transpose();
    CHECK(torque.norm() < test::rounding<Scalar>() * size);
    const Scalar power = (forces - elastic_forces<dim, Scalar>(network, x)).cwiseProduct(v).sum();
    CHECK(power < 0);

    Eigen::Matrix<Scalar, dim, dim> turn = Eigen::Matrix<Scalar, dim, dim>::Identity();
    turn.template topLeftCorner<2, 2>() = Eigen::Rotation2D<Scalar>(Scalar(0.7)).toRotationMatrix();
    const auto at_rest = biquadratic_network(test::triangles<dim, Scalar>());
    network.rest_length = at_rest.rest_length;
    const Points<dim, Scalar> turned = (turn * network.rest_positions).colwise() + Vector<dim, Scalar>::Ones();
    CHECK(elastic_forces<dim, Scalar>(network, turned).norm() < test::rounding<Scalar>() * size);
    Points<dim, Scalar> spinning = turned; // v = W x with W antisymmetric
    spinning.setZero();
    spinning.row(0) = -turned.row(1);
    spinning.row(1) = turned.row(0);
    forces.setZero();
    add_forces<dim, Scalar>(network, turned, spinning, forces);
    CHECK(forces.norm() < test::rounding<Scalar>() * size);
}

TEST_CASE("networks that cannot be used are refused") {
    const auto good = biquadratic_network(test::triangles<2, double>());
    CHECK(test::relative(good.mass.sum(), 1., 1.) < 1e-12);
    CHECK(biquadratic_network(quadratic(test::triangles<2, double>())).n_nodes() == good.n_nodes());
    const auto refused = [&](auto spoil) {
        auto network = good;
        spoil(network);
        CHECK_THROWS_AS(validate(network), InvalidArgument);
    };
    refused([](auto& network) { network.triangles(0, 0) = 99; });
    refused([](auto& network) { network.triangles(0, 0) = network.triangles(1, 0); });
    refused([](auto& network) { network.mass(2) = 0; });
    refused([](auto& network) { network.mass.conservativeResize(3); });
    refused([](auto& network) { network.tensile(1, 1) = std::nan(""); });
    refused([](auto& network) { network.rest_length(1, 1) = 0; });
    refused([](auto& network) { network.angular.conservativeResize(3, 2); });
    refused([](auto& network) { network.damping = -1; });
    CHECK_THROWS_AS((void)biquadratic_network(test::triangles<2, double>(), {.density = 0.}), InvalidArgument);
}
