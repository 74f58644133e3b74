// SPDX-License-Identifier: BSD-3-Clause
#include "eigenvalues.hpp"
#include "tolerance.hpp"

#include <springfit/simulate/symplectic_euler.hpp>

#include "body/example.hpp"

using namespace springfit;

namespace {

template <int Dim>
DenseMatrix<double> dense(const BlockMatrix<Dim, double>& matrix) {
    const DenseMatrix<double> lower = matrix.matrix();
    return lower.selfadjointView<Eigen::Lower>();
}

/// Largest h with M - h/2 C - h^2/4 K positive definite, at the given positions, by bisection on dense eigenvalues.
template <int Dim>
double true_limit(const SpringNetwork<Dim, double>& network, const Points<Dim, double>& positions,
                  const std::vector<int>& fixed) {
    const FreeNodes free(network.n_nodes(), fixed);
    auto stiffness = network_matrix(network, free);
    add_stiffness<Dim, double>(network, positions, HessianForm::exact, stiffness);
    auto damping = network_matrix(network, free);
    add_damping<Dim, double>(network, positions, 1., damping);
    Values<double> scale(Dim * free.n_free());
    for (Index f = 0; f < free.n_free(); ++f) {
        scale.segment<Dim>(Dim * f).setConstant(1 / std::sqrt(network.mass(free.nodes()[static_cast<std::size_t>(f)])));
    }
    const DenseMatrix<double> k = scale.asDiagonal() * dense(stiffness) * scale.asDiagonal();
    const DenseMatrix<double> c = scale.asDiagonal() * dense(damping) * scale.asDiagonal();
    double low = 0;
    double high = 100;
    for (int i = 0; i < 60; ++i) {
        const double h = (low + high) / 2;
        const DenseMatrix<double> excess = h / 2 * c + h * h / 4 * k;
        const double largest = test::eigenvalues(excess).maxCoeff();
        (largest < 1 ? low : high) = h;
    }
    return low;
}

/// Largest speed over many free steps of the bare scheme.
template <int Dim, class Scalar>
Scalar largest_speed(const SpringNetwork<Dim, Scalar>& network, Points<Dim, Scalar> x, Points<Dim, Scalar> v, Scalar h,
                     int steps) {
    SpringBody<Dim, Scalar> body(network);
    body.write(x, v);
    Scalar largest = 0;
    for (int s = 0; s < steps; ++s) {
        body.step(h);
        body.read(x, v);
        largest = std::max(largest, v.cwiseAbs().maxCoeff());
        if (!std::isfinite(largest)) {
            break;
        }
    }
    return largest;
}

template <int Dim, class Scalar>
Scalar speed_when_thrown(const SpringNetwork<Dim, Scalar>& network, Scalar h) {
    const auto scenario = test::thrown<Dim, Scalar>(network, Scalar(0.05));
    return largest_speed<Dim, Scalar>(network, scenario.initial_positions, scenario.initial_velocities, h, 5000);
}

/// Two masses with k = 100 N/m, stretched by 1 mm.
template <int Dim, class Scalar>
Scalar speed_of_small_swing(Scalar h, Scalar damping) {
    const auto network = test::two_masses<Dim, Scalar>(100, damping);
    Points<Dim, Scalar> x = network.rest_positions;
    x(0, 1) += Scalar(0.001);
    return largest_speed<Dim, Scalar>(network, x, Points<Dim, Scalar>::Zero(Dim, 2), h, 2000);
}

} // namespace

TEST_CASE_TEMPLATE("the stable step is a bound at every deformation and not a wasteful one", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    for (const double damping : {0., 0.005, 0.05}) {
        const auto network = test::random_network<dim, double>(damping);
        for (const auto& fixed : {std::vector<int>{}, std::vector<int>{0, 1, 5}}) {
            const double bound = stable_step(network, fixed);
            const double at_rest = true_limit<dim>(network, network.rest_positions, fixed);
            CHECK(bound <= at_rest);
            CHECK(at_rest <= 2.2 * bound);
            Points<dim, double> stretched = 3 * network.rest_positions;
            stretched.row(1) += network.rest_positions.row(0);
            CHECK(bound <= true_limit<dim>(network, stretched, fixed));
            CHECK(bound <= true_limit<dim>(network, 100 * network.rest_positions, fixed));
        }
        CHECK(stable_step(network, {0, 1, 5}) >= stable_step(network));
    }
}

TEST_CASE_TEMPLATE("for one spring the bound is the limit, damped or not", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    for (const Scalar damping : {Scalar(0), Scalar(5), Scalar(40)}) {
        const auto network = test::two_masses<dim, Scalar>(100, damping);
        const Scalar inverse_mass = Scalar(4) / 3;
        const Scalar omega = std::sqrt(100 * inverse_mass);
        const Scalar zeta = damping * inverse_mass / (2 * omega);
        const Scalar limit = 2 / omega * (std::sqrt(1 + zeta * zeta) - zeta);
        CHECK(test::relative(stable_step(network), limit, limit) < test::rounding<Scalar>());
        CHECK(speed_of_small_swing<dim, Scalar>(Scalar(0.98) * limit, damping) < Scalar(0.1));
        CHECK(speed_of_small_swing<dim, Scalar>(Scalar(1.02) * limit, damping) > 1);
        const Scalar held = std::sqrt(100 / Scalar(3)); // node 0 held: mass 3 alone
        if (damping == 0) {
            CHECK(test::relative(stable_step(network, {0}), 2 / held, 2 / held) < test::rounding<Scalar>());
        }
    }
}

