// SPDX-License-Identifier: BSD-3-Clause
// Matching of motion in the plane.

namespace springfit {

SPRINGFIT_INSTANTIATION class TrajectoryParameters<2>;
SPRINGFIT_INSTANTIATION class TrajectoryProblem<2>;
SPRINGFIT_INSTANTIATION TrajectoryProblem<2>::TrajectoryProblem(const SpringNetwork<2, double>&,
                                                                const std::vector<Motion<2, double>>&,
                                                                const TrajectoryOptions&);
SPRINGFIT_INSTANTIATION class TrajectoryPoint<2>;
SPRINGFIT_INSTANTIATION TrajectoryReport gauss_newton(const TrajectoryProblem<2>&, const GaussNewtonOptions&);

} // namespace springfit
