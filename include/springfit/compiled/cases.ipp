// SPDX-License-Identifier: BSD-3-Clause
// Clamp sets and load cases.

namespace springfit {

SPRINGFIT_INSTANTIATION ClampSets clamp_sets(const Specimen<2, double>&, const ClampSetOptions&);
SPRINGFIT_INSTANTIATION ClampSets clamp_sets(const Specimen<3, double>&, const ClampSetOptions&);
SPRINGFIT_INSTANTIATION bool holds_rigidly<2, double>(const Points<2, double>&, const std::vector<int>&, double);
SPRINGFIT_INSTANTIATION bool holds_rigidly<3, double>(const Points<3, double>&, const std::vector<int>&, double);
SPRINGFIT_INSTANTIATION LoadCaseSplit<2, double> random_load_cases(const Specimen<2, double>&, const LoadCaseOptions&);
SPRINGFIT_INSTANTIATION LoadCaseSplit<3, double> random_load_cases(const Specimen<3, double>&, const LoadCaseOptions&);

} // namespace springfit
