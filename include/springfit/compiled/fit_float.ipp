// SPDX-License-Identifier: BSD-3-Clause
// In single precision: what the fits read of networks and motions.

namespace springfit {

SPRINGFIT_INSTANTIATION class AccelerationObjective<2, float>;
SPRINGFIT_INSTANTIATION class AccelerationObjective<3, float>;
SPRINGFIT_INSTANTIATION TrajectoryProblem<2>::TrajectoryProblem(const SpringNetwork<2, float>&,
                                                                const std::vector<Motion<2, float>>&,
                                                                const TrajectoryOptions&);
SPRINGFIT_INSTANTIATION TrajectoryProblem<3>::TrajectoryProblem(const SpringNetwork<3, float>&,
                                                                const std::vector<Motion<3, float>>&,
                                                                const TrajectoryOptions&);

} // namespace springfit
