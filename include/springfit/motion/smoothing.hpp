// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numeric>

#include <Eigen/Eigenvalues>

#include <springfit/motion/differences.hpp>
#include <springfit/motion/motion.hpp>
#include <springfit/solve/free_nodes.hpp>

namespace springfit {

namespace detail {

/// Displacements of the nodes that are free to move, a column a frame [coordinates x n_frames], m.
template <int Dim, std::floating_point Scalar>
DenseMatrix<double> displacements(const Motion<Dim, Scalar>& motion, const FreeNodes& free) {
    DenseMatrix<double> u(Dim * free.n_free(), motion.n_frames());
    for (Index t = 0; t < motion.n_frames(); ++t) {
        const Points<Dim, Scalar> moved = motion.positions[static_cast<std::size_t>(t)] - motion.rest_positions;
        u.col(t) = free.template gather<Dim, Scalar>(moved).template cast<double>();
    }
    return u;
}

/// D of the differences of some order between neighbours, [n - order x n].
template <std::same_as<double> Real>
DenseMatrix<Real> difference_matrix(Index n, int order) {
    DenseMatrix<Real> d = DenseMatrix<Real>::Identity(n, n);
    for (int o = 0; o < order; ++o) {
        d = (d.bottomRows(d.rows() - 1) - d.topRows(d.rows() - 1)).eval();
    }
    return d;
}

/// The noise by sixth differences in time, which leave little of a motion that the frames resolve: the median of their
/// size beside that of Gaussian numbers, over the root of C(12, 6).
template <std::same_as<double> Real>
Real noise_in_time(const DenseMatrix<Real>& u) {
    constexpr int order = 6;
    constexpr double variance = 924;             // C(12, 6)
    constexpr double median_of_size = 0.6744898; // of Gaussian numbers, whose standard deviation is 1
    const DenseMatrix<double> differences = u * difference_matrix<double>(u.cols(), order).transpose();
    std::vector<double> sizes(static_cast<std::size_t>(differences.size()));
    std::transform(differences.data(), differences.data() + differences.size(), sizes.begin(),
                   [](double d) { return std::abs(d); });
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    return *middle / (median_of_size * std::sqrt(variance));
}

/// The noise by the singular values of the displacements: those of a smooth motion fall to nothing, those of m x n
/// independent numbers lie in sigma (sqrt m -+ sqrt n). The lower quartile is that of a semicircle.
template <std::same_as<double> Real>
Real noise_in_space(const DenseMatrix<Real>& u) {
    const Index n = std::min(u.rows(), u.cols());
    const Index m = std::max(u.rows(), u.cols());
    const DenseMatrix<double> gram = u.cols() <= u.rows() ? DenseMatrix<double>(u.transpose() * u) : u * u.transpose();
    const Values<double> squares =
        Eigen::SelfAdjointEigenSolver<DenseMatrix<double>>(gram, Eigen::EigenvaluesOnly).eigenvalues(); // ascending
    constexpr double quartile = -0.404; // of the semicircle on [-1, 1]
    const double beta = std::sqrt(static_cast<double>(n) / static_cast<double>(m));
    const double quarter = std::max(squares(n / 4), 0.);
    return std::sqrt(quarter / (static_cast<double>(m) * std::max(1 + 2 * quartile * beta, 0.1)));
}

/// Whittaker's smoother of evenly spaced numbers y: the z that minimises |y - z|^2 + lambda |D z|^2, D the fourth
/// differences, with the lambda that makes the unbiased estimate of the risk least for noise of a known size (Mallows).
template <std::same_as<double> Real>
class Smoother {
public:
    explicit Smoother(Index n) {
        const DenseMatrix<Real> d = difference_matrix<Real>(n, 4);
        const Eigen::SelfAdjointEigenSolver<DenseMatrix<Real>> roughness(d.transpose() * d);
        m_vectors = roughness.eigenvectors();
        m_roughness = roughness.eigenvalues().cwiseMax(0.);
    }

