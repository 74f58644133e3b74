// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include <springfit/fit/acceleration/detail/eisenstat_cg.hpp>
#include <springfit/fit/acceleration/detail/masked_cholesky.hpp>
#include <springfit/fit/acceleration/detail/node_product.hpp>

namespace springfit::detail {

/// Moves some unknowns of a quadratic to where their gradient is 0, the others held, for one set of them after another.
///
/// Conjugate gradients preconditioned by symmetric Gauss-Seidel; once sparse Cholesky is expected to take less work,
/// preconditioned by the factor of this set, or by that of an earlier one while the two differ little. What decides is
/// a count of operations, not of seconds, so that results repeat.
template <class Objective>
class ReducedSolver {
public:
    using Unknowns = typename Objective::Unknowns;

    /// `curvature` is the diagonal of H; `go_on` is asked now and then.
    ReducedSolver(const Objective& objective, const Unknowns& curvature, const Execution& execution,
                  std::function<bool()> go_on)
        : m_objective(objective), m_curvature(curvature), m_execution(execution), m_product(objective, execution),
          m_go_on(std::move(go_on)) {}

    /// Products with H; two sweeps, which look at its entries once, count as one.
    [[nodiscard]] int n_products() const { return m_n_products; }
    [[nodiscard]] int n_factorisations() const { return m_n_factorisations; }
    /// True once the factor is in use.
    [[nodiscard]] bool direct() const { return m_direct; }

    /// From now on H + ridge diag(H) in the place of H.
    void set_ridge(double ridge) {
        m_ridge = ridge;
        m_factorised.resize(0);
        m_direct = false;
        m_before = m_n_products;
    }

    /// result = H x; returns x'H x.
    double multiply(const Unknowns& x, Unknowns& result) {
        ++m_n_products;
        double square = m_product(x, result);
        if (m_ridge > 0) {
            m_terms = m_ridge * m_curvature.cwiseProduct(x);
            result += m_terms;
            square += m_terms.dot(x);
        }
        return square;
    }

    /// Largest scaled gradient |g_u| / sqrt(H_uu) of the unknowns to move: `weight` is 1 / H_uu for them, 0 for others.
    [[nodiscard]] static double largest(const Unknowns& weight, const Unknowns& gradient) {
        return weight.size() == 0 ? 0. : std::sqrt((weight.array() * gradient.array().square()).maxCoeff());
    }

    /// Moves theta, and its whole gradient along, until `largest` is not above `target` or rounding prevents that;
    /// false where `go_on` said stop. `final` is the target of the last set, from which the work to come is estimated.
    bool solve(const Unknowns& weight, double target, double final, Unknowns& theta, Unknowns& gradient) {
        m_final = final;
        if (!m_direct) {
            const Outcome outcome = by_sweeps(weight, target, theta, gradient);
            if (outcome != Outcome::slow) {
                return outcome != Outcome::stopped;
            }
            m_direct = true;
        }
        // Each unknown that changed sides since takes up to two iterations.
        const auto worth = static_cast<Index>(factor_cost() / solve_cost());
        const Index changed = m_factorised.size() == 0 ? m_curvature.size()
                                                       : ((m_factorised.array() > 0) != (weight.array() > 0)).count();
        if (2 * changed <= worth) {
            const Outcome outcome = by_factor(weight, target, theta, gradient, static_cast<int>(2 * changed + 3));
            if (outcome != Outcome::slow) {
                return outcome != Outcome::stopped;
            }
        }
        ++m_n_factorisations;
        if (!m_factor->factorise(weight, m_ridge)) {
            m_factorised.resize(0);
            return m_go_on();
        }
        m_factorised = weight;
        return by_factor(weight, target, theta, gradient, 30) != Outcome::stopped;
    }

private:
    enum class Outcome { solved, slow, stopped };
    static constexpr Index most_factorised = 250000; ///< unknowns; in solids a factor has 1000 entries for each there
    static constexpr int patience = 400;    ///< iterations in all before a factorisation is thought of: its analysis
                                            ///< takes about as long
    static constexpr double n_expected = 5; ///< factorisations until the end, once they begin
    static constexpr double iteration_slowness =
        0.5;                                      ///< time of an operation in a sweep, that in a factorisation being 1
    static constexpr double solve_slowness = 1.5; ///< the same in triangular solves

    [[nodiscard]] double factor_cost() const { return m_factor->flops(); }
    [[nodiscard]] double solve_cost() const { return solve_slowness * 4 * m_factor->n_entries(); }

    /// True where a factor is expected to be quicker, after `iterations` that made the gradient `reduced` times
    /// smaller.
    bool factor_is_quicker(int iterations, double reduced, double largest_now) {
        const int spent = m_n_products - m_before;
        if (spent < patience || iterations % 50 != 0 || m_curvature.size() > most_factorised) {
            return false;
        }
        const double rate = std::log(std::max(reduced, 1.01)) / iterations;
        const double to_come = std::max(std::log(std::max(largest_now / m_final, 10.)) / rate, 0.25 * spent);
        if (to_come < patience) {
            return false;
        }
        if (!m_factor) {
            m_factor.emplace(m_objective, m_curvature);
        }
        return m_iteration_cost * to_come > n_expected * (factor_cost() + 10 * solve_cost());
    }

