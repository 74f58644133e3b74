// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fem/detail/statics_impl.hpp>
#include <springfit/fem/dynamics.hpp>

namespace springfit::fem {

/// The potential whose minimum is the next step. With d = x - x_predicted and v(x) = v_predicted + c1 d (at clamped
/// nodes both predictions are the prescribed values, so that d = 0),
///     Phi = c0/2 d'Md + (1 + alpha) [W(x) - f_ext . d + v_predicted' D d + c1/2 d'Dd] + alpha (M a_n) . d
template <int Dim, std::floating_point S>
class Dynamics<Dim, S>::StepProblem {
public:
    using Scalar = S;

    StepProblem(Dynamics& dynamics, S dt) : m_dynamics(&dynamics) {
        const S alpha = dynamics.m_options.alpha;
        const S beta = (1 - alpha) * (1 - alpha) / 4;
        c0 = 1 / (beta * dt * dt);
        c1 = (S(0.5) - alpha) / (beta * dt);
        weight = 1 + alpha;
    }

    S c0;
    S c1;
    S weight;
    Nodes nodes;                ///< positions of all nodes; the clamped ones stay as set
    Nodes predicted;            ///< x_predicted
    Nodes predicted_velocities; ///< v_predicted
    Nodes constant;             ///< forces that do not depend on x: the gradient at d = 0 without inertia and W

    /// The Hessian is stiffness_part() K + mass_part() M.
    [[nodiscard]] S stiffness_part() const {
        return weight * (1 + c1 * m_dynamics->m_body->options().stiffness_damping);
    }
    [[nodiscard]] S mass_part() const { return c0 + weight * c1 * m_dynamics->m_body->options().mass_damping; }

    /// Positions of all nodes for the free coordinates, m.
    [[nodiscard]] const Nodes& positions(const Values<S>& values) {
        m_dynamics->m_free.scatter(values, nodes);
        return nodes;
    }
    [[nodiscard]] S energy(const Values<S>& values) {
        const Nodes d = displacement(values);
        const auto& body = *m_dynamics->m_body;
        const Nodes inertia_and_damping = c0 * d * body.masses().asDiagonal() + weight * c1 * m_dynamics->damped(d);
        return weight * body.energy(nodes) + inertia_and_damping.cwiseProduct(d).sum() / 2 +
               constant.cwiseProduct(d).sum();
    }
    [[nodiscard]] S energy_rounding() const { return m_dynamics->m_body->energy_rounding(); }
    void gradient(const Values<S>& values, Values<S>& gradient) {
        const Nodes d = displacement(values);
        const auto& body = *m_dynamics->m_body;
        const Nodes total = weight * (body.internal_forces(nodes) + c1 * m_dynamics->damped(d)) +
                            c0 * d * body.masses().asDiagonal() + constant;
        gradient = m_dynamics->m_free.template gather<Dim, S>(total);
    }
    /// With K(x) for K(x_n) in the damping: they differ little, and one matrix serves for both.
    [[nodiscard]] SymmetricMatrix<S> hessian(const Values<S>& values) {
        const auto& body = *m_dynamics->m_body;
        body.assemble(positions(values), m_dynamics->m_stiffness);
        m_dynamics->m_stiffness.combine(stiffness_part(), mass_part(), body.masses());
        return m_dynamics->m_stiffness.matrix();
    }

private:
    [[nodiscard]] Nodes displacement(const Values<S>& values) { return positions(values) - predicted; }