TEST_CASE_TEMPLATE("steps just below the bound stay bounded over thousands of steps", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    for (const Scalar damping : {Scalar(0), Scalar(0.02)}) {
        const auto network = test::random_network<dim, Scalar>(damping);
        CHECK(speed_when_thrown<dim, Scalar>(network, Scalar(0.99) * stable_step(network)) < 50);
        CHECK(!(speed_when_thrown<dim, Scalar>(network, Scalar(2.5) * stable_step(network)) < 50));
    }
}

TEST_CASE_TEMPLATE("with cells the step is a bound where it is taken, at rest and deformed", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    for (const auto& [least, most] : {std::pair(0., 30.), std::pair(-30., 30.), std::pair(1e4, 1e5)}) {
        for (const double damping : {0., 0.005}) {
            const auto network = test::random_network_with_cells<dim, double>(damping, least, most);
            for (const auto& fixed : {std::vector<int>{}, std::vector<int>{0, 1, 5}}) {
                const auto check = [&, &network = network](const Points<dim, double>& positions) {
                    const double bound = stable_step_at<dim, double>(network, positions, fixed);
                    const double limit = true_limit<dim>(network, positions, fixed);
                    CHECK(bound <= limit);
                    CHECK(limit <= 2.2 * bound);
                };
                check(network.rest_positions);
                CHECK(stable_step(network, fixed) ==
                      stable_step_at<dim, double>(network, network.rest_positions, fixed));
                check(test::thrown<dim, double>(network, 0.3).initial_positions);
                check(0.5 * network.rest_positions);
                Points<dim, double> inverted = network.rest_positions;
                inverted.row(0) *= -0.8;
                check(inverted);
            }
        }
    }
}

TEST_CASE_TEMPLATE("for one cell at rest the bound is the limit", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    Points<dim, Scalar> rest = Points<dim, Scalar>::Zero(dim, dim + 1);
    rest.template rightCols<dim>().diagonal() = Vector<dim, Scalar>::LinSpaced(1, 2);
    auto network =
        springs_from_list<dim, Scalar>(rest, NodePairs(2, 0), Values<Scalar>::LinSpaced(dim + 1, Scalar(1), Scalar(3)));
    network.cells = Eigen::Matrix<int, dim + 1, 1>::LinSpaced(0, dim);
    const SimplexCorners<dim, Scalar> corners = rest;
    network.rest_volume = Values<Scalar>::Constant(1, signed_volume<dim, Scalar>(corners));
    network.volume_stiffness = Values<Scalar>::Constant(1, 50);
    const auto squares = volume_gradient<dim, Scalar>(corners).colwise().squaredNorm().transpose().eval();
    const auto limit = [&](int first) { // of M^-1 kappa/V g g' with the nodes before `first` held
        const Index n = dim + 1 - first;
        const Scalar stiffness =
            squares.tail(n).cwiseQuotient(network.mass.tail(n)).sum() * 50 / network.rest_volume(0);
        return 2 / std::sqrt(stiffness);
    };
    CHECK(test::relative(stable_step(network), limit(0), limit(0)) < test::rounding<Scalar>());
    CHECK(test::relative(stable_step(network, {0}), limit(1), limit(1)) < test::rounding<Scalar>());
    network.volume_stiffness(0) = -50; // pulls away from rest: no step is stable against it, none shortens it
    CHECK(std::isinf(stable_step(network)));
    CHECK(std::isfinite(stable_step_at<dim, Scalar>(network, 2 * rest)));
}

TEST_CASE_TEMPLATE("with cells, steps just below the bound of all that is passed stay bounded", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto network = test::random_network_with_cells<dim, Scalar>(0, 1000, 10000);
    CHECK(speed_when_thrown<dim, Scalar>(network, Scalar(0.5) * stable_step(network)) < 50);
    CHECK(!(speed_when_thrown<dim, Scalar>(network, Scalar(2.5) * stable_step(network)) < 50));
}

TEST_CASE("nothing binds the step of a network without stiffness, and fixed nodes must exist") {
    const auto network = test::two_masses<2, double>(0, 0);
    CHECK(std::isinf(stable_step(network)));
    CHECK(std::isinf(stable_step(test::two_masses<2, double>(5, 1), {0, 1})));
    CHECK_THROWS_AS((void)stable_step(network, {2}), InvalidArgument);
}

TEST_CASE("a network that is not valid has no stable step") {
    const auto good = test::two_masses<2, double>(5, 1);
    const auto refused = [](const SpringNetwork<2, double>& network) {
        CHECK_THROWS_AS((void)stable_step(network), InvalidArgument);
        CHECK_THROWS_AS((void)stable_step_at(network, network.rest_positions), InvalidArgument);
    };
    for (const double mass : {0., -1., std::nan(""), double(INFINITY)}) {
        auto network = good;
        network.mass(1) = mass;
        refused(network);
    }
    for (const int end : {-1, 0, 2}) {
        auto network = good;
        network.springs(1, 0) = end;
        refused(network);
    }
    for (const double value : {-1., std::nan("")}) {
        auto network = good;
        network.stiffness(0) = value;
        refused(network);
        network = good;
        network.damping(0) = value;
        refused(network);
    }
    auto network = good;
    network.mass.resize(1);
    refused(network);
    const Points<2, double> too_few = Points<2, double>::Zero(2, 1);
    CHECK_THROWS_AS((void)stable_step_at(good, too_few), InvalidArgument);
}
