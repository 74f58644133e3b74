// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include <springfit/fit/trajectory/detail/spring_block.hpp>
#include <springfit/solve/conjugate_gradients.hpp>
#include <springfit/solve/corotated_block_preconditioner.hpp>

namespace springfit::detail {

template <class Block>
Eigen::ArrayXd column_dots(const Block& a, const Block& b) {
    return a.cwiseProduct(b).colwise().sum().transpose().array();
}

template <class Block>
Eigen::ArrayXd column_norms(const Block& a) {
    return column_dots(a, a).sqrt();
}

template <class Block>
Eigen::ArrayXd column_maxima(const Block& a) {
    return a.cwiseAbs().colwise().maxCoeff().transpose().array();
}

/// to += from diag(factors), a factor for each column.
inline void add_scaled(const ColumnBlock& from, const Eigen::ArrayXd& factors, double sign, ColumnBlock& to) {
    for_lanes(to, [&](Index row, Index column) {
        lanes(to, row, column) += lanes(from, row, column) * (sign * lanes(factors, column));
    });
}

/// True where a value of some column is above a part of the bound of that column.
inline bool any_above(const Eigen::ArrayXd& values, double part, const Eigen::ArrayXd& bounds) {
    for (Index c = 0; c < values.size(); ++c) {
        if (values(c) > part * bounds(c)) {
            return true;
        }
    }
    return false;
}

/// The equations of a static case or an implicit step, for each column of a block, over the free nodes:
///
///     w M (y - target) - f_elastic(y) + d D(old) (y - old) = external ,
///
/// w = d = 0 in statics; in a step of length s, w = 1 / s^2 and d = 1 / s. D has the springs' directions at `old`.
/// `factor` is of the same matrix at the rest shape, and preconditions, turned with the body.
template <int Dim>
struct ImplicitSystem {
    const SpringNetwork<Dim, double>& network;
    const std::vector<int>& clamped;
    const BlockCholesky& factor;
    double inertia = 0; ///< w
    double damping = 0; ///< d

    /// Sets the rows of clamped nodes to 0.
    void hold(ColumnBlock& block) const {
        for (int node : clamped) {
            block.middleRows<Dim>(Dim * node).setZero();
        }
    }

    /// The factor turned with the body to the positions y.
    [[nodiscard]] CorotatedBlockPreconditioner<Dim> preconditioner(const ColumnBlock& y) const {
        return {factor, network.springs, network.rest_positions, y};
    }

    [[nodiscard]] bool is_damped() const { return damping > 0 && (network.damping.array() > 0).any(); }

    void add_inertia(const ColumnBlock& direction, double sign, ColumnBlock& product) const {
        for (Index i = 0; inertia > 0 && i < network.n_nodes(); ++i) {
            product.middleRows<Dim>(Dim * i) += sign * inertia * network.mass(i) * direction.middleRows<Dim>(Dim * i);
        }
    }

    /// block = (w M)^-1 block, of a step.
    void divide_by_inertia(ColumnBlock& block) const {
        for (Index i = 0; i < network.n_nodes(); ++i) {
            block.middleRows<Dim>(Dim * i) /= inertia * network.mass(i);
        }
    }

    /// product = (w M + K(y) + d D(old)) direction, for a direction that leaves clamped nodes where they are.
    void multiply(const ColumnBlock& y, const ColumnBlock& old, HessianForm curvature, const ColumnBlock& direction,
                  ColumnBlock& product) const {
        product.setZero(y.rows(), y.cols());
        add_stiffness_product<Dim>(network, y, curvature, direction, product);
        add_inertia(direction, 1, product);
        if (is_damped()) {
            add_damping_product<Dim>(network, old, damping, direction, product);
        }
        hold(product);
    }

    /// The force out of balance: external + f_elastic(y) - w M (y - target) - d D(old) (y - old).
    void unbalanced(const ColumnBlock& y, const ColumnBlock& target, const ColumnBlock& old,
                    const ColumnBlock& external, ColumnBlock& force) const {
        force = external;
        add_elastic_forces<Dim>(network, y, force);
        if (inertia > 0) {
            add_inertia(y - target, -1, force);
        }
        if (is_damped()) {
            add_damping_product<Dim>(network, old, -damping, y - old, force);
        }
        hold(force);
    }

