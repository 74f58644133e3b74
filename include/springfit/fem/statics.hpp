// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <type_traits>

#include <springfit/fem/model.hpp>
#include <springfit/motion/state.hpp>
#include <springfit/solve/newton.hpp>
#include <springfit/solve/turned_solver.hpp>

namespace springfit::fem {

namespace detail {

template <class M>
class PotentialEnergy;

} // namespace detail

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

/// Static equilibria of a model under one load case after another.
///
/// The pattern of the stiffness and its factor at rest are kept for as long as the same nodes are clamped, so sort many
/// load cases by their clamps. Linear systems are solved by conjugate gradients with that factor, turned with the body
/// (`TurnedSolver`); those of membranes, whose stiffness may be singular, with the diagonal: a flat one answers loads
/// in its plane. A model of the concept StaticSolver.
template <class M>
class Statics {
public:
    static constexpr int dimension = M::dimension;
    using Scalar = typename M::Scalar;
    using Nodes = Points<dimension, Scalar>; ///< [Dim x n_nodes]

    /// Keeps a copy of the model. Throws InvalidArgument for an option out of its range.
    explicit Statics(M model, const StaticsOptions<Scalar>& options = {});
    Statics(const Statics&) = delete;
    Statics& operator=(const Statics&) = delete;

    [[nodiscard]] const M& model() const { return m_model; }
    [[nodiscard]] const Points<dimension, Scalar>& rest_positions() const { return m_model.rest_positions(); }
    [[nodiscard]] const Values<Scalar>& masses() const { return m_model.masses(); }

    /// The equilibrium f_int(x) = f_ext at `time`; see the function of this name.
    [[nodiscard]] StaticsReport<dimension, Scalar> equilibrium(const Scenario<dimension, Scalar>& scenario,
                                                               Scalar time = 0, const Nodes& start = {});

    /// The same for the concept StaticSolver: `positions` `[Dim x n_nodes]` are what `equilibrium` ends with.
    Status balance(const Scenario<dimension, Scalar>& scenario, Scalar time, Nodes& positions);

    /// The answer to small loads and clamp displacements, K u = f_ext with K at the rest positions: displacement
    /// `[Dim x n_nodes]`, m, to a relative residual of `tolerance` of the options. Status `failed` where the clamps do
    /// not hold the body.
    Status linear_response(const Scenario<dimension, Scalar>& scenario, Scalar time, Nodes& displacement);

private:
    void use_clamps(const Scenario<dimension, Scalar>& scenario);
    [[nodiscard]] Nodes follow_clamps(const Nodes& x, const Nodes& moved);
    [[nodiscard]] Values<Scalar> clamp_forces(const Nodes& x, const Nodes& way) const;

    M m_model;
    StaticsOptions<Scalar> m_options;
    std::vector<int> m_clamped;
    FreeNodes m_free;
    std::optional<detail::PotentialEnergy<M>> m_potential; ///< of m_model over m_free
    TurnedSolver<dimension, Scalar> m_solver;
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
            const Points<M::dimension, typename M::Scalar>& start = {}) {
    return Statics<M>(model, options).equilibrium(scenario, time, start);
}

/// What finds the equilibria of a model under the default options: `fem::Model` is a model of the concept
/// StaticReference.
template <int Dim, std::floating_point Scalar, FiniteElementCell Cell, Material Mat>
[[nodiscard]] Statics<Model<Dim, Scalar, Cell, Mat>> make_static_solver(const Model<Dim, Scalar, Cell, Mat>& model) {
    return Statics<Model<Dim, Scalar, Cell, Mat>>(model);
}

} // namespace springfit::fem

#include <springfit/fem/detail/statics.hpp>
