// SPDX-License-Identifier: BSD-3-Clause
// Loads of load cases, in single precision.

namespace springfit {

SPRINGFIT_INSTANTIATION void validate(const Specimen<2, float>&);
SPRINGFIT_INSTANTIATION std::vector<int> side_nodes<2, float>(const Points<2, float>&, const Side&, float);
SPRINGFIT_INSTANTIATION Scenario<2, float> random_load(LoadKind, const Specimen<2, float>&, unsigned);
SPRINGFIT_INSTANTIATION void validate(const Specimen<3, float>&);
SPRINGFIT_INSTANTIATION std::vector<int> side_nodes<3, float>(const Points<3, float>&, const Side&, float);
SPRINGFIT_INSTANTIATION Scenario<3, float> random_load(LoadKind, const Specimen<3, float>&, unsigned);

} // namespace springfit
