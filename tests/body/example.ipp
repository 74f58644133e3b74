// SPDX-License-Identifier: BSD-3-Clause
// What several steppers' tests instantiate of example.hpp.

namespace springfit::test {

SPRINGFIT_INSTANTIATION SpringNetwork<2, float> random_network<2, float>(float, int);
SPRINGFIT_INSTANTIATION SpringNetwork<2, float> random_network_with_cells<2, float>(float, float, float, int);
SPRINGFIT_INSTANTIATION Scenario<2, float> thrown(const SpringNetwork<2, float>&, float);
SPRINGFIT_INSTANTIATION SpringNetwork<3, float> random_network<3, float>(float, int);
SPRINGFIT_INSTANTIATION SpringNetwork<3, float> random_network_with_cells<3, float>(float, float, float, int);
SPRINGFIT_INSTANTIATION Scenario<3, float> thrown(const SpringNetwork<3, float>&, float);
SPRINGFIT_INSTANTIATION SpringNetwork<2, double> random_network<2, double>(double, int);
SPRINGFIT_INSTANTIATION SpringNetwork<2, double> random_network_with_cells<2, double>(double, double, double, int);
SPRINGFIT_INSTANTIATION Scenario<2, double> thrown(const SpringNetwork<2, double>&, double);
SPRINGFIT_INSTANTIATION SpringNetwork<3, double> random_network<3, double>(double, int);
SPRINGFIT_INSTANTIATION SpringNetwork<3, double> random_network_with_cells<3, double>(double, double, double, int);
SPRINGFIT_INSTANTIATION Scenario<3, double> thrown(const SpringNetwork<3, double>&, double);

} // namespace springfit::test
