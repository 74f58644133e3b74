// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>

#include <springfit/fem/statics.hpp>

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
template <class CellNodes>
NodePairs pairs_in_cells(const CellNodes& cells) {
    std::vector<std::pair<int, int>> pairs;
    pairs.reserve(static_cast<std::size_t>(cells.cols() * cells.rows() * (cells.rows() - 1) / 2));
    for (Index c = 0; c < cells.cols(); ++c) {
        for (Index b = 1; b < cells.rows(); ++b) {
            for (Index a = 0; a < b; ++a) {
                pairs.push_back(std::minmax<int>({cells(a, c), cells(b, c)}));
            }
        }
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    NodePairs result(2, static_cast<Index>(pairs.size()));
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        result.col(static_cast<Index>(p)) << pairs[p].first, pairs[p].second;
    }
    return result;
}

/// The factor of the model's stiffness at rest, with Poisson's ratio at most 0.4 and the dilatation of each point on
/// its own: patches would fill it, and the plain elements' is as good a preconditioner. Membranes, whose stiffness is
/// singular where they are flat, have none.
template <class M>
TurnedFactor<M::dimension, typename M::Scalar> rest_factor(const M& model, const FreeNodes& free) {
    using Scalar = typename M::Scalar;
    if constexpr (M::is_membrane) {
        return {};
    } else {
        auto material = model.material();
        material.poisson = std::min(material.poisson, decltype(material.poisson)(0.4));
        auto options = model.options();
        options.dilatation = Dilatation::pointwise;
        const M plain(model.mesh(), material, model.density(), options);
        auto stiffness = plain.make_stiffness(free);
        plain.assemble(plain.rest_positions(), stiffness);
        return TurnedFactor<M::dimension, Scalar>(stiffness.matrix().lower(), free, pairs_in_cells(model.mesh().cells),
                                                  model.rest_positions());
    }
}

/// The potential energy W(x) - f_ext . (x - x_rest) over the free coordinates: a model of SmoothProblem.
template <class M>
class PotentialEnergy {
public:
    static constexpr int dimension = M::dimension;
    using Scalar = typename M::Scalar;
    using Nodes = Points<dimension, Scalar>;

    PotentialEnergy(const M& model, const FreeNodes& free)
        : m_model(&model), m_free(free), m_stiffness(model.make_stiffness(free)) {}

    Nodes nodes;           ///< positions of all nodes; the clamped ones stay as set
    Nodes external_forces; ///< on all nodes

    [[nodiscard]] Scalar energy(const Values<Scalar>& values) {
        m_free.scatter(values, nodes);
        return m_model->energy(nodes) - external_forces.cwiseProduct(nodes - m_model->rest_positions()).sum();
    }
    [[nodiscard]] Scalar energy_rounding() const { return m_model->energy_rounding(); }
    /// Where all nodes are for the free coordinates, m.
    [[nodiscard]] const Nodes& positions(const Values<Scalar>& values) {
        m_free.scatter(values, nodes);
        return nodes;
    }
    void gradient(const Values<Scalar>& values, Values<Scalar>& gradient) {
        const Nodes unbalanced = m_model->internal_forces(positions(values)) - external_forces;
        gradient = m_free.template gather<dimension, Scalar>(unbalanced);
    }
    [[nodiscard]] SymmetricMatrix<Scalar> hessian(const Values<Scalar>& values) {
        m_model->assemble(positions(values), m_stiffness);
        return m_stiffness.matrix();
    }

private:
    const M* m_model;
    FreeNodes m_free;
    Stiffness<dimension, Scalar> m_stiffness;
};

} // namespace detail

template <class M>
Statics<M>::Statics(M model, const StaticsOptions<Scalar>& options) : m_model(std::move(model)), m_options(options) {
    require(options.tolerance > 0 && options.tolerance < 1, "tolerance", "a value in (0, 1)", options.tolerance);
    require(options.max_iterations >= 1, "max_iterations", "at least one iteration", options.max_iterations);
    require(options.max_halvings >= 0, "max_halvings", "a number not below 0", options.max_halvings);
    const bool is_plane = !M::is_solid && !M::is_membrane;
    m_solver.fallback().set_max_diagonal_iterations(is_plane ? 0 : detail::diagonal_iterations);
}

template <class M>
void Statics<M>::use_clamps(const Scenario<dimension, Scalar>& scenario) {
    springfit::validate(scenario, rest_positions().cols());
    std::vector<int> clamped = clamped_nodes(scenario, rest_positions().cols());
    if (!m_potential || clamped != m_clamped) {
        m_clamped = std::move(clamped);
        m_free = FreeNodes(rest_positions().cols(), m_clamped);
        m_potential.emplace(m_model, m_free);
        m_solver.set_factor(detail::rest_factor(m_model, m_free));
    }
}

