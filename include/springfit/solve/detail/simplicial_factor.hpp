// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>

#include <springfit/solve/sparse_factor.hpp>

namespace springfit {

namespace detail {

/// A sparse Cholesky factor that Eigen finds, column by column: each is a supernode.
template <std::same_as<double> Scalar>
class SimplicialFactor final : public SparseFactor {
public:
    [[nodiscard]] double relative_speed() const override { return 1; }
    [[nodiscard]] std::vector<int> order(const SparseMatrix<double>& graph) const override;
    void analyse(const SparseMatrix<double>& lower) override;
    [[nodiscard]] bool factorise(const SparseMatrix<double>& lower) override;
    [[nodiscard]] Supernodes supernodes() const override;

private:
    struct Factor : Eigen::SimplicialLLT<SparseMatrix<Scalar>, Eigen::Lower, Eigen::NaturalOrdering<int>> {
        /// Its columns are of their final sizes from the analysis on.
        [[nodiscard]] const SparseMatrix<Scalar>& l() const { return this->m_matrix; }
    };
    Factor m_factor;
};

/// By minimum degree.
template <std::same_as<double> Scalar>
std::vector<int> SimplicialFactor<Scalar>::order(const SparseMatrix<double>& graph) const {
    Eigen::AMDOrdering<int>::PermutationType order;
    Eigen::AMDOrdering<int>()(graph.selfadjointView<Eigen::Lower>(), order);
    return {order.indices().data(), order.indices().data() + order.size()};
}

template <std::same_as<double> Scalar>
void SimplicialFactor<Scalar>::analyse(const SparseMatrix<double>& lower) {
    m_factor.analyzePattern(lower);
}

template <std::same_as<double> Scalar>
bool SimplicialFactor<Scalar>::factorise(const SparseMatrix<double>& lower) {
    m_factor.factorize(lower);
    return m_factor.info() == Eigen::Success;
}

template <std::same_as<double> Scalar>
Supernodes SimplicialFactor<Scalar>::supernodes() const {
    const SparseMatrix<Scalar>& l = m_factor.l();
    return {static_cast<int>(l.cols()), nullptr, l.outerIndexPtr(), l.outerIndexPtr(), l.innerIndexPtr(), l.valuePtr()};
}

} // namespace detail

template <std::same_as<double> Scalar>
std::unique_ptr<SparseFactor> simplicial_factor() {
    return std::make_unique<detail::SimplicialFactor<Scalar>>();
}

} // namespace springfit
