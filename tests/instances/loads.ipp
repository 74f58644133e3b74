// SPDX-License-Identifier: BSD-3-Clause
// Loads of load cases.

namespace springfit {

SPRINGFIT_INSTANTIATION void validate(const Specimen<2, double>&);
SPRINGFIT_INSTANTIATION std::vector<int> side_nodes<2, double>(const Points<2, double>&, const Side&, double);
SPRINGFIT_INSTANTIATION Scenario<2, double> random_load(LoadKind, const Specimen<2, double>&, unsigned);
SPRINGFIT_INSTANTIATION void validate(const Specimen<3, double>&);
SPRINGFIT_INSTANTIATION std::vector<int> side_nodes<3, double>(const Points<3, double>&, const Side&, double);
SPRINGFIT_INSTANTIATION Scenario<3, double> random_load(LoadKind, const Specimen<3, double>&, unsigned);

} // namespace springfit
