// SPDX-License-Identifier: BSD-3-Clause
// Scores: motion errors, simulations at given times and natural frequencies of networks, dimension 3.

namespace springfit {

SPRINGFIT_INSTANTIATION MotionError motion_error(const SpringNetwork<3, double>&,
                                                 const std::vector<Scenario<3, double>>&,
                                                 const std::vector<Motion<3, double>>&, const ProgressCallback&,
                                                 const MotionErrorOptions<double>&);
SPRINGFIT_INSTANTIATION MotionError motion_error(const SpringNetwork<3, float>&, const std::vector<Scenario<3, float>>&,
                                                 const std::vector<Motion<3, float>>&, const ProgressCallback&,
                                                 const MotionErrorOptions<float>&);
SPRINGFIT_INSTANTIATION NaturalFrequency<3, double>
lowest_frequency(const SpringNetwork<3, double>&, const std::vector<int>&, const FrequencyOptions<double>&);
SPRINGFIT_INSTANTIATION NaturalFrequency<3, float>
lowest_frequency(const SpringNetwork<3, float>&, const std::vector<int>&, const FrequencyOptions<float>&);
SPRINGFIT_INSTANTIATION NaturalFrequency<3, double> detail::lowest_mode(const SymmetricMatrix<double>&,
                                                                        const Values<double>&, const FreeNodes&,
                                                                        const FrequencyOptions<double>&);
SPRINGFIT_INSTANTIATION NaturalFrequency<3, float> detail::lowest_mode(const SymmetricMatrix<float>&,
                                                                       const Values<float>&, const FreeNodes&,
                                                                       const FrequencyOptions<float>&);

} // namespace springfit