    /// In single precision as long as that makes the gradient smaller: with half the numbers to move a sweep takes half
    /// the time, and the gradient that comes next is found in double precision.
    Outcome by_sweeps(const Unknowns& weight, double target, Unknowns& theta, Unknowns& gradient) {
        double size = largest(weight, gradient);
        if (size > target && !m_single && !m_double) {
            m_single.emplace(m_objective, m_curvature, m_execution);
            m_iteration_cost = iteration_slowness * (4 * static_cast<double>(m_single->n_entries()) +
                                                     30 * static_cast<double>(m_curvature.size()));
        }
        while (size > target) {
            const Outcome outcome = m_double ? by_sweeps(*m_double, weight, size, target, theta, gradient)
                                             : by_sweeps(*m_single, weight, size, target, theta, gradient);
            if (outcome != Outcome::solved) {
                return outcome;
            }
            const double before = size;
            size = largest(weight, gradient);
            if (size > std::max(target, 0.8 * before)) { // at most half of it was aimed at
                if (m_double) {
                    break; // rounding
                }
                m_single.reset();
                m_double.emplace(m_objective, m_curvature, m_execution);
            }
        }
        return Outcome::solved;
    }

    template <class Scalar>
    Outcome by_sweeps(EisenstatCg<Scalar>& gradients, const Unknowns& weight, double size, double target,
                      Unknowns& theta, Unknowns& gradient) {
        constexpr double accuracy = std::is_same_v<Scalar, float> ? 1e-4 : 1e-15;
        gradients.start(weight, gradient, m_ridge, size);
        Outcome outcome = Outcome::solved;
        double lowest = 1;
        const double goal = std::max(std::min(0.9 * target / size, 0.5), accuracy);
        for (int i = 0; gradients.largest() > goal; ++i) {
            if (i > 0 && factor_is_quicker(i, std::sqrt(1 / lowest), size * gradients.largest())) {
                outcome = Outcome::slow;
                break;
            }
            if (i % 64 == 63 && !m_go_on()) {
                outcome = Outcome::stopped;
                break;
            }
            ++m_n_products;
            if (!gradients.iterate()) {
                break;
            }
            lowest = std::min(lowest, gradients.square());
        }
        gradients.take_step(m_moved);
        theta += m_moved;
        multiply(m_moved, m_image);
        gradient += m_image;
        return outcome;
    }

    /// The passes of conjugate gradients with the factor; the residual is minus the gradient of what moves.
    struct FactorCg {
        ReducedSolver& solver;
        const Unknowns& weight;
        double target;
        Unknowns& theta;
        Unknowns& gradient;
        double size = largest(weight, gradient);

        double multiply() { return solver.multiply(solver.m_direction, solver.m_image); }
        void move(double alpha) {
            theta += alpha * solver.m_direction;
            gradient += alpha * solver.m_image;
            size = largest(weight, gradient);
        }
        [[nodiscard]] bool is_solved() const { return size <= target; }
        double precondition() {
            Unknowns& z = solver.m_preconditioned;
            solver.m_moved = (weight.array() > 0).select(gradient, 0.);
            solver.m_factor->solve(solver.m_moved, z);
            z = (weight.array() > 0).select(z, 0.);
            return z.dot(gradient);
        }
        void turn(double beta) { solver.m_direction = beta * solver.m_direction - solver.m_preconditioned; }
    };

    Outcome by_factor(const Unknowns& weight, double target, Unknowns& theta, Unknowns& gradient, int max_iterations) {
        FactorCg system{*this, weight, target, theta, gradient};
        if (system.is_solved()) {
            return Outcome::solved;
        }
        m_direction = Unknowns::Zero(theta.size());
        double rz = system.precondition();
        system.turn(0);
        const double rounding = 1e-30 * rz;
        for (int i = 0; i < max_iterations; ++i) {
            if (!(rz > rounding) || !cg_iteration(system, rz) || system.is_solved()) {
                return Outcome::solved; // as near as rounding lets it
            }
            if (!m_go_on()) {
                return Outcome::stopped;
            }
        }
        return Outcome::slow;
    }

    const Objective& m_objective;
    Unknowns m_curvature;
    Execution m_execution;
    NodeProduct<Objective> m_product;
    std::function<bool()> m_go_on;
    std::optional<EisenstatCg<float>> m_single;
    std::optional<EisenstatCg<double>> m_double; ///< once the other is of no more use
    double m_iteration_cost = 0;
    double m_final = 0;
    double m_ridge = 0;
    int m_n_products = 0;
    int m_before = 0; ///< products when the matrix last changed
    int m_n_factorisations = 0;
    bool m_direct = false;
    std::optional<MaskedCholesky<Objective>> m_factor;
    Unknowns m_factorised; ///< the weight of the last factorisation
    Unknowns m_direction, m_image, m_preconditioned, m_moved, m_terms;
};

} // namespace springfit::detail
