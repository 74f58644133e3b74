// SPDX-License-Identifier: BSD-3-Clause
// Motion errors.

namespace springfit {

SPRINGFIT_INSTANTIATION MotionError motion_error(const SpringNetwork<2, double>&,
                                                 const std::vector<Scenario<2, double>>&,
                                                 const std::vector<Motion<2, double>>&, const ProgressCallback&,
                                                 const MotionErrorOptions<double>&);
SPRINGFIT_INSTANTIATION MotionError motion_error(const SpringNetwork<3, double>&,
                                                 const std::vector<Scenario<3, double>>&,
                                                 const std::vector<Motion<3, double>>&, const ProgressCallback&,
                                                 const MotionErrorOptions<double>&);

} // namespace springfit