    [[nodiscard]] Values<Real> operator()(const Values<Real>& y, Real noise) const {
        const Values<Real> parts = m_vectors.transpose() * y;
        Values<Real> best = Values<Real>::Ones(y.size());
        Real least = std::numeric_limits<Real>::infinity();
        for (Real lambda = 1e-4; lambda < 1e8; lambda *= 1.5) {
            const Values<Real> kept = (1 + lambda * m_roughness.array()).inverse();
            const Real left = ((1 - kept.array()) * parts.array()).matrix().squaredNorm();
            const Real risk = left + 2 * noise * noise * kept.sum();
            if (risk < least) {
                least = risk;
                best = kept;
            }
        }
        return m_vectors * best.cwiseProduct(parts);
    }

private:
    DenseMatrix<Real> m_vectors;
    Values<Real> m_roughness;
};

} // namespace detail

/// Frames that a motion must have for its noise to be told from it.
inline constexpr Index least_frames_for_noise = 12;

/// The standard deviation of the noise in a recorded coordinate, m, where it is the same everywhere and independent
/// between nodes and frames: the lesser of an estimate in time and one in space [our definition]. 0 for fewer than 12
/// frames. Throws InvalidArgument for an invalid motion. O(nodes x frames^2).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Scalar noise_level(const Motion<Dim, Scalar>& motion) {
    validate(motion);
    const FreeNodes free(motion.n_nodes(), motion.clamped);
    if (motion.n_frames() < least_frames_for_noise || free.n_free() == 0) {
        return 0;
    }
    const DenseMatrix<double> u = detail::displacements(motion, free);
    return static_cast<Scalar>(std::min(detail::noise_in_time(u), detail::noise_in_space(u)));
}

/// An estimate of the motion beneath a recording with noise of standard deviation `noise`, m: the principal motions of
/// the free nodes that stand out of the noise, singular values above sigma (sqrt m + sqrt n), each smoothed in time
/// (Eilers2003). Velocities and accelerations are differenced from it.
///
/// For evenly spaced frames. Throws InvalidArgument for an invalid motion and for noise below 0.
/// O(nodes x frames^2 + frames^3).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Motion<Dim, Scalar> smoothed(const Motion<Dim, Scalar>& motion, std::type_identity_t<Scalar> noise) {
    validate(motion);
    require(noise >= 0 && std::isfinite(noise), "noise", "a length not below 0", noise);
    Motion<Dim, Scalar> result = motion;
    const FreeNodes free(motion.n_nodes(), motion.clamped);
    if (noise == 0 || motion.n_frames() < least_frames_for_noise || free.n_free() == 0) {
        return result;
    }
    DenseMatrix<double> u = detail::displacements(motion, free);
    const double sigma = static_cast<double>(noise);
    const double edge = sigma * (std::sqrt(static_cast<double>(u.rows())) + std::sqrt(static_cast<double>(u.cols())));
    const Eigen::SelfAdjointEigenSolver<DenseMatrix<double>> principal(DenseMatrix<double>(u.transpose() * u));
    const detail::Smoother<double> smooth(u.cols());
    DenseMatrix<double> estimate = DenseMatrix<double>::Zero(u.rows(), u.cols());
    for (Index k = u.cols() - 1; k >= 0 && principal.eigenvalues()(k) > edge * edge; --k) {
        const double size = std::sqrt(principal.eigenvalues()(k));
        const Values<double> shape = u * principal.eigenvectors().col(k) / size;
        estimate += shape * smooth(size * principal.eigenvectors().col(k), sigma).transpose();
    }
    for (Index t = 0; t < motion.n_frames(); ++t) {
        auto& positions = result.positions[static_cast<std::size_t>(t)];
        Points<Dim, Scalar> moved = positions - motion.rest_positions;
        free.template scatter<Dim, Scalar>(Values<Scalar>(estimate.col(t).template cast<Scalar>()), moved);
        positions = motion.rest_positions + moved;
    }
    result.velocities = differentiate<Dim, Scalar>(result.times, result.positions, 1);
    result.accelerations = differentiate<Dim, Scalar>(result.times, result.positions, 2);
    return result;
}

} // namespace springfit