    /// The function whose gradient is minus that, per column, J.
    [[nodiscard]] Eigen::ArrayXd energy(const ColumnBlock& y, const ColumnBlock& target, const ColumnBlock& old,
                                        const ColumnBlock& external) const {
        Eigen::ArrayXd energy = elastic_energy<Dim>(network, y);
        const ColumnBlock away = y - target;
        energy -= column_dots(external, away);
        if (inertia > 0) {
            ColumnBlock force = ColumnBlock::Zero(y.rows(), y.cols());
            add_inertia(away, 0.5, force);
            energy += column_dots(force, away);
        }
        if (is_damped()) {
            const ColumnBlock moved = y - old;
            ColumnBlock force = ColumnBlock::Zero(y.rows(), y.cols());
            add_damping_product<Dim>(network, old, damping / 2, moved, force);
            energy += column_dots(force, moved);
        }
        return energy;
    }
};

/// The system of `block_conjugate_gradients`: one right-hand side per column. A column that is solved or met
/// negative curvature is out of it, and its solution stays.
template <class Factor, class Multiply>
class ColumnCg {
public:
    ColumnCg(const Factor& factor, const Multiply& multiply, const ColumnBlock& right, const Eigen::ArrayXd& goal,
             ColumnBlock& solution)
        : m_factor(factor), m_multiply(multiply), m_goal(goal), m_solution(solution), m_residual(right),
          m_active(static_cast<std::size_t>(right.cols()), 1) {
        m_solution.setZero(right.rows(), right.cols());
    }

    /// z and p at the start; r . z, or 0 where a column has nothing to solve.
    Eigen::ArrayXd start() {
        Eigen::ArrayXd rz = precondition();
        m_direction = m_z;
        for (Index c = 0; c < rz.size(); ++c) {
            m_active[static_cast<std::size_t>(c)] = rz(c) > 0 ? 1 : 0;
        }
        return rz;
    }

    /// No column has met negative curvature.
    [[nodiscard]] bool is_definite() const { return m_is_definite; }

    Eigen::ArrayXd multiply() {
        m_multiply(m_direction, m_product);
        Eigen::ArrayXd curvature = column_dots(m_direction, m_product);
        for (Index c = 0; c < curvature.size(); ++c) {
            if (is_active(c) && !(curvature(c) > 0)) {
                m_is_definite = false;
                m_active[static_cast<std::size_t>(c)] = 0;
                if (!m_has_moved) {
                    m_solution.col(c) = m_direction.col(c);
                }
            }
            curvature(c) = is_active(c) ? curvature(c) : std::numeric_limits<double>::infinity();
        }
        return curvature;
    }

    void move(const Eigen::ArrayXd& alpha) {
        m_has_moved = true;
        const Eigen::ArrayXd length = of_active(alpha);
        add_scaled(m_direction, length, 1, m_solution);
        add_scaled(m_product, length, -1, m_residual);
        const Eigen::ArrayXd left = column_dots(m_residual, m_residual).sqrt();
        for (Index c = 0; c < left.size(); ++c) {
            if (!(left(c) > m_goal(c))) {
                m_active[static_cast<std::size_t>(c)] = 0;
            }
        }
    }

    [[nodiscard]] bool is_solved() const { return std::find(m_active.begin(), m_active.end(), 1) == m_active.end(); }

    Eigen::ArrayXd precondition() {
        m_factor.solve(m_residual, m_z);
        return column_dots(m_residual, m_z);
    }

    void turn(const Eigen::ArrayXd& beta) {
        const Eigen::ArrayXd share = of_active(beta);
        for_lanes(m_direction, [&](Index row, Index column) {
            lanes(m_direction, row, column) =
                lanes(m_z, row, column) + lanes(m_direction, row, column) * lanes(share, column);
        });
    }

private:
    [[nodiscard]] bool is_active(Index column) const { return m_active[static_cast<std::size_t>(column)] != 0; }

    /// 0 for the columns that are out.
    [[nodiscard]] Eigen::ArrayXd of_active(Eigen::ArrayXd values) const {
        for (Index c = 0; c < values.size(); ++c) {
            values(c) = is_active(c) ? values(c) : 0.;
        }
        return values;
    }

