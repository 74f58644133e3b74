// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fit/acceleration/problem.hpp>
#include <springfit/ipopt/detail/box_scaling.hpp>

namespace springfit::ipopt::detail {

/// The quadratic of an acceleration fit in scaled unknowns; its gradient is measured at theta = 0.
struct ScaledQuadratic : BoxScaling {
    SparseMatrix<double> hessian; ///< lower triangle, unit diagonal
    Values<double> linear;        ///< gradient = H x - linear

    explicit ScaledQuadratic(const AccelerationProblem& problem) {
        const Index n = problem.n_unknowns();
        std::vector<int> number(static_cast<std::size_t>(n), -1);
        Values<double> at_held = problem.prior;
        for (Index u = 0; u < n; ++u) {
            at_held(u) = problem.lower(u);
            if (!problem.held(u)) {
                number[static_cast<std::size_t>(u)] = static_cast<int>(moving.size());
                moving.push_back(static_cast<int>(u));
                at_held(u) = 0;
            }
        }
        const Values<double> gradient = problem.objective.gradient(at_held);
        const Values<double> root = set(problem.objective.curvature(), gradient, problem.lower, problem.upper);
        linear = -gradient(moving).cwiseProduct(scale) / objective_unit;

        std::vector<Eigen::Triplet<double>> entries;
        const SparseMatrix<double> full = problem.objective.hessian();
        for (int column = 0; column < full.outerSize(); ++column) {
            const int q = number[static_cast<std::size_t>(column)];
            for (SparseMatrix<double>::InnerIterator entry(full, column); q >= 0 && entry; ++entry) {
                const int p = number[static_cast<std::size_t>(entry.row())];
                if (p >= 0) {
                    entries.emplace_back(p, q, entry.value() / (root(p) * root(q)));
                }
            }
        }
        hessian.resize(size(), size());
        hessian.setFromTriplets(entries.begin(), entries.end());
    }

    /// 1/2 x'Hx - linear'x.
    [[nodiscard]] double value(const Values<double>& x) const {
        const Values<double> product = hessian.selfadjointView<Eigen::Lower>() * x;
        return x.dot(0.5 * product - linear);
    }
    [[nodiscard]] Values<double> gradient(const Values<double>& x) const {
        return hessian.selfadjointView<Eigen::Lower>() * x - linear;
    }
};

} // namespace springfit::ipopt::detail
