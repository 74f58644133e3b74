// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fit/acceleration/node_quadratic.hpp>
#include <springfit/solve/sparse_cholesky.hpp>

namespace springfit::detail {

/// Sparse Cholesky factor of the free part H_FF of a node quadratic's Hessian, for one free set after another.
///
/// Rows and columns of the others are replaced by those of the identity, so the pattern, and with it the ordering and
/// the symbolic analysis, is that of the whole H for every set. H is scaled to a unit diagonal.
template <class Objective>
class MaskedCholesky {
public:
    using Unknowns = typename Objective::Unknowns;

    /// `curvature` is the diagonal of H.
    MaskedCholesky(const Objective& objective, const Unknowns& curvature)
        : m_inverse_root((curvature.array() > 0).select(curvature.array().rsqrt(), 1.)),
          m_hessian(objective.hessian()) {
        for (int c = 0; c < m_hessian.outerSize(); ++c) {
            for (SparseMatrix<double>::InnerIterator entry(m_hessian, c); entry; ++entry) {
                entry.valueRef() *= m_inverse_root(c) * m_inverse_root(entry.row());
            }
        }
        m_masked = m_hessian;
        m_factor.analyse(m_masked);
    }

    /// Factorises H + ridge diag(H) for the unknowns whose `weight` is not 0; false where that is too close to
    /// singular.
    ///
    /// The diagonal is raised by another 1e-14 of itself, or by as much more as keeps the pivots positive.
    [[nodiscard]] bool factorise(const Unknowns& weight, double ridge) {
        for (int c = 0; c < m_masked.outerSize(); ++c) {
            for (SparseMatrix<double>::InnerIterator entry(m_masked, c); entry; ++entry) {
                const bool kept = weight(c) != 0 && weight(entry.row()) != 0;
                const auto at = &entry.valueRef() - m_masked.valuePtr();
                entry.valueRef() = kept ? m_hessian.valuePtr()[at] : entry.row() == c ? 1. : 0.;
            }
        }
        double raised = 0;
        for (double shift = 1e-14; shift < 1e-5; shift *= 100) {
            m_masked.diagonal().array() += ridge + shift - raised;
            raised = ridge + shift;
            if (m_factor.factorise(m_masked)) {
                return true;
            }
        }
        return false;
    }

    /// x = H_FF^-1 b, for b that is 0 where nothing is free.
    void solve(const Unknowns& b, Unknowns& x) {
        m_scaled = b.cwiseProduct(m_inverse_root);
        m_factor.solve(m_scaled, x);
        x.array() *= m_inverse_root.array();
    }

    /// Entries of the factor, and multiplications and additions that Eigen would do in the time of finding them.
    [[nodiscard]] double n_entries() const { return m_factor.n_entries(); }
    [[nodiscard]] double flops() const { return m_factor.flops() / m_factor.relative_speed(); }

private:
    Unknowns m_inverse_root, m_scaled;
    SparseMatrix<double> m_hessian, m_masked; ///< lower triangles
    SparseCholesky m_factor;
};

} // namespace springfit::detail
