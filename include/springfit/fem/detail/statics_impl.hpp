// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>

#include <springfit/fem/statics.hpp>
#include <springfit/mesh/topology.hpp>

namespace springfit::fem {

namespace detail {

/// Iterations of conjugate gradients with the diagonal that cost less than one sparse factorisation of a solid.
inline constexpr int diagonal_iterations = 2000;

/// Rounding of the forces at positions x: what no iteration can lower, N.
template <int Dim, std::floating_point Scalar>
Scalar force_rounding(const SymmetricMatrix<Scalar>& stiffness, const Points<Dim, Scalar>& x) {
    if (stiffness.size() == 0) {
        return 0;
    }
    return 8 * std::numeric_limits<Scalar>::epsilon() * stiffness.diagonal().cwiseAbs().maxCoeff() *
           x.cwiseAbs().maxCoeff();
}

/// Pairs of nodes that share a cell, each once `[2 x n_pairs]`.
inline NodePairs pairs_in_cells(const Cliques& cells) {
    std::vector<std::array<int, 2>> pairs;
    for (const auto& cell : cells) {
        for (std::size_t b = 1; b < cell.size(); ++b) {
            for (std::size_t a = 0; a < b; ++a) {
                pairs.push_back({std::min(cell[a], cell[b]), std::max(cell[a], cell[b])});
            }
        }
    }
    return springfit::detail::sorted_unique_pairs(pairs);
}

/// The factor of stiffness_part K + mass_part M, K the stiffness at rest of the body's preconditioner. Membranes, whose
/// stiffness is singular where they are flat, have none.
template <int Dim, std::floating_point Scalar>
CorotatedPreconditioner<Dim, Scalar> rest_factor(const ElasticBody<Dim, Scalar>& body, const FreeNodes& free,
                                                 Scalar stiffness_part = 1, Scalar mass_part = 0) {
    if (body.kind().is_membrane) {
        return {};
    }
    const auto plain = body.preconditioner();
    auto stiffness = plain->make_stiffness(free);
    plain->assemble(plain->rest_positions(), stiffness);
    stiffness.combine(stiffness_part, mass_part, body.masses());
    return CorotatedPreconditioner<Dim, Scalar>(stiffness.matrix().lower(), free, pairs_in_cells(body.cells()),
                                                body.rest_positions());
}

/// The potential energy W(x) - f_ext . (x - x_rest) over the free coordinates: a model of SmoothProblem.
template <int Dim, std::floating_point ScalarType>
class PotentialEnergy {
public:
    using Scalar = ScalarType;
    using Nodes = Points<Dim, Scalar>;

    PotentialEnergy(const ElasticBody<Dim, Scalar>& body, const FreeNodes& free)
        : m_body(&body), m_free(free), m_stiffness(body.make_stiffness(free)) {}

    Nodes nodes;           ///< positions of all nodes; the clamped ones stay as set
    Nodes external_forces; ///< on all nodes

