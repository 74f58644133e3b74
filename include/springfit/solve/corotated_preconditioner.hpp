// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include <springfit/solve/detail/node_cholesky.hpp>
#include <springfit/solve/detail/node_rotations.hpp>
#include <springfit/solve/free_nodes.hpp>

namespace springfit {

/// The Cholesky factor of a body's stiffness at rest, turned with the body: R K0^-1 R', R the rotation of the
/// surroundings of each node.
///
/// An elastic body's response barely depends on its orientation, so this preconditions conjugate gradients in bent and
/// twisted states almost as well as at rest. Copies share the factor, which does not change: one per thread.
/// Memory: 6 bytes per entry of the factor, which is kept in single precision.
template <int Dim, std::floating_point Scalar>
class CorotatedPreconditioner {
public:
    CorotatedPreconditioner() = default;

    /// Factorises the stiffness at rest over the free coordinates, `lower` its lower triangle. `pairs` `[2 x n_pairs]`
    /// are the neighbours by which the rotations are found, `rest` `[Dim x n_nodes]` where they lie at rest.
    CorotatedPreconditioner(const SparseMatrix<Scalar>& lower, const FreeNodes& free, const NodePairs& pairs,
                            const Points<Dim, Scalar>& rest);

    /// False where the stiffness at rest is not positive definite by a margin above rounding; then nothing else may be
    /// called.
    [[nodiscard]] bool is_usable() const { return m_rest != nullptr; }

    /// Finds the rotations at positions x `[Dim x n_nodes]`: the polar part of sum r r0' / |r0|^2 over the pairs at a
    /// node, none where that is no rotation. O(pairs).
    void turn(const Points<Dim, Scalar>& x);

    /// solution = R K0^-1 R' right, over the free coordinates. O(entries of the factor).
    void apply(const Values<Scalar>& right, Values<Scalar>& solution) const;

private:
    struct Rest {
        FreeNodes free;
        NodePairs pairs;
        Points<Dim, Scalar> weighted; ///< r0 / |r0|^2 of each pair
        detail::NodeCholesky<Dim, Scalar> factor;
    };

    std::shared_ptr<const Rest> m_rest;
    std::optional<detail::NodeRotations<Dim, Scalar>> m_rotations;
};

} // namespace springfit

#include <springfit/solve/detail/corotated_preconditioner_impl.hpp>