    Dynamics* m_dynamics;
};

template <int Dim, std::floating_point S>
Dynamics<Dim, S>::Dynamics(std::shared_ptr<const ElasticBody<Dim, S>> body, const DynamicsOptions<S>& options)
    : m_body(std::move(body)), m_options(options) {
    require(options.alpha >= S(-1) / 3 && options.alpha <= 0, "alpha", "a value in [-1/3, 0]", options.alpha);
    require(options.tolerance > 0 && options.tolerance < 1, "tolerance", "a value in (0, 1)", options.tolerance);
    require(options.max_iterations >= 1, "max_iterations", "at least one iteration", options.max_iterations);
    require(options.max_halvings >= 0, "max_halvings", "a number not below 0", options.max_halvings);
    m_free = FreeNodes(m_body->rest_positions().cols(), {});
    m_stiffness = m_body->make_stiffness(m_free);
    if (m_body->options().stiffness_damping > 0) {
        m_damping = m_stiffness;
    }
    m_body->assemble(m_body->rest_positions(), m_stiffness);
    m_stiffest = m_stiffness.matrix().diagonal().maxCoeff();
    m_solver.fallback().set_max_diagonal_iterations(detail::diagonal_iterations);
}

template <int Dim, std::floating_point S>
void Dynamics<Dim, S>::use_clamps(const Scenario<Dim, S>& scenario) {
    std::vector<int> clamped = clamped_nodes(scenario, m_body->rest_positions().cols());
    if (clamped != m_clamped) {
        m_clamped = std::move(clamped);
        m_free = FreeNodes(m_body->rest_positions().cols(), m_clamped);
        m_stiffness = m_body->make_stiffness(m_free);
        m_factor_step = 0;
    }
}

/// Assembles the stiffness part of the damping at these positions, unless it is there already.
template <int Dim, std::floating_point S>
void Dynamics<Dim, S>::take_damping(const Nodes& positions) {
    if (m_body->options().stiffness_damping > 0 && (m_damping_at.size() == 0 || m_damping_at != positions)) {
        m_body->assemble(positions, m_damping);
        m_damping_at = positions;
    }
}

/// D v for velocities of all nodes, N.
template <int Dim, std::floating_point S>
auto Dynamics<Dim, S>::damped(const Nodes& velocities) const -> Nodes {
    Nodes forces = m_body->options().mass_damping * velocities * m_body->masses().asDiagonal();
    if (m_body->options().stiffness_damping > 0) {
        Values<S> product;
        m_damping.matrix().multiply(velocities.reshaped(), product);
        forces.reshaped() += m_body->options().stiffness_damping * product;
    }
    return forces;
}

/// Sets the accelerations of the free nodes from the balance of forces at the state itself.
template <int Dim, std::floating_point S>
void Dynamics<Dim, S>::update_accelerations(State<Dim, S>& state, const Scenario<Dim, S>& scenario) {
    take_damping(state.positions);
    const Nodes forces = external_forces<Dim, S>(scenario, m_body->masses(), state.time) -
                         m_body->internal_forces(state.positions) - damped(state.velocities);
    for (int node : m_free.nodes()) {
        state.accelerations.col(node) = forces.col(node) / m_body->masses()(node);
    }
}

template <int Dim, std::floating_point S>
auto Dynamics<Dim, S>::start(const Scenario<Dim, S>& scenario) -> State<Dim, S> {
    springfit::validate(scenario, m_body->rest_positions().cols());
    use_clamps(scenario);
    State<Dim, S> state;
    state.positions = initial_positions<Dim, S>(scenario, m_body->rest_positions());
    state.velocities = initial_velocities<Dim, S>(scenario, m_body->rest_positions());
    state.accelerations.setZero(Dim, state.positions.cols());
    update_accelerations(state, scenario);
    m_last = state;
    return state;
}

template <int Dim, std::floating_point S>
Status Dynamics<Dim, S>::advance(State<Dim, S>& state, const Scenario<Dim, S>& scenario, S dt) {
    require(dt > 0 && std::isfinite(dt), "dt", "a positive time step", dt);
    require(state.positions.cols() == m_body->rest_positions().cols(), "state",
            text(m_body->rest_positions().cols(), " nodes"), state.positions.cols());
    use_clamps(scenario);
    State<Dim, S> moved = state;
    const Status status = step(moved, scenario, dt, m_options.max_halvings);
    if (status == Status::converged) {
        state = std::move(moved);
    }
    return status;
}

template <int Dim, std::floating_point S>
Status Dynamics<Dim, S>::step(State<Dim, S>& state, const Scenario<Dim, S>& scenario, S dt, int halvings) {
    const Status status = attempt(state, scenario, dt);
    if (status == Status::converged || halvings == 0) {
        return status;
    }
    const Status first = step(state, scenario, dt / 2, halvings - 1);
    return first == Status::converged ? step(state, scenario, dt / 2, halvings - 1) : first;
}

template <int Dim, std::floating_point S>
Status Dynamics<Dim, S>::attempt(State<Dim, S>& state, const Scenario<Dim, S>& scenario, S dt) {
    const auto masses = m_body->masses().asDiagonal();
    const S time = state.time + dt;
    const S alpha = m_options.alpha;
    const bool goes_on = m_last.positions.size() > 0 && m_last.time == state.time &&
                         m_last.positions == state.positions && m_last.velocities == state.velocities;
    const Nodes accelerations = goes_on ? m_last.accelerations : state.accelerations; // A_n
    take_damping(state.positions);

    StepProblem problem(*this, dt);
    const S inertia_share = 1 / (problem.c0 * dt * dt); // beta
    problem.predicted = state.positions + dt * state.velocities + dt * dt * (S(0.5) - inertia_share) * accelerations;
    problem.predicted_velocities = state.velocities + dt * (S(0.5) + alpha) * accelerations; // 1 - gamma
    Nodes clamped_accelerations = Nodes::Zero(Dim, state.positions.cols());
    for (const auto& clamp : scenario.clamps) {
        for (int node : clamp.nodes) {
            const Vector<Dim, S> rest = m_body->rest_positions().col(node);
            const auto at = [&](S t) -> Vector<Dim, S> { return clamp.position ? clamp.position(rest, t) : rest; };
            const S h = dt / 2;
            const Vector<Dim, S> here = at(time);
            const Vector<Dim, S> ahead = at(time + h);
            const Vector<Dim, S> behind = at(time - h);
            problem.predicted.col(node) = here;
            problem.predicted_velocities.col(node) = (ahead - behind) / (2 * h);
            clamped_accelerations.col(node) = (ahead - 2 * here + behind) / (h * h);
        }
    }
    const Nodes loads = external_forces<Dim, S>(scenario, m_body->masses(), time);
    problem.constant =
        problem.weight * (damped(problem.predicted_velocities) - loads) + alpha * state.accelerations * masses;

    // Start where constant acceleration leads, or where the body is if that is not allowed.
    problem.nodes = problem.predicted;
    for (int node : m_free.nodes()) {
        problem.nodes.col(node) += dt * dt * inertia_share * accelerations.col(node);
    }
    Values<S> x = m_free.template gather<Dim, S>(problem.nodes);
    if (!std::isfinite(problem.energy(x))) {
        x = m_free.template gather<Dim, S>(state.positions);
    }

    const auto largest = [](const Nodes& nodes) { return nodes.cwiseAbs().maxCoeff(); };
    const S scale = std::max(std::max(largest(loads), largest(m_body->internal_forces(state.positions))),
                             std::max(largest(accelerations * masses), largest(state.velocities * masses) / dt));
    const S rounding = 8 * std::numeric_limits<S>::epsilon() * (problem.c0 * m_body->masses().maxCoeff() + m_stiffest) *
                       largest(state.positions);
    NewtonOptions<S> newton{.max_iterations = m_options.max_iterations};
    newton.gradient_tolerance = std::max(m_options.tolerance * scale, rounding);
    newton.linear_tolerance = S(1e-3);
    if (m_factor_step != dt) {
        m_solver.set_factor(detail::rest_factor(*m_body, m_free, problem.stiffness_part(), problem.mass_part()));
        m_factor_step = dt;
    }
    m_solver.restart();
    const auto report = minimise(problem, x, m_solver, newton);
    m_iterations += report.iterations;
    const bool done = report.status == Status::converged ||
                      (report.status == Status::stalled && report.gradient_max <= 10 * newton.gradient_tolerance);
    if (!done) {
        return report.status;
    }

    m_free.scatter(x, problem.nodes);
    const Nodes d = problem.nodes - problem.predicted;
    state.time = time;
    state.positions = problem.nodes;
    state.velocities = problem.predicted_velocities + problem.c1 * d;
    state.accelerations = clamped_accelerations;
    m_last = state;
    for (int node : m_free.nodes()) {
        m_last.accelerations.col(node) = problem.c0 * d.col(node);
    }
    update_accelerations(state, scenario);
    return Status::converged;
}

} // namespace springfit::fem