    const Factor& m_factor;
    const Multiply& m_multiply;
    Eigen::ArrayXd m_goal; ///< largest |r| of a column that is solved
    ColumnBlock& m_solution;
    ColumnBlock m_residual, m_z, m_direction, m_product;
    std::vector<char> m_active;
    bool m_is_definite = true;
    bool m_has_moved = false;
};

/// Conjugate gradients on every column at once, until |residual| <= goal in each. False where some column
/// met negative curvature or did not converge; its solution is then the iterate before, a direction of descent.
template <class Factor, class Multiply>
bool block_conjugate_gradients(const Factor& factor, const Multiply& multiply, const ColumnBlock& right,
                               const Eigen::ArrayXd& goal, int max_iterations, ColumnBlock& solution) {
    ColumnCg<Factor, Multiply> system(factor, multiply, right, goal, solution);
    Eigen::ArrayXd rz = system.start();
    for (int iteration = 0; !system.is_solved(); ++iteration) {
        if (iteration == max_iterations) {
            return false;
        }
        (void)cg_iteration(system, rz); // columns that cannot go on are out
    }
    return system.is_definite();
}

/// The largest force of each column, on a node that is loaded or out of balance.
inline Eigen::ArrayXd largest_forces(const ColumnBlock& external, const Eigen::ArrayXd& unbalanced) {
    Eigen::ArrayXd largest = column_maxima(external);
    for (Index c = 0; c < largest.size(); ++c) {
        largest(c) = std::max(largest(c), unbalanced(c));
    }
    return largest;
}

/// The force out of balance at which a column counts as balanced: a part of its largest one, but no less than rounding.
template <int Dim>
Eigen::ArrayXd balance_goals(const ImplicitSystem<Dim>& system, const ColumnBlock& y, const Eigen::ArrayXd& largest) {
    constexpr double tolerance = 1e-10;
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    double stiffest = system.inertia > 0 ? system.inertia * system.network.mass.maxCoeff() : 0.;
    stiffest += system.network.stiffness.maxCoeff() + system.damping * system.network.damping.maxCoeff();
    const double rounding = 64 * epsilon * stiffest * y.cwiseAbs().maxCoeff(); // some 16 springs at a node
    Eigen::ArrayXd goal(largest.size());
    for (Index c = 0; c < goal.size(); ++c) {
        goal(c) = std::max(tolerance * largest(c), rounding);
    }
    return goal;
}

/// Takes columns that a line search no longer moves, of vanishing `length`, for balanced. False where one is not near.
inline bool settle_stuck(const Eigen::ArrayXd& length, const Eigen::ArrayXd& unbalanced, Eigen::ArrayXd& goal) {
    for (Index c = 0; c < length.size(); ++c) {
        if (length(c) > 0 && length(c) < 1e-8) {
            if (unbalanced(c) > 1e4 * goal(c)) {
                return false;
            }
            goal(c) = std::max(unbalanced(c), goal(c));
        }
    }
    return true;
}

/// Solves an implicit system for all columns by Newton's method with a line search, from `y` as it stands (clamped
/// nodes where they shall be). False where some column did not come to balance.
template <int Dim>
bool solve_implicit(const ImplicitSystem<Dim>& system, const ColumnBlock& target, const ColumnBlock& old,
                    const ColumnBlock& external, ColumnBlock& y, int max_iterations = 200) {
    ColumnBlock force;
    system.unbalanced(y, target, old, external, force);
    Eigen::ArrayXd unbalanced = column_maxima(force);
    const Eigen::ArrayXd largest = largest_forces(external, unbalanced);
    Eigen::ArrayXd goal = balance_goals(system, y, largest);
    bool near = true;
    Eigen::ArrayXd energy = system.energy(y, target, old, external);
    ColumnBlock direction;
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
        if (!force.allFinite()) { // the largest entries may have dropped a NaN
            return false;
        }
        if (!any_above(unbalanced, 1, goal)) {
            return true;
        }
        const auto factor = system.preconditioner(y);
        const auto newton_step = [&](HessianForm curvature) {
            return block_conjugate_gradients(
                factor, [&](const ColumnBlock& p, ColumnBlock& q) { system.multiply(y, old, curvature, p, q); }, force,
                1e-2 * column_norms(force), 100, direction);
        };
        // Far from balance, compressed springs make the exact curvature so indefinite that its truncated step is poor.
        near = near || !any_above(unbalanced, 1e-2, largest);
        const bool definite = near && newton_step(HessianForm::exact);
        if (!definite && any_above(unbalanced, 1e-2, largest)) {
            near = false;
            (void)newton_step(HessianForm::positive_semidefinite);
        }
        const Eigen::ArrayXd slope = column_dots(force, direction);
        const Eigen::ArrayXd norm = column_dots(force, force);
        Eigen::ArrayXd length(goal.size());
        std::transform(unbalanced.begin(), unbalanced.end(), goal.begin(), length.begin(),
                       [](double left, double aim) { return left > aim ? 1. : 0.; });
        ColumnBlock trial;
        ColumnBlock trial_force;
        Eigen::ArrayXd trial_energy;
        bool accepted = false;
        for (int halving = 0; halving < 30 && !accepted; ++halving) {
            trial = y;
            add_scaled(direction, length, 1, trial);
            trial_energy = system.energy(trial, target, old, external);
            system.unbalanced(trial, target, old, external, trial_force);
            const Eigen::ArrayXd trial_norm = column_dots(trial_force, trial_force);
            accepted = true;
            for (Index c = 0; c < length.size(); ++c) {
                const bool falls = trial_energy(c) <= energy(c) - 1e-4 * length(c) * slope(c);
                const bool nearer = definite && trial_norm(c) < norm(c) * (1 - 1e-4 * length(c));
                if (length(c) > 0 && !(falls || nearer)) {
                    length(c) /= 2;
                    accepted = false;
                }
            }
        }
        if (!accepted) { // a column at rounding, or without descent: the others go on
            if (!settle_stuck(length, unbalanced, goal)) {
                return false;
            }
            continue;
        }
        y.swap(trial);
        force.swap(trial_force);
        energy = trial_energy;
        unbalanced = column_maxima(force);
    }
    return false;
}

} // namespace springfit::detail
