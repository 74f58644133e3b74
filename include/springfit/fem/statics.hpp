// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <type_traits>

#include <springfit/fem/model.hpp>
#include <springfit/motion/state.hpp>
#include <springfit/solve/newton.hpp>

namespace springfit::fem {

template <std::floating_point Scalar>
struct StaticsOptions {
    /// Largest force left out of balance, relative to the largest external or internal force of the start, in (0, 1).
    Scalar tolerance = std::sqrt(std::numeric_limits<Scalar>::epsilon());
    int max_iterations = 60; ///< Newton iterations per load step, >= 1
    int max_halvings = 8;    ///< how often a load step may be halved before giving up, >= 0
};

/// How a static solution ended.
template <int Dim, std::floating_point Scalar>
struct StaticsReport {
    State<Dim, Scalar> state;       ///< at rest: no velocity, no acceleration
    Status status = Status::failed; ///< other than `converged`: the state is in balance with the part `load` only
    int iterations = 0;             ///< of Newton's method, all load steps together
    int load_steps = 0;             ///< that were solved; 1 where the full load went in one piece
    Scalar load = 0;                ///< part of the loads and of the clamps' way that is on, in [0, 1]
    Scalar residual = 0;            ///< largest component of force out of balance on a free node, N
};

/// The static equilibrium of a model under the loads and clamps of a scenario at `time`: f_int(x) = f_ext.
///
/// Loads are dead: they keep direction and size. Newton's method with line search minimises the potential energy; where
/// the full load fails, loads and clamp displacements are put on in steps. `start` is a first guess `[Dim x n_nodes]`,
/// such as a neighbouring solution; empty: the scenario's initial positions. Throws InvalidArgument for a scenario that
/// does not fit the model.
template <class M>
[[nodiscard]] StaticsReport<M::dimension, typename M::Scalar>
equilibrium(const M& model, const Scenario<M::dimension, typename M::Scalar>& scenario,
            std::type_identity_t<typename M::Scalar> time = 0,
            const StaticsOptions<std::type_identity_t<typename M::Scalar>>& options = {},
            const Points<M::dimension, typename M::Scalar>& start = {});

} // namespace springfit::fem

#include <springfit/fem/detail/statics.hpp>
