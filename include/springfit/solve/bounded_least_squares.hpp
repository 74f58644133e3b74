// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>

#include <springfit/core/types.hpp>

namespace springfit {

/// Exact minimiser of a small strictly convex quadratic over a box, by a primal active set:
///
///     minimise 1/2 x'Hx - g'x  subject to  lower <= x <= upper
///
/// Every step goes to the minimiser over the free variables or to the first bound on the way, so the value falls and
/// the set of active bounds never repeats. O(n^3) per change of the set. Keeps its workspace between calls.
class BoundedLeastSquares {
public:
    /// `x` is a start within the bounds and becomes the minimiser. H is symmetric positive definite, both triangles.
    /// False where the step budget ran out (x is then the best point so far, within the bounds).
    template <class Matrix, class Vector>
    bool solve(const Matrix& hessian, const Vector& linear, const Vector& lower, const Vector& upper,
               Values<double>& x) {
        const Index n = x.size();
        m_gradient = hessian * x - linear;
        const double tolerance = 64 * std::numeric_limits<double>::epsilon() *
                                 std::max(linear.cwiseAbs().maxCoeff(), m_gradient.cwiseAbs().maxCoeff());
        m_free.clear();
        m_is_free.assign(static_cast<std::size_t>(n), false);
        for (Index j = 0; j < n; ++j) {
            const bool pushed_down = x(j) <= lower(j) && m_gradient(j) >= 0;
            const bool pushed_up = x(j) >= upper(j) && m_gradient(j) <= 0;
            if (lower(j) < upper(j) && !pushed_down && !pushed_up) {
                set_free(j, true);
            }
        }
        for (Index step = 0; step < 20 * n + 20; ++step) {
            if (!m_free.empty() && !move(hessian, lower, upper, x)) {
                m_gradient = hessian * x - linear;
                continue;
            }
            m_gradient = hessian * x - linear;
            Index worst = -1;
            double most = tolerance;
            for (Index j = 0; j < n; ++j) {
                if (m_is_free[static_cast<std::size_t>(j)] || !(lower(j) < upper(j))) {
                    continue;
                }
                const double inwards = x(j) <= lower(j) ? -m_gradient(j) : m_gradient(j);
                if (inwards > most) {
                    most = inwards;
                    worst = j;
                }
            }
            if (worst < 0) {
                return true;
            }
            set_free(worst, true);
        }
        return false;
    }

private:
    void set_free(Index j, bool free) {
        m_is_free[static_cast<std::size_t>(j)] = free;
        if (free) {
            m_free.insert(std::lower_bound(m_free.begin(), m_free.end(), j), j);
        } else {
            m_free.erase(std::lower_bound(m_free.begin(), m_free.end(), j));
        }
    }

    /// Goes to the minimiser over the free variables; false where a bound stopped it (it is then active).
    template <class Matrix, class Vector>
    bool move(const Matrix& hessian, const Vector& lower, const Vector& upper, Values<double>& x) {
        const auto n = static_cast<Index>(m_free.size());
        m_block.resize(n, n);
        m_step.resize(n);
        for (Index q = 0; q < n; ++q) {
            const Index j = m_free[static_cast<std::size_t>(q)];
            m_step(q) = -m_gradient(j);
            for (Index p = 0; p < n; ++p) {
                m_block(p, q) = hessian(m_free[static_cast<std::size_t>(p)], j);
            }
        }
        Eigen::LLT<Eigen::Ref<DenseMatrix<double>>> factor(m_block);
        if (factor.info() != Eigen::Success) {
            return true; // not positive definite in this precision: stay
        }
        factor.solveInPlace(m_step);
        double fraction = 1;
        Index blocking = -1;
        for (std::size_t f = 0; f < m_free.size(); ++f) {
            const Index j = m_free[f];
            const double step = m_step(static_cast<Index>(f));
            const double room = step < 0 ? lower(j) - x(j) : upper(j) - x(j);
            if (std::abs(step) * fraction > std::abs(room)) {
                fraction = room / step;
                blocking = j;
            }
        }
        for (std::size_t f = 0; f < m_free.size(); ++f) {
            const Index j = m_free[f];
            const double step = m_step(static_cast<Index>(f));
            x(j) = std::min(std::max(x(j) + fraction * step, lower(j)), upper(j));
            if (j == blocking) {
                x(j) = step < 0 ? lower(j) : upper(j);
            }
        }
        if (blocking >= 0) {
            set_free(blocking, false);
        }
        return blocking < 0;
    }

    Values<double> m_gradient, m_step;
    DenseMatrix<double> m_block;
    std::vector<Index> m_free;
    std::vector<bool> m_is_free;
};

} // namespace springfit
