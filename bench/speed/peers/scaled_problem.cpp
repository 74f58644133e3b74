// SPDX-License-Identifier: BSD-3-Clause
#include "peers.hpp"

namespace bench::peers {

using Values = springfit::Values<double>;

ScaledProblem::ScaledProblem(const springfit::AccelerationProblem& problem, double kkt_residual)
    : m_prior(problem.prior), m_lowest(problem.lower), m_highest(problem.upper) {
    const Values curvature = problem.objective.curvature();
    m_scale = (curvature.array() > 0).select(curvature.cwiseSqrt(), Values::Ones(curvature.size()));
    const Values inverse = m_scale.cwiseInverse();
    hessian = problem.objective.hessian().selfadjointView<Eigen::Lower>();
    hessian = inverse.asDiagonal() * hessian * inverse.asDiagonal();
    linear = -problem.objective.gradient(m_prior).cwiseProduct(inverse);
    lower = (m_lowest - m_prior).cwiseProduct(m_scale);
    upper = (m_highest - m_prior).cwiseProduct(m_scale);
    tolerance = kkt_residual * problem.objective.linear().cwiseProduct(inverse).lpNorm<Eigen::Infinity>();
}

Values ScaledProblem::theta(const Values& x) const {
    return (m_prior + x.cwiseQuotient(m_scale)).cwiseMax(m_lowest).cwiseMin(m_highest);
}

} // namespace bench::peers
