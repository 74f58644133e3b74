// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <type_traits>

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

/// The potential energy W(x) - f_ext . (x - x_rest) over the free coordinates: a model of SmoothProblem.
template <class M>
class PotentialEnergy {
public:
    static constexpr int dimension = M::dimension;
    using Scalar = typename M::Scalar;
    using Nodes = Points<dimension, Scalar>;

    PotentialEnergy(const M& model, const FreeNodes& free)
        : m_model(&model), m_free(free), m_stiffness(model.make_stiffness(free)) {}

    Nodes positions;       ///< of all nodes; the clamped ones stay as set
    Nodes external_forces; ///< on all nodes

    [[nodiscard]] Scalar energy(const Values<Scalar>& values) {
        m_free.scatter(values, positions);
        return m_model->energy(positions) -
               external_forces.cwiseProduct(positions - m_model->rest_positions()).sum();
    }
    [[nodiscard]] Scalar energy_rounding() const { return m_model->energy_rounding(); }
    void gradient(const Values<Scalar>& values, Values<Scalar>& gradient) {
        m_free.scatter(values, positions);
        const Nodes unbalanced = m_model->internal_forces(positions) - external_forces;
        gradient = m_free.template gather<dimension, Scalar>(unbalanced);
    }
    [[nodiscard]] SymmetricMatrix<Scalar> hessian(const Values<Scalar>& values) {
        m_free.scatter(values, positions);
        m_model->assemble(positions, m_stiffness);
        return m_stiffness.matrix();
    }

private:
    const M* m_model;
    FreeNodes m_free;
    Stiffness<dimension, Scalar> m_stiffness;
};

/// Moves the free nodes along with a displacement of the clamped ones, to first order: K_ff u_f = -K_fc u_c. Without
/// it, cells at the clamps would be crushed before Newton's method starts. Where that fails or leads to positions that
/// the material does not allow, only the clamped nodes move.
template <class M>
[[nodiscard]] Points<M::dimension, typename M::Scalar>
follow_clamps(const M& model, const FreeNodes& free, PotentialEnergy<M>& potential,
              SymmetricSolver<typename M::Scalar>& solver, const Points<M::dimension, typename M::Scalar>& x,
              const Points<M::dimension, typename M::Scalar>& moved) {
    constexpr int dim = M::dimension;
    using Scalar = typename M::Scalar;
    const Points<dim, Scalar> way = moved - x; // of the clamped nodes, 0 elsewhere
    const Scalar largest = way.cwiseAbs().maxCoeff();
    const Scalar size = (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
    if (!(largest > 0) || free.n_free() == 0) {
        return moved;
    }
    const Scalar h = std::cbrt(std::numeric_limits<Scalar>::epsilon()) * size / largest;
    const Points<dim, Scalar> change =
        (model.internal_forces(x + h * way) - model.internal_forces(x - h * way)) / (2 * h);
    const Values<Scalar> push = -free.template gather<dim, Scalar>(change);
    Values<Scalar> values = free.template gather<dim, Scalar>(x);
    Values<Scalar> follow;
    if (push.allFinite() && solver.solve(potential.hessian(values), push, follow, Scalar(1e-3))) {
        Points<dim, Scalar> followed = moved;
        free.template scatter<dim, Scalar>(values + follow, followed);
        if (std::isfinite(model.energy(followed))) {
            return followed;
        }
    }
    return moved;
}

} // namespace detail

template <class M>
StaticsReport<M::dimension, typename M::Scalar>
equilibrium(const M& model, const Scenario<M::dimension, typename M::Scalar>& scenario,
            std::type_identity_t<typename M::Scalar> time,
            const StaticsOptions<std::type_identity_t<typename M::Scalar>>& options,
            const Points<M::dimension, typename M::Scalar>& start) {
    constexpr int dim = M::dimension;
    using Scalar = typename M::Scalar;
    const auto& rest = model.rest_positions();
    require(options.tolerance > 0 && options.tolerance < 1, "tolerance", "a value in (0, 1)", options.tolerance);
    require(options.max_iterations >= 1, "max_iterations", "at least one iteration", options.max_iterations);
    require(options.max_halvings >= 0, "max_halvings", "a number not below 0", options.max_halvings);
    require(start.size() == 0 || start.cols() == rest.cols(), "start", text(rest.cols(), " columns, one per node"),
            start.cols());
    springfit::validate(scenario, rest.cols());

    const FreeNodes free(rest.cols(), clamped_nodes(scenario, rest.cols()));
    const Points<dim, Scalar> full_load = external_forces<dim, Scalar>(scenario, model.masses(), time);
    Points<dim, Scalar> x =
        start.size() > 0 ? start : (scenario.initial_positions.size() > 0 ? scenario.initial_positions : rest);
    Points<dim, Scalar> goal = x;
    apply_clamps<dim, Scalar>(scenario, rest, time, goal);
    const Points<dim, Scalar> clamps_way = goal - x;

    detail::PotentialEnergy<M> potential(model, free);
    SymmetricSolver<Scalar> solver;
    solver.set_max_diagonal_iterations(detail::diagonal_iterations);

    StaticsReport<dim, Scalar> report;
    Scalar step = 1;
    for (int halvings = 0; report.load < 1;) {
        const Scalar load = std::min(Scalar(1), report.load + step);
        potential.positions = x;
        potential.external_forces = load * full_load;
        Points<dim, Scalar> trial =
            detail::follow_clamps<M>(model, free, potential, solver, x, x + (load - report.load) * clamps_way);
        potential.positions = trial;
        Values<Scalar> values = free.template gather<dim, Scalar>(trial);
        const Scalar largest = std::max(full_load.cwiseAbs().maxCoeff(),
                                        model.internal_forces(trial).cwiseAbs().maxCoeff());
        NewtonOptions<Scalar> newton{.max_iterations = options.max_iterations};
        newton.linear_tolerance = Scalar(1e-3);
        newton.gradient_tolerance = options.tolerance * largest;
        if (std::isfinite(largest)) {
            newton.gradient_tolerance =
                std::max(newton.gradient_tolerance, detail::force_rounding(potential.hessian(values), trial));
        }
        const auto solved = minimise(potential, values, solver, newton);
        report.iterations += solved.iterations;
        report.status = solved.status;
        report.residual = solved.gradient_max;
        if (solved.status == Status::converged) {
            free.template scatter<dim, Scalar>(values, trial);
            x = trial;
            report.load = load;
            ++report.load_steps;
            step *= 2;
        } else if (halvings++ < options.max_halvings) {
            step /= 2;
        } else {
            break;
        }
    }
    report.state.time = time;
    report.state.positions = x;
    report.state.velocities.setZero(dim, x.cols());
    report.state.accelerations.setZero(dim, x.cols());
    return report;
}

} // namespace springfit::fem
