// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fem/model.hpp>
#include <springfit/motion/state.hpp>
#include <springfit/solve/corotated_solver.hpp>
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

/// Implicit dynamics of a body, by the method of Hilber, Hughes and Taylor with lumped masses:
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
template <int Dim, std::floating_point ScalarType>
class Dynamics {
public:
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    /// Keeps a copy of the body, such as a `Model`. Throws InvalidArgument for an option out of its range.
    template <Elastic B>
    explicit Dynamics(B body, const DynamicsOptions<Scalar>& options = {})
        : Dynamics(std::make_shared<const B>(std::move(body)), options) {}
    /// Shares a body.
    explicit Dynamics(std::shared_ptr<const ElasticBody<Dim, Scalar>> body,
                      const DynamicsOptions<Scalar>& options = {});

    [[nodiscard]] const Points<Dim, Scalar>& rest_positions() const { return m_body->rest_positions(); }
    [[nodiscard]] const Values<Scalar>& masses() const { return m_body->masses(); }
    /// Newton iterations of all steps so far.
    [[nodiscard]] int iterations() const { return m_iterations; }

    /// The state at time 0. Throws InvalidArgument for a scenario that does not fit the body.
    [[nodiscard]] State<Dim, Scalar> start(const Scenario<Dim, Scalar>& scenario);

    /// Moves the state on by `dt` s; on any status but `converged` the state is left as it was.
    Status advance(State<Dim, Scalar>& state, const Scenario<Dim, Scalar>& scenario, Scalar dt);

private:
    using Nodes = Points<Dim, Scalar>;

    class StepProblem;

    void use_clamps(const Scenario<Dim, Scalar>& scenario);
    Status step(State<Dim, Scalar>& state, const Scenario<Dim, Scalar>& scenario, Scalar dt, int halvings);
    Status attempt(State<Dim, Scalar>& state, const Scenario<Dim, Scalar>& scenario, Scalar dt);
    [[nodiscard]] Nodes damped(const Nodes& velocities) const;
    void take_damping(const Nodes& positions);
    void update_accelerations(State<Dim, Scalar>& state, const Scenario<Dim, Scalar>& scenario);

    std::shared_ptr<const ElasticBody<Dim, Scalar>> m_body;
    DynamicsOptions<Scalar> m_options;
    std::vector<int> m_clamped;
    FreeNodes m_free;
    Stiffness<Dim, Scalar> m_stiffness; ///< over the free nodes
    Stiffness<Dim, Scalar> m_damping;   ///< K over all nodes, at m_damping_at; only with stiffness damping
    Nodes m_damping_at;
    CorotatedSolver<Dim, Scalar> m_solver;
    Scalar m_factor_step = 0;  ///< time step that its factor is for, s; 0: there is none
    State<Dim, Scalar> m_last; ///< the state left by the last step, its acceleration that of the method (A)
    Scalar m_stiffest = 0;     ///< largest diagonal entry of the stiffness at rest, N/m
    int m_iterations = 0;
};

template <Elastic B>
Dynamics(B, const DynamicsOptions<typename B::Scalar>& = {}) -> Dynamics<B::dimension, typename B::Scalar>;

/// The integrator of a body under the default options: `fem::Model` is a model of the concept Reference.
template <Elastic B>
[[nodiscard]] Dynamics<B::dimension, typename B::Scalar> make_stepper(const B& body) {
    return Dynamics<B::dimension, typename B::Scalar>(body);
}

} // namespace springfit::fem

#include <springfit/fem/detail/dynamics_impl.hpp>
