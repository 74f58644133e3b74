// SPDX-License-Identifier: BSD-3-Clause
// Scores: motion errors, simulations at given times and natural frequencies of networks, dimension 2.

namespace springfit {

SPRINGFIT_INSTANTIATION MotionError motion_error(const SpringNetwork<2, double>&,
                                                 const std::vector<Scenario<2, double>>&,
                                                 const std::vector<Motion<2, double>>&, const ProgressCallback&,
                                                 const MotionErrorOptions<double>&);
SPRINGFIT_INSTANTIATION MotionError motion_error(const SpringNetwork<2, float>&, const std::vector<Scenario<2, float>>&,
                                                 const std::vector<Motion<2, float>>&, const ProgressCallback&,
                                                 const MotionErrorOptions<float>&);
SPRINGFIT_INSTANTIATION NaturalFrequency<2, double>
lowest_frequency(const SpringNetwork<2, double>&, const std::vector<int>&, const FrequencyOptions<double>&);
SPRINGFIT_INSTANTIATION NaturalFrequency<2, float>
lowest_frequency(const SpringNetwork<2, float>&, const std::vector<int>&, const FrequencyOptions<float>&);
SPRINGFIT_INSTANTIATION NaturalFrequency<2, double> detail::lowest_mode(const SymmetricMatrix<double>&,
                                                                        const Values<double>&, const FreeNodes&,
                                                                        const FrequencyOptions<double>&);
SPRINGFIT_INSTANTIATION NaturalFrequency<2, float> detail::lowest_mode(const SymmetricMatrix<float>&,
                                                                       const Values<float>&, const FreeNodes&,
                                                                       const FrequencyOptions<float>&);

} // namespace springfit
