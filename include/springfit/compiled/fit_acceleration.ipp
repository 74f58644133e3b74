// SPDX-License-Identifier: BSD-3-Clause
// The acceleration fit: its objective, the dominant-term approximation and the exact fit.

namespace springfit {

SPRINGFIT_INSTANTIATION class AccelerationObjective<2, double>;
SPRINGFIT_INSTANTIATION class AccelerationObjective<3, double>;
SPRINGFIT_INSTANTIATION AccelerationReport one_pass(const AccelerationProblem&, const OnePassOptions&);
SPRINGFIT_INSTANTIATION AccelerationReport dominant_term(const AccelerationProblem&, const DominantTermOptions&);
SPRINGFIT_INSTANTIATION AccelerationReport exact(const AccelerationProblem&, const ExactOptions&);

} // namespace springfit