/// Forces on the free nodes that a small displacement `way` of the clamped ones puts out of balance, K_fc u_c.
template <class M>
auto Statics<M>::clamp_forces(const Nodes& x, const Nodes& way) const -> Values<Scalar> {
    const Scalar largest = way.cwiseAbs().maxCoeff();
    if (!(largest > 0)) {
        return Values<Scalar>::Zero(dimension * m_free.n_free());
    }
    const Scalar size = (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
    const Scalar h = std::cbrt(std::numeric_limits<Scalar>::epsilon()) * size / largest;
    const Nodes change = (m_model.internal_forces(x + h * way) - m_model.internal_forces(x - h * way)) / (2 * h);
    return m_free.template gather<dimension, Scalar>(change);
}

/// Moves the free nodes along with a displacement of the clamped ones, to first order: K_ff u_f = -K_fc u_c. Without
/// it, cells at the clamps would be crushed before Newton's method starts. Where that fails or leads to positions that
/// the material does not allow, only the clamped nodes move.
template <class M>
auto Statics<M>::follow_clamps(const Nodes& x, const Nodes& moved) -> Nodes {
    if (x == moved || m_free.n_free() == 0) {
        return moved;
    }
    const Values<Scalar> push = -clamp_forces(x, moved - x);
    const Values<Scalar> values = m_free.template gather<dimension, Scalar>(x);
    Values<Scalar> follow;
    m_solver.restart();
    m_solver.turn(x);
    if (push.allFinite() && m_solver.solve(m_potential->hessian(values), push, follow, Scalar(1e-3))) {
        Nodes followed = moved;
        m_free.template scatter<dimension, Scalar>(values + follow, followed);
        if (std::isfinite(m_model.energy(followed))) {
            return followed;
        }
    }
    return moved;
}

template <class M>
Status Statics<M>::linear_response(const Scenario<dimension, Scalar>& scenario, Scalar time, Nodes& displacement) {
    use_clamps(scenario);
    const Nodes& rest = rest_positions();
    Nodes moved = rest;
    apply_clamps<dimension, Scalar>(scenario, rest, time, moved);
    displacement = moved - rest;
    if (m_free.n_free() == 0) {
        return Status::converged;
    }
    const Nodes loads = external_forces<dimension, Scalar>(scenario, masses(), time);
    const Values<Scalar> push = m_free.template gather<dimension, Scalar>(loads) - clamp_forces(rest, displacement);
    m_potential->nodes = rest;
    const auto stiffness = m_potential->hessian(m_free.template gather<dimension, Scalar>(rest));
    Values<Scalar> values;
    Values<Scalar> held(push.size());
    m_solver.restart();
    m_solver.turn(rest);
    if (!m_solver.solve(stiffness, push, values, m_options.tolerance)) {
        return Status::failed;
    }
    stiffness.multiply(values, held);
    if (!((held - push).norm() <= Scalar(0.01) * push.norm())) { // the solver had to shift a singular matrix
        return Status::failed;
    }
    m_free.template scatter<dimension, Scalar>(values, displacement);
    return Status::converged;
}

template <class M>
Status Statics<M>::balance(const Scenario<dimension, Scalar>& scenario, Scalar time, Nodes& positions) {
    Nodes start;
    if constexpr (M::is_linear) {
        if (linear_response(scenario, time, start) != Status::converged) {
            start.resize(dimension, 0);
        } else {
            start += rest_positions();
        }
    }
    auto report = equilibrium(scenario, time, start);
    positions = std::move(report.state.positions);
    return report.status;
}

template <class M>
auto Statics<M>::equilibrium(const Scenario<dimension, Scalar>& scenario, Scalar time, const Nodes& start)
    -> StaticsReport<dimension, Scalar> {
    use_clamps(scenario);
    const Nodes& rest = rest_positions();
    require(start.size() == 0 || start.cols() == rest.cols(), "start", text(rest.cols(), " columns, one per node"),
            start.cols());
    const Nodes full_load = external_forces<dimension, Scalar>(scenario, masses(), time);
    Nodes x = start.size() > 0 ? start : (scenario.initial_positions.size() > 0 ? scenario.initial_positions : rest);
    Nodes goal = x;
    apply_clamps<dimension, Scalar>(scenario, rest, time, goal);
    const Nodes clamps_way = goal - x;

    StaticsReport<dimension, Scalar> report;
    Scalar step = 1;
    for (int halvings = 0; report.load < 1;) {
        const Scalar load = std::min(Scalar(1), report.load + step);
        m_potential->nodes = x;
        m_potential->external_forces = load * full_load;
        Nodes trial = follow_clamps(x, x + (load - report.load) * clamps_way);
        m_potential->nodes = trial;
        Values<Scalar> values = m_free.template gather<dimension, Scalar>(trial);
        const Scalar largest =
            std::max(full_load.cwiseAbs().maxCoeff(), m_model.internal_forces(trial).cwiseAbs().maxCoeff());
        NewtonOptions<Scalar> newton{.max_iterations = m_options.max_iterations};
        newton.linear_tolerance = Scalar(1e-3);
        newton.loose_tolerance = Scalar(0.1);
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
            m_free.template scatter<dimension, Scalar>(values, trial);
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
    report.state.velocities.setZero(dimension, x.cols());
    report.state.accelerations.setZero(dimension, x.cols());
    return report;
}

} // namespace springfit::fem
