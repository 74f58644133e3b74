// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/solve/corotated_preconditioner.hpp>

namespace springfit {

template <int Dim, std::floating_point Scalar>
CorotatedPreconditioner<Dim, Scalar>::CorotatedPreconditioner(const SparseMatrix<Scalar>& lower, const FreeNodes& free,
                                                              const NodePairs& pairs, const Points<Dim, Scalar>& rest) {
    auto made = std::make_shared<Rest>();
    made->free = free;
    made->pairs = pairs;
    made->vectors.resize(Dim, pairs.cols());
    for (Index e = 0; e < pairs.cols(); ++e) {
        const Vector<Dim, Scalar> r = rest.col(pairs(1, e)) - rest.col(pairs(0, e));
        const Scalar square = r.squaredNorm();
        made->vectors.col(e) = square > 0 ? Vector<Dim, Scalar>(r / square) : r;
    }
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
    Points<Dim * Dim, Scalar> sums = Points<Dim * Dim, Scalar>::Zero(Dim * Dim, x.cols());
    for (Index e = 0; e < m_rest->pairs.cols(); ++e) {
        const int i = m_rest->pairs(0, e);
        const int j = m_rest->pairs(1, e);
        const Rotation product = (x.col(j) - x.col(i)) * m_rest->vectors.col(e).transpose();
        sums.col(i) += product.reshaped();
        sums.col(j) += product.reshaped();
    }
    m_rotations.resize(Dim * Dim, m_rest->free.n_free());
    for (Index f = 0; f < m_rest->free.n_free(); ++f) {
        const auto sum = sums.col(m_rest->free.nodes()[static_cast<std::size_t>(f)]);
        m_rotations.col(f) = rotation_of(sum.reshaped(Dim, Dim)).reshaped();
    }
}

template <int Dim, std::floating_point Scalar>
void CorotatedPreconditioner<Dim, Scalar>::apply(const Values<Scalar>& right, Values<Scalar>& solution) const {
    using Work = typename detail::NodeCholesky<Dim, Scalar>::Work;
    const std::vector<int>& order = m_rest->factor.order();
    Work work = Work::Zero(Work::RowsAtCompileTime, m_rotations.cols());
    for (std::size_t p = 0; p < order.size(); ++p) {
        work.col(static_cast<Index>(p)).template head<Dim>() =
            rotation(order[p]).transpose() * right.template segment<Dim>(Dim * order[p]);
    }
    m_rest->factor.solve(work);
    solution.resize(right.size());
    for (std::size_t p = 0; p < order.size(); ++p) {
        solution.template segment<Dim>(Dim * order[p]) =
            rotation(order[p]) * work.col(static_cast<Index>(p)).template head<Dim>();
    }
}

template <int Dim, std::floating_point Scalar>
auto CorotatedPreconditioner<Dim, Scalar>::rotation_of(const Rotation& a) -> Rotation {
    if constexpr (Dim == 2) {
        const Scalar c = a(0, 0) + a(1, 1);
        const Scalar s = a(1, 0) - a(0, 1);
        const Scalar size = std::hypot(c, s);
        if (!(size > 0)) {
            return Rotation::Identity();
        }
        return (Rotation() << c / size, -s / size, s / size, c / size).finished();
    } else {
        Rotation x = a * (std::sqrt(Scalar(3)) / a.norm());
        Scalar determinant = 0;
        for (int iteration = 0; iteration < 20; ++iteration) { // Newton's for the polar part: (X + X^-T) / 2
            Rotation cofactors;
            cofactors.col(0) = x.col(1).cross(x.col(2));
            cofactors.col(1) = x.col(2).cross(x.col(0));
            cofactors.col(2) = x.col(0).cross(x.col(1));
            determinant = x.col(0).dot(cofactors.col(0));
            if (!(determinant > 0)) {
                return Rotation::Identity();
            }
            const Rotation next = (x + cofactors / determinant) / 2;
            const Scalar change = (next - x).norm();
            x = next;
            if (change < Scalar(1e-4)) { // then the next is at 1e-8
                break;
            }
        }
        return std::abs(determinant - 1) < Scalar(0.1) ? x : Rotation::Identity();
    }
}

} // namespace springfit
