// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>

#include <springfit/core/types.hpp>
#include <springfit/solve/detail/supernode.hpp>

namespace springfit::detail {

/// A sparse Cholesky factor that Eigen finds, column by column: each is a supernode.
class SimplicialFactor {
public:
    static constexpr double relative_speed = 1;

    /// An order of elimination that fills little, by minimum degree: the node at each place. `graph` is the lower
    /// triangle of a matrix over the nodes.
    [[nodiscard]] static std::vector<int> order(const SparseMatrix<double>& graph) {
        Eigen::AMDOrdering<int>::PermutationType order;
        Eigen::AMDOrdering<int>()(graph.selfadjointView<Eigen::Lower>(), order);
        return {order.indices().data(), order.indices().data() + order.size()};
    }

    /// `lower` is to be eliminated in its own order.
    void analyse(const SparseMatrix<double>& lower) { m_factor.analyzePattern(lower); }

    /// False where a pivot is not positive.
    [[nodiscard]] bool factorise(const SparseMatrix<double>& lower) {
        m_factor.factorize(lower);
        return m_factor.info() == Eigen::Success;
    }

    [[nodiscard]] int n_supernodes() const { return static_cast<int>(m_factor.cols()); }

    [[nodiscard]] Supernode supernode(int s) const {
        const SparseMatrix<double>& l = m_factor.l();
        const int begin = l.outerIndexPtr()[s];
        return {1, l.outerIndexPtr()[s + 1] - begin, l.innerIndexPtr() + begin, l.valuePtr() + begin};
    }

private:
    struct Factor : Eigen::SimplicialLLT<SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> {
        /// Its columns are of their final sizes from the analysis on.
        [[nodiscard]] const SparseMatrix<double>& l() const { return m_matrix; }
    };
    Factor m_factor;
};

} // namespace springfit::detail
