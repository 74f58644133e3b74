// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fem/model.hpp>
#include <springfit/motion/state.hpp>
#include <springfit/solve/newton.hpp>

namespace springfit::fem {

template <std::floating_point Scalar>
struct DynamicsOptions {
    /// alpha of HHT, in [-1/3, 0]: 0 is the trapezoidal rule, lower values damp the modes that dt does not resolve.
    Scalar alpha = Scalar(-0.05);
    /// Largest force left out of balance, relative to the largest external, internal or inertia force, in (0, 1).
    Scalar tolerance = std::max(Scalar(1e-6), 2000 * std::numeric_limits<Scalar>::epsilon());
    int max_iterations = 25; ///< Newton iterations per step, >= 1
    int max_halvings = 4;    ///< how often a step that fails may be halved, >= 0
};

/// Implicit dynamics of a model, by the method of Hilber, Hughes and Taylor with lumped masses:
///
///     M A + (1 + alpha) (f_int(x) + D v - f_ext)|_{n+1} - alpha (f_int(x) + D v - f_ext)|_n = 0,
///     x_{n+1} = x_n + dt v_n + dt^2 ((1/2 - beta) A_n + beta A),  v_{n+1} = v_n + dt ((1 - gamma) A_n + gamma A),
///     beta = (1 - alpha)^2 / 4,  gamma = 1/2 - alpha
///
/// Damping is Rayleigh's, D = alpha_m M + beta_k K(x_n): the stiffness part is the tangent at the start of the step, so
/// that turning the unloaded body costs nothing. Each step is a minimisation by Newton's method with line search, and
/// is halved where that fails. The states it returns carry the acceleration of the frame itself,
/// M a = f_ext - f_int(x) - D v with D at the same x; A, which is a little older, stays inside.
///
/// A model of the concept Stepper. Clamps may move: velocity and acceleration of clamped nodes are central differences.
template <class M>
class Dynamics {
public:
    static constexpr int dimension = M::dimension;
    using Scalar = typename M::Scalar;

    /// Keeps a copy of the model.
    explicit Dynamics(M model, const DynamicsOptions<Scalar>& options = {});

    [[nodiscard]] const M& model() const { return m_model; }
    [[nodiscard]] const Points<dimension, Scalar>& rest_positions() const { return m_model.rest_positions(); }
    [[nodiscard]] const Values<Scalar>& masses() const { return m_model.masses(); }
    /// Newton iterations of all steps so far.
    [[nodiscard]] int iterations() const { return m_iterations; }

    /// The state at time 0. Throws InvalidArgument for a scenario that does not fit the model.
    [[nodiscard]] State<dimension, Scalar> start(const Scenario<dimension, Scalar>& scenario);

    /// Moves the state on by `dt` s; on any status but `converged` the state is left as it was.
    Status advance(State<dimension, Scalar>& state, const Scenario<dimension, Scalar>& scenario, Scalar dt);

private:
    using Nodes = Points<dimension, Scalar>;

    class StepProblem;

    void use_clamps(const Scenario<dimension, Scalar>& scenario);
    Status step(State<dimension, Scalar>& state, const Scenario<dimension, Scalar>& scenario, Scalar dt, int halvings);
    Status attempt(State<dimension, Scalar>& state, const Scenario<dimension, Scalar>& scenario, Scalar dt);
    [[nodiscard]] Nodes damped(const Nodes& velocities) const;
    void take_damping(const Nodes& positions);
    void balance(State<dimension, Scalar>& state, const Scenario<dimension, Scalar>& scenario);

    M m_model;
    DynamicsOptions<Scalar> m_options;
    std::vector<int> m_clamped;
    FreeNodes m_free;
    Stiffness<dimension, Scalar> m_stiffness; ///< over the free nodes
    Stiffness<dimension, Scalar> m_damping;   ///< K over all nodes, at m_damping_at; only with stiffness damping
    Nodes m_damping_at;
    SymmetricSolver<Scalar> m_solver;
    State<dimension, Scalar> m_last; ///< the state left by the last step, its acceleration that of the method (A)
    Scalar m_stiffest = 0;           ///< largest diagonal entry of the stiffness at rest, N/m
    int m_iterations = 0;
};

/// The integrator of a model under the default options: `fem::Model` is a model of the concept Reference.
template <int Dim, std::floating_point Scalar, FiniteElementCell Cell, Material Mat>
[[nodiscard]] Dynamics<Model<Dim, Scalar, Cell, Mat>> make_stepper(const Model<Dim, Scalar, Cell, Mat>& model) {
    return Dynamics<Model<Dim, Scalar, Cell, Mat>>(model);
}

} // namespace springfit::fem

#include <springfit/fem/detail/dynamics.hpp>
