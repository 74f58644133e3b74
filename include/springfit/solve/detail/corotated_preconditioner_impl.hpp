// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <springfit/solve/corotated_preconditioner.hpp>

namespace springfit {

template <int Dim, std::floating_point Scalar>
CorotatedPreconditioner<Dim, Scalar>::CorotatedPreconditioner(const SparseMatrix<Scalar>& lower, const FreeNodes& free,
                                                              const NodePairs& pairs, const Points<Dim, Scalar>& rest) {
    auto made = std::make_shared<Rest>();
    made->free = free;
    made->pairs = pairs;
    made->weighted = detail::weighted_vectors<Dim, Scalar>(pairs, rest);
    if (lower.cols() > 0) {
        made->factor = detail::NodeCholesky<Dim, Scalar>(lower);
    }
    if (made->factor.is_usable()) {
        m_rest = std::move(made);
        turn(rest);
    }
}

template <int Dim, std::floating_point Scalar>
void CorotatedPreconditioner<Dim, Scalar>::turn(const Points<Dim, Scalar>& x) {
    const NodePairs& pairs = m_rest->pairs;
    m_rotations.emplace(x.cols(), pairs, m_rest->weighted, [&](Index e) {
        std::array<Scalar, Dim> r;
        for (int d = 0; d < Dim; ++d) {
            r[d] = x(d, pairs(1, e)) - x(d, pairs(0, e));
        }
        return r;
    });
}

template <int Dim, std::floating_point Scalar>
void CorotatedPreconditioner<Dim, Scalar>::apply(const Values<Scalar>& right, Values<Scalar>& solution) const {
    using Work = typename detail::NodeCholesky<Dim, Scalar>::Work;
    using Vec = std::array<Scalar, Dim>;
    const std::vector<int>& order = m_rest->factor.order();
    const std::vector<int>& nodes = m_rest->free.nodes();
    Work work = Work::Zero(Work::RowsAtCompileTime, m_rest->free.n_free());
    for (std::size_t p = 0; p < order.size(); ++p) {
        Vec v;
        std::copy_n(right.data() + Dim * order[p], Dim, v.begin());
        v = m_rotations->turned_back(nodes[static_cast<std::size_t>(order[p])], v);
        for (int d = 0; d < Dim; ++d) {
            work(d, static_cast<Index>(p)) = v[d];
        }
    }
    m_rest->factor.solve(work);
    solution.resize(right.size());
    for (std::size_t p = 0; p < order.size(); ++p) {
        Vec v;
        for (int d = 0; d < Dim; ++d) {
            v[d] = work(d, static_cast<Index>(p));
        }
        v = m_rotations->turned(nodes[static_cast<std::size_t>(order[p])], v);
        std::copy_n(v.begin(), Dim, solution.data() + Dim * order[p]);
    }
}

} // namespace springfit
