// SPDX-License-Identifier: BSD-3-Clause
// The acceleration fit: its objective, the dominant-term approximation and the exact fit.

namespace springfit {

SPRINGFIT_INSTANTIATION class AccelerationObjective<2, double>;
SPRINGFIT_INSTANTIATION class AccelerationObjective<3, double>;
SPRINGFIT_INSTANTIATION FitReport one_pass(const FitProblem&, const OnePassOptions&);
SPRINGFIT_INSTANTIATION FitReport dominant_term(const FitProblem&, const DominantTermOptions&);
SPRINGFIT_INSTANTIATION FitReport exact(const FitProblem&, const ExactOptions&);

} // namespace springfit
