// SPDX-License-Identifier: BSD-3-Clause
// The stages of a calibration.

namespace springfit {

SPRINGFIT_INSTANTIATION Candidates<2> make_candidates(const std::vector<NamedNetwork<2>>&,
                                                      const RecordedCases<2, double>&, const CalibrateOptions&);
SPRINGFIT_INSTANTIATION Candidates<3> make_candidates(const std::vector<NamedNetwork<3>>&,
                                                      const RecordedCases<3, double>&, const CalibrateOptions&);
SPRINGFIT_INSTANTIATION bool score(std::vector<Candidate<2>>&, const RecordedCases<2, double>&,
                                   const CalibrateOptions&);
SPRINGFIT_INSTANTIATION bool score(std::vector<Candidate<3>>&, const RecordedCases<3, double>&,
                                   const CalibrateOptions&);
SPRINGFIT_INSTANTIATION Calibration<2> calibrate(const std::vector<NetworkVariant<2>>&, RecordedCases<2, double>,
                                                 const CalibrateOptions&);
SPRINGFIT_INSTANTIATION Calibration<3> calibrate(const std::vector<NetworkVariant<3>>&, RecordedCases<3, double>,
                                                 const CalibrateOptions&);

} // namespace springfit
