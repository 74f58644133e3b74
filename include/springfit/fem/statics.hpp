// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <type_traits>

#include <springfit/fem/model.hpp>
#include <springfit/motion/state.hpp>
#include <springfit/solve/corotated_solver.hpp>
#include <springfit/solve/newton.hpp>

namespace springfit::fem {

namespace detail {

template <int Dim, std::floating_point Scalar>
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

/// Static equilibria of a body under one load case after another.
///
/// The pattern of the stiffness and its factor at rest are kept for as long as the same nodes are clamped, so sort many
/// load cases by their clamps. Linear systems are solved by conjugate gradients with that factor, turned with the body
/// (`CorotatedSolver`); those of membranes, whose stiffness may be singular, with the diagonal: a flat one answers
/// loads in its plane. A model of the concept StaticSolver.
template <int Dim, std::floating_point ScalarType>
class Statics {
public:
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;
    using Nodes = Points<Dim, Scalar>; ///< [Dim x n_nodes]

    /// Keeps a copy of the body, such as a `Model`. Throws InvalidArgument for an option out of its range.
    template <Elastic B>
    explicit Statics(B body, const StaticsOptions<Scalar>& options = {})
        : Statics(std::make_shared<const B>(std::move(body)), options) {}
    /// Shares a body.
    explicit Statics(std::shared_ptr<const ElasticBody<Dim, Scalar>> body, const StaticsOptions<Scalar>& options = {});
    Statics(const Statics&) = delete;
    Statics& operator=(const Statics&) = delete;

    [[nodiscard]] const Points<Dim, Scalar>& rest_positions() const { return m_body->rest_positions(); }
    [[nodiscard]] const Values<Scalar>& masses() const { return m_body->masses(); }

    /// The equilibrium f_int(x) = f_ext at `time`; see the function of this name.
    [[nodiscard]] StaticsReport<Dim, Scalar> equilibrium(const Scenario<Dim, Scalar>& scenario, Scalar time = 0,
                                                         const Nodes& start = {});

    /// The same for the concept StaticSolver: `positions` `[Dim x n_nodes]` are what `equilibrium` ends with.
    Status solve_equilibrium(const Scenario<Dim, Scalar>& scenario, Scalar time, Nodes& positions);

    /// The answer to small loads and clamp displacements, K u = f_ext with K at the rest positions: displacement
    /// `[Dim x n_nodes]`, m, to a relative residual of `tolerance` of the options. Status `failed` where the clamps do
    /// not hold the body.
    Status linear_response(const Scenario<Dim, Scalar>& scenario, Scalar time, Nodes& displacement);

private:
    void use_clamps(const Scenario<Dim, Scalar>& scenario);
    [[nodiscard]] Nodes follow_clamps(const Nodes& x, const Nodes& moved);
    [[nodiscard]] Values<Scalar> clamp_forces(const Nodes& x, const Nodes& way) const;

    std::shared_ptr<const ElasticBody<Dim, Scalar>> m_body;
    StaticsOptions<Scalar> m_options;
    std::vector<int> m_clamped;
    FreeNodes m_free;
    std::shared_ptr<detail::PotentialEnergy<Dim, Scalar>> m_potential; ///< of m_body over m_free
    CorotatedSolver<Dim, Scalar> m_solver;
};

template <Elastic B>
Statics(B, const StaticsOptions<typename B::Scalar>& = {}) -> Statics<B::dimension, typename B::Scalar>;

/// The static equilibrium of a body under the loads and clamps of a scenario at `time`: f_int(x) = f_ext.
///
/// Loads are dead: they keep direction and size. Newton's method with line search minimises the potential energy; where
/// the full load fails, loads and clamp displacements are put on in steps. `start` is a first guess `[Dim x n_nodes]`,
/// such as a neighbouring solution; empty: the scenario's initial positions. Throws InvalidArgument for a scenario that
/// does not fit the body.
template <Elastic B>
[[nodiscard]] StaticsReport<B::dimension, typename B::Scalar>
equilibrium(const B& body, const Scenario<B::dimension, typename B::Scalar>& scenario,
            std::type_identity_t<typename B::Scalar> time = 0,
            const StaticsOptions<std::type_identity_t<typename B::Scalar>>& options = {},
            const Points<B::dimension, typename B::Scalar>& start = {}) {
    return Statics(body, options).equilibrium(scenario, time, start);
}

/// The solver for equilibria of a body under the default options: `fem::Model` is a model of the concept
/// StaticReference.
template <Elastic B>
[[nodiscard]] Statics<B::dimension, typename B::Scalar> make_static_solver(const B& body) {
    return Statics<B::dimension, typename B::Scalar>(body);
}

} // namespace springfit::fem

#include <springfit/fem/detail/statics_impl.hpp>
