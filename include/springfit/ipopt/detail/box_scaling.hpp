// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <springfit/core/types.hpp>

namespace springfit::ipopt::detail {

/// The unknowns that may move, scaled: theta_u = scale_u x_u, such that the Hessian in x has a unit diagonal and the
/// largest gradient, where it is measured, is 1.
struct BoxScaling {
    std::vector<int> moving;     ///< unknowns that are not held
    Values<double> scale;        ///< theta_u per unit of x
    double objective_unit = 1;   ///< the objective per unit of the scaled objective
    Values<double> lower, upper; ///< of x

    [[nodiscard]] Index size() const { return static_cast<Index>(moving.size()); }

    /// Sets all but `moving` from curvature, gradient and bounds `[n_unknowns]`. Returns the root of the curvature.
    Values<double> set(const Values<double>& curvature, const Values<double>& gradient, const Values<double>& all_lower,
                       const Values<double>& all_upper) {
        // A curvature of 0 has no slope either: such an unknown stays where it starts, whatever its scale.
        const Values<double> own = curvature(moving);
        const Values<double> root = (own.array() > 0).select(own.array().sqrt(), 1.);
        const double largest = moving.empty() ? 0. : gradient(moving).cwiseQuotient(root).cwiseAbs().maxCoeff();
        const double size = largest > 0 ? largest : 1.;
        scale = size * root.cwiseInverse();
        objective_unit = size * size;
        lower = all_lower(moving).cwiseQuotient(scale);
        upper = all_upper(moving).cwiseQuotient(scale);
        return root;
    }

    /// x as values of the unknowns, within the bounds to the last bit, and on a bound where x is; held ones at theirs.
    [[nodiscard]] Values<double> unscaled(const Values<double>& x, const Values<double>& all_lower,
                                          const Values<double>& all_upper) const {
        Values<double> theta = all_lower;
        for (Index p = 0; p < size(); ++p) {
            const int u = moving[static_cast<std::size_t>(p)];
            theta(u) = x(p) <= lower(p)   ? all_lower(u)
                       : x(p) >= upper(p) ? all_upper(u)
                                          : std::clamp(x(p) * scale(p), all_lower(u), all_upper(u));
        }
        return theta;
    }

    /// Puts on its bound what lies closer to it than its multiplier is large.
    void snap(const Values<double>& lower_multipliers, const Values<double>& upper_multipliers,
              Values<double>& x) const {
        for (Index p = 0; p < x.size(); ++p) {
            if (x(p) - lower(p) < lower_multipliers(p)) {
                x(p) = lower(p);
            } else if (upper(p) - x(p) < upper_multipliers(p)) {
                x(p) = upper(p);
            }
        }
    }
};

} // namespace springfit::ipopt::detail
