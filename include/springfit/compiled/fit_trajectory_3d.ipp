// SPDX-License-Identifier: BSD-3-Clause
// Matching of motion in space.

namespace springfit {

SPRINGFIT_INSTANTIATION class TrajectoryParameters<3>;
SPRINGFIT_INSTANTIATION class TrajectoryProblem<3>;
SPRINGFIT_INSTANTIATION TrajectoryProblem<3>::TrajectoryProblem(const SpringNetwork<3, double>&,
                                                                const std::vector<Motion<3, double>>&,
                                                                const TrajectoryOptions&);
SPRINGFIT_INSTANTIATION class TrajectoryPoint<3>;
SPRINGFIT_INSTANTIATION TrajectoryReport gauss_newton(const TrajectoryProblem<3>&, const GaussNewtonOptions&);

} // namespace springfit
