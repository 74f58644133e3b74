// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>
#include <type_traits>

#include <Eigen/Eigenvalues>

#include <springfit/core/status.hpp>
#include <springfit/fem/model.hpp>
#include <springfit/network/forces.hpp>
#include <springfit/solve/symmetric_solver.hpp>

namespace springfit {

template <std::floating_point Scalar>
struct FrequencyOptions {
    /// Largest relative change of omega^2 from one iteration to the next that counts as none, in (0, 1).
    Scalar tolerance = std::max(Scalar(1e-8), 100 * std::numeric_limits<Scalar>::epsilon());
    int max_iterations = 200; ///< >= 1
};

/// The slowest free vibration of a body about its rest shape.
template <int Dim, std::floating_point Scalar>
struct NaturalFrequency {
    Status status = Status::failed; ///< `failed` where the rest shape is no stable equilibrium under the clamps
    Scalar omega = 0;               ///< angular, rad/s
    Points<Dim, Scalar> mode; ///< [Dim x n_nodes], its largest component 1; where several are as slow, one of them
    int iterations = 0;
};

namespace detail {

/// The smallest omega^2 of K x = omega^2 M x, M diagonal, by inverse iteration on a block of four vectors (so that
/// close frequencies do not slow it down) with the small problem on their span solved in between.
template <int Dim, std::floating_point Scalar>
NaturalFrequency<Dim, Scalar> lowest_mode(const SymmetricMatrix<Scalar>& stiffness, const Values<Scalar>& masses,
                                          const FreeNodes& free, const FrequencyOptions<Scalar>& options) {
    require(options.tolerance > 0 && options.tolerance < 1, "tolerance", "a value in (0, 1)", options.tolerance);
    require(options.max_iterations >= 1, "max_iterations", "at least one iteration", options.max_iterations);
    require(free.n_free() > 0, "clamped", "nodes left to move", "none");
    NaturalFrequency<Dim, Scalar> result;
    const Index n = stiffness.size();
    SymmetricSolver<Scalar> solver;
    if (!solver.factorise(stiffness) || solver.shift() > 0) {
        return result;
    }
    Values<Scalar> m(n);
    for (Index f = 0; f < free.n_free(); ++f) {
        m.template segment<Dim>(Dim * f).setConstant(masses(free.nodes()[static_cast<std::size_t>(f)]));
    }
    constexpr int most = 4;
    const Index width = std::min<Index>(most, n);
    using Block = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, Eigen::Dynamic, most>;
    using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, most, most>;
    Block x(n, width);
    std::mt19937 random(1);
    std::uniform_real_distribution<Scalar> entry(-1, 1);
    for (Scalar& value : x.reshaped()) {
        value = entry(random);
    }
    Block pushed(n, width);
    Scalar before = 0;
    for (result.iterations = 1; result.iterations <= options.max_iterations; ++result.iterations) {
        // y = K^-1 M x; on its span, K is y' M x and M is y' M y.
        pushed = m.asDiagonal() * x;
        for (Index c = 0; c < width; ++c) {
            x.col(c) = solver.apply_factor(pushed.col(c));
        }
        const Small product = (x.transpose() * pushed).template cast<double>();
        const Small small_stiffness = (product + product.transpose()) / 2;
        const Small small_mass = (x.transpose() * m.asDiagonal() * x).template cast<double>();
        const Eigen::GeneralizedSelfAdjointEigenSolver<Small> small(small_stiffness, small_mass);
        if (small.info() != Eigen::Success || !(small.eigenvalues()(0) > 0)) {
            return result;
        }
        x = (x * small.eigenvectors().template cast<Scalar>()).eval();
        const auto square = static_cast<Scalar>(small.eigenvalues()(0));
        result.omega = std::sqrt(square);
        if (std::abs(square - before) <= options.tolerance * square) {
            result.status = Status::converged;
            break;
        }
        result.status = Status::iteration_limit;
        before = square;
    }
    result.iterations = std::min(result.iterations, options.max_iterations);
    // Softer than rounding of the stiffness can tell: a rigid motion or a mechanism.
    const Values<Scalar> mode = x.col(0);
    const Scalar energy = result.omega * result.omega * mode.dot(m.cwiseProduct(mode));
    const Scalar rounding =
        std::numeric_limits<Scalar>::epsilon() * mode.cwiseAbs2().dot(stiffness.diagonal().cwiseAbs());
    if (!(energy > 100 * rounding)) {
        result.status = Status::failed;
        result.omega = 0;
    }
    Index largest = 0;
    mode.cwiseAbs().maxCoeff(&largest);
    result.mode.setZero(Dim, free.n_nodes());
    free.template scatter<Dim, Scalar>(mode / mode(largest), result.mode);
    return result;
}

} // namespace detail

/// The lowest natural frequency of a network with some nodes clamped: K x = omega^2 M x with K the second derivative of
/// its energy at the rest positions. Throws InvalidArgument for node numbers out of range and where none is free. One
/// factorisation, then O(its entries) per iteration.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] NaturalFrequency<Dim, Scalar>
lowest_frequency(const SpringNetwork<Dim, Scalar>& network, const std::vector<int>& clamped,
                 const FrequencyOptions<std::type_identity_t<Scalar>>& options = {}) {
    validate(network);
    const FreeNodes free(network.n_nodes(), clamped);
    auto stiffness = network_matrix(network, free);
    add_stiffness<Dim, Scalar>(network, network.rest_positions, HessianForm::exact, stiffness);
    return detail::lowest_mode<Dim, Scalar>(stiffness.matrix(), network.mass, free, options);
}

/// The same of a finite-element model, with its lumped masses.
template <int Dim, std::floating_point Scalar, fem::FiniteElementCell Cell, fem::Material Mat>
[[nodiscard]] NaturalFrequency<Dim, Scalar>
lowest_frequency(const fem::Model<Dim, Scalar, Cell, Mat>& model, const std::vector<int>& clamped,
                 const FrequencyOptions<std::type_identity_t<Scalar>>& options = {}) {
    const FreeNodes free(model.rest_positions().cols(), clamped);
    auto stiffness = model.make_stiffness(free);
    model.assemble(model.rest_positions(), stiffness);
    return detail::lowest_mode<Dim, Scalar>(stiffness.matrix(), model.masses(), free, options);
}

} // namespace springfit
