// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <memory>
#include <utility>

#include <springfit/solve/detail/node_cholesky.hpp>
#include <springfit/solve/free_nodes.hpp>

namespace springfit {

/// The Cholesky factor of a body's stiffness at rest, turned with the body: R K0^-1 R', R the rotation of the
/// surroundings of each node.
///
/// What an elastic body answers hardly depends on how it is turned, so this preconditions conjugate gradients in bent
/// and twisted states almost as well as at rest. Copies share the factor, which does not change: one per thread.
/// Memory: 6 bytes per entry of the factor, which is kept in single precision.
template <int Dim, std::floating_point Scalar>
class TurnedFactor {
public:
    TurnedFactor() = default;

    /// Factorises the stiffness at rest over the free coordinates, `lower` its lower triangle. `pairs` `[2 x n_pairs]`
    /// are the neighbours by which the rotations are found, `rest` `[Dim x n_nodes]` where they lie at rest.
    TurnedFactor(const SparseMatrix<Scalar>& lower, const FreeNodes& free, const NodePairs& pairs,
                 const Points<Dim, Scalar>& rest) {
        auto made = std::make_shared<Rest>();
        made->free = free;
        made->pairs = pairs;
        made->vectors.resize(Dim, pairs.cols());
        for (Index e = 0; e < pairs.cols(); ++e) {
            const Vector<Dim, Scalar> r = rest.col(pairs(1, e)) - rest.col(pairs(0, e));
            const Scalar square = r.squaredNorm();
            made->vectors.col(e) = square > 0 ? Vector<Dim, Scalar>(r / square) : r;
        }
        if (lower.cols() > 0) {
            made->factor = detail::NodeCholesky<Dim, Scalar>(lower);
        }
        if (made->factor.is_usable()) {
            m_rest = std::move(made);
            turn(rest);
        }
    }

    /// False where the stiffness at rest is not positive definite by a margin above rounding; then nothing else may be
    /// called.
    [[nodiscard]] bool is_usable() const { return m_rest != nullptr; }

    /// Finds the rotations at positions x `[Dim x n_nodes]`: the polar part of sum r r0' / |r0|^2 over the pairs at a
    /// node, none where that is no rotation. O(pairs).
    void turn(const Points<Dim, Scalar>& x) {
        Points<Dim * Dim, Scalar> sums = Points<Dim * Dim, Scalar>::Zero(Dim * Dim, x.cols());
        for (Index e = 0; e < m_rest->pairs.cols(); ++e) {
            const int i = m_rest->pairs(0, e);
            const int j = m_rest->pairs(1, e);
            const Rotation product = (x.col(j) - x.col(i)) * m_rest->vectors.col(e).transpose();
            sums.col(i) += product.reshaped();
            sums.col(j) += product.reshaped();
        }
        m_rotations.resize(Dim * Dim, m_rest->free.n_free());
        for (Index f = 0; f < m_rest->free.n_free(); ++f) {
            const auto sum = sums.col(m_rest->free.nodes()[static_cast<std::size_t>(f)]);
            m_rotations.col(f) = rotation_of(sum.reshaped(Dim, Dim)).reshaped();
        }
    }

    /// solution = R K0^-1 R' right, over the free coordinates. O(entries of the factor).
    void apply(const Values<Scalar>& right, Values<Scalar>& solution) const {
        using Work = typename detail::NodeCholesky<Dim, Scalar>::Work;
        const std::vector<int>& order = m_rest->factor.order();
        Work work = Work::Zero(Work::RowsAtCompileTime, m_rotations.cols());
        for (std::size_t p = 0; p < order.size(); ++p) {
            work.col(static_cast<Index>(p)).template head<Dim>() =
                rotation(order[p]).transpose() * right.template segment<Dim>(Dim * order[p]);
        }
        m_rest->factor.solve(work);
        solution.resize(right.size());
        for (std::size_t p = 0; p < order.size(); ++p) {
            solution.template segment<Dim>(Dim * order[p]) =
                rotation(order[p]) * work.col(static_cast<Index>(p)).template head<Dim>();
        }
    }

private:
    using Rotation = Eigen::Matrix<Scalar, Dim, Dim>;

    struct Rest {
        FreeNodes free;
        NodePairs pairs;
        Points<Dim, Scalar> vectors; ///< r0 / |r0|^2 of each pair
        detail::NodeCholesky<Dim, Scalar> factor;
    };

    [[nodiscard]] Eigen::Map<const Rotation> rotation(Index f) const {
        return Eigen::Map<const Rotation>(m_rotations.col(f).data());
    }

    /// The rotation nearest to A, or the identity where A is no deformation of positive volume.
    static Rotation rotation_of(const Rotation& a) {
        if constexpr (Dim == 2) {
            const Scalar c = a(0, 0) + a(1, 1);
            const Scalar s = a(1, 0) - a(0, 1);
            const Scalar size = std::hypot(c, s);
            if (!(size > 0)) {
                return Rotation::Identity();
            }
            return (Rotation() << c / size, -s / size, s / size, c / size).finished();
        } else {
            Rotation x = a * (std::sqrt(Scalar(3)) / a.norm());
            Scalar determinant = 0;
            for (int iteration = 0; iteration < 20; ++iteration) { // Newton's for the polar part: (X + X^-T) / 2
                Rotation cofactors;
                cofactors.col(0) = x.col(1).cross(x.col(2));
                cofactors.col(1) = x.col(2).cross(x.col(0));
                cofactors.col(2) = x.col(0).cross(x.col(1));
                determinant = x.col(0).dot(cofactors.col(0));
                if (!(determinant > 0)) {
                    return Rotation::Identity();
                }
                const Rotation next = (x + cofactors / determinant) / 2;
                const Scalar change = (next - x).norm();
                x = next;
                if (change < Scalar(1e-4)) { // then the next is at 1e-8
                    break;
                }
            }
            return std::abs(determinant - 1) < Scalar(0.1) ? x : Rotation::Identity();
        }
    }

    std::shared_ptr<const Rest> m_rest;
    Points<Dim * Dim, Scalar> m_rotations; ///< of the free nodes
};

} // namespace springfit