    [[nodiscard]] Scalar energy(const Values<Scalar>& values) {
        m_free.scatter(values, nodes);
        return m_body->energy(nodes) - external_forces.cwiseProduct(nodes - m_body->rest_positions()).sum();
    }
    [[nodiscard]] Scalar energy_rounding() const { return m_body->energy_rounding(); }
    /// Positions of all nodes for the free coordinates, m.
    [[nodiscard]] const Nodes& positions(const Values<Scalar>& values) {
        m_free.scatter(values, nodes);
        return nodes;
    }
    void gradient(const Values<Scalar>& values, Values<Scalar>& gradient) {
        const Nodes unbalanced = m_body->internal_forces(positions(values)) - external_forces;
        gradient = m_free.template gather<Dim, Scalar>(unbalanced);
    }
    [[nodiscard]] SymmetricMatrix<Scalar> hessian(const Values<Scalar>& values) {
        m_body->assemble(positions(values), m_stiffness);
        return m_stiffness.matrix();
    }

private:
    const ElasticBody<Dim, Scalar>* m_body;
    FreeNodes m_free;
    Stiffness<Dim, Scalar> m_stiffness;
};

} // namespace detail

template <int Dim, std::floating_point S>
Statics<Dim, S>::Statics(std::shared_ptr<const ElasticBody<Dim, S>> body, const StaticsOptions<S>& options)
    : m_body(std::move(body)), m_options(options) {
    require(options.tolerance > 0 && options.tolerance < 1, "tolerance", "a value in (0, 1)", options.tolerance);
    require(options.max_iterations >= 1, "max_iterations", "at least one iteration", options.max_iterations);
    require(options.max_halvings >= 0, "max_halvings", "a number not below 0", options.max_halvings);
    const bool is_plane = !m_body->kind().is_solid && !m_body->kind().is_membrane;
    m_solver.fallback().set_max_diagonal_iterations(is_plane ? 0 : detail::diagonal_iterations);
}

template <int Dim, std::floating_point S>
void Statics<Dim, S>::use_clamps(const Scenario<Dim, S>& scenario) {
    springfit::validate(scenario, rest_positions().cols());
    std::vector<int> clamped = clamped_nodes(scenario, rest_positions().cols());
    if (!m_potential || clamped != m_clamped) {
        m_clamped = std::move(clamped);
        m_free = FreeNodes(rest_positions().cols(), m_clamped);
        m_potential = std::make_shared<detail::PotentialEnergy<Dim, S>>(*m_body, m_free);
        m_solver.set_factor(detail::rest_factor(*m_body, m_free));
    }
}

/// Forces on the free nodes that a small displacement `way` of the clamped ones puts out of balance, K_fc u_c.
template <int Dim, std::floating_point S>
auto Statics<Dim, S>::clamp_forces(const Nodes& x, const Nodes& way) const -> Values<S> {
    const S largest = way.cwiseAbs().maxCoeff();
    if (!(largest > 0)) {
        return Values<S>::Zero(Dim * m_free.n_free());
    }
    const S size = (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
    const S h = std::cbrt(std::numeric_limits<S>::epsilon()) * size / largest;
    const Nodes change = (m_body->internal_forces(x + h * way) - m_body->internal_forces(x - h * way)) / (2 * h);
    return m_free.template gather<Dim, S>(change);
}

/// Moves the free nodes along with a displacement of the clamped ones, to first order: K_ff u_f = -K_fc u_c. Without
/// it, cells at the clamps would be crushed before Newton's method starts. Where that fails or leads to positions that
/// the material does not allow, only the clamped nodes move.
template <int Dim, std::floating_point S>
auto Statics<Dim, S>::follow_clamps(const Nodes& x, const Nodes& moved) -> Nodes {
    if (x == moved || m_free.n_free() == 0) {
        return moved;
    }
    const Values<S> push = -clamp_forces(x, moved - x);
    const Values<S> values = m_free.template gather<Dim, S>(x);
    Values<S> follow;
    m_solver.restart();
    m_solver.turn(x);
    if (push.allFinite() && m_solver.solve(m_potential->hessian(values), push, follow, S(1e-3))) {
        Nodes followed = moved;
        m_free.template scatter<Dim, S>(values + follow, followed);
        if (std::isfinite(m_body->energy(followed))) {
            return followed;
        }
    }
    return moved;
}

template <int Dim, std::floating_point S>
Status Statics<Dim, S>::linear_response(const Scenario<Dim, S>& scenario, S time, Nodes& displacement) {
    use_clamps(scenario);
    const Nodes& rest = rest_positions();
    Nodes moved = rest;
    apply_clamps<Dim, S>(scenario, rest, time, moved);
    displacement = moved - rest;
    if (m_free.n_free() == 0) {
        return Status::converged;
    }
    const Nodes loads = external_forces<Dim, S>(scenario, masses(), time);
    const Values<S> push = m_free.template gather<Dim, S>(loads) - clamp_forces(rest, displacement);
    m_potential->nodes = rest;
    const auto stiffness = m_potential->hessian(m_free.template gather<Dim, S>(rest));
    Values<S> values;
    Values<S> held(push.size());
    m_solver.restart();
    m_solver.turn(rest);
    if (!m_solver.solve(stiffness, push, values, m_options.tolerance)) {
        return Status::failed;
    }
    stiffness.multiply(values, held);
    if (!((held - push).norm() <= S(0.01) * push.norm())) { // the solver had to shift a singular matrix
        return Status::failed;
    }
    m_free.template scatter<Dim, S>(values, displacement);
    return Status::converged;
}

template <int Dim, std::floating_point S>
Status Statics<Dim, S>::solve_equilibrium(const Scenario<Dim, S>& scenario, S time, Nodes& positions) {
    Nodes start;
    if (m_body->kind().is_linear) {
        if (linear_response(scenario, time, start) != Status::converged) {
            start.resize(Dim, 0);
        } else {
            start += rest_positions();
        }
    }
    auto report = equilibrium(scenario, time, start);
    positions = std::move(report.state.positions);
    return report.status;
}

template <int Dim, std::floating_point S>
auto Statics<Dim, S>::equilibrium(const Scenario<Dim, S>& scenario, S time, const Nodes& start)
    -> StaticsReport<Dim, S> {
    use_clamps(scenario);
    const Nodes& rest = rest_positions();
    require(start.size() == 0 || start.cols() == rest.cols(), "start", text(rest.cols(), " columns, one per node"),
            start.cols());
    const Nodes full_load = external_forces<Dim, S>(scenario, masses(), time);
    Nodes x = start.size() > 0 ? start : (scenario.initial_positions.size() > 0 ? scenario.initial_positions : rest);
    Nodes goal = x;
    apply_clamps<Dim, S>(scenario, rest, time, goal);
    const Nodes clamps_way = goal - x;

    StaticsReport<Dim, S> report;
    S step = 1;
    for (int halvings = 0; report.load < 1;) {
        const S load = std::min(S(1), report.load + step);
        m_potential->nodes = x;
        m_potential->external_forces = load * full_load;
        Nodes trial = follow_clamps(x, x + (load - report.load) * clamps_way);
        m_potential->nodes = trial;
        Values<S> values = m_free.template gather<Dim, S>(trial);
        const S largest =
            std::max(full_load.cwiseAbs().maxCoeff(), m_body->internal_forces(trial).cwiseAbs().maxCoeff());
        NewtonOptions<S> newton{.max_iterations = m_options.max_iterations};
        newton.linear_tolerance = S(1e-3);
        newton.loose_tolerance = S(0.1);
        m_solver.restart();
        newton.gradient_tolerance = m_options.tolerance * largest;
        if (std::isfinite(largest)) {
            newton.gradient_tolerance =
                std::max(newton.gradient_tolerance, detail::force_rounding(m_potential->hessian(values), trial));
        }
        const auto solved = minimise(*m_potential, values, m_solver, newton);
        report.iterations += solved.iterations;
        report.status = solved.status;
        report.residual = solved.gradient_max;
        if (solved.status == Status::converged) {
            m_free.template scatter<Dim, S>(values, trial);
            x = trial;
            report.load = load;
            ++report.load_steps;
            step *= 2;
        } else if (halvings++ < m_options.max_halvings) {
            step /= 2;
        } else {
            break;
        }
    }
    report.state.time = time;
    report.state.positions = x;
    report.state.velocities.setZero(Dim, x.cols());
    report.state.accelerations.setZero(Dim, x.cols());
    return report;
}

} // namespace springfit::fem
