// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/maximum.hpp>
#include <springfit/ipopt/detail/scaled_quadratic.hpp>
#include <springfit/solve/conjugate_gradients.hpp>

namespace springfit::ipopt::detail {

/// Sharpens a point near the minimiser of the scaled problem: an interior-point method leaves a gap of about
/// sqrt(tolerance) where an unknown is close to its bound with hardly a multiplier.
///
/// Primal-dual active set: what x minus its gradient would move beyond a bound is put on the bound, the rest is solved
/// for by conjugate gradients (the diagonal is 1), until the set stays. A point is kept only for a lower residual.
class Polish {
public:
    explicit Polish(const ScaledQuadratic& problem) : m_problem(problem) {}

    /// True where `x` was replaced by a point of lower residual, within the bounds.
    bool improve(Values<double>& x) {
        const double start = residual(x, m_problem.gradient(x));
        double best = start;
        Values<double> point = x;
        std::vector<signed char> active;
        for (int round = 0; round < max_rounds; ++round) {
            const Values<double> gradient = m_problem.gradient(point);
            const std::vector<signed char> next = active_set(point, gradient);
            if (next == active) {
                break;
            }
            active = next;
            solve_free(active, point);
            const Values<double> inside = point.cwiseMax(m_problem.lower).cwiseMin(m_problem.upper);
            const double reached = residual(inside, m_problem.gradient(inside));
            if (reached < best) {
                best = reached;
                x = inside;
            }
        }
        return best < start;
    }

private:
    static constexpr int max_rounds = 20;
    static constexpr int max_iterations = 1000;

    [[nodiscard]] double residual(const Values<double>& x, const Values<double>& gradient) const {
        double largest = 0;
        for (Index p = 0; p < x.size(); ++p) {
            const double moved = std::clamp(x(p) - gradient(p), m_problem.lower(p), m_problem.upper(p));
            largest = maximum(largest, std::abs(x(p) - moved));
        }
        return largest;
    }

    /// -1 on the lower bound, 1 on the upper, 0 free.
    [[nodiscard]] std::vector<signed char> active_set(const Values<double>& x, const Values<double>& gradient) const {
        std::vector<signed char> active(static_cast<std::size_t>(x.size()), 0);
        for (Index p = 0; p < x.size(); ++p) {
            const double moved = x(p) - gradient(p);
            active[static_cast<std::size_t>(p)] =
                static_cast<signed char>(moved <= m_problem.lower(p) ? -1 : (moved >= m_problem.upper(p) ? 1 : 0));
        }
        return active;
    }

    /// Puts the active unknowns on their bounds and the others where their gradient is 0.
    void solve_free(const std::vector<signed char>& active, Values<double>& x) const {
        Values<double> mask(x.size());
        for (Index p = 0; p < x.size(); ++p) {
            const signed char side = active[static_cast<std::size_t>(p)];
            mask(p) = side == 0 ? 1 : 0;
            if (side != 0) {
                x(p) = side < 0 ? m_problem.lower(p) : m_problem.upper(p);
            }
        }
        const Values<double> rest = -mask.cwiseProduct(m_problem.gradient(x));
        if (rest.squaredNorm() > 0) {
            const double enough = 1e-16 * std::sqrt(static_cast<double>(x.size())); // the largest pull being 1
            Values<double> moved;
            (void)conjugate_gradients(
                [&](const Values<double>& p, Values<double>& q) {
                    q = mask.cwiseProduct(m_problem.hessian.selfadjointView<Eigen::Lower>() * p);
                },
                [](const Values<double>& r, Values<double>& z) { z = r; }, rest, moved, enough / rest.norm(),
                max_iterations);
            x += moved;
        }
    }

    const ScaledQuadratic& m_problem;
};

} // namespace springfit::ipopt::detail
