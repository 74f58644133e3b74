// SPDX-License-Identifier: BSD-3-Clause
// Steps and equilibria of biquadratic springs.

namespace springfit {

SPRINGFIT_INSTANTIATION class BiquadraticEuler<2, double>;
SPRINGFIT_INSTANTIATION class BiquadraticEuler<3, double>;
SPRINGFIT_INSTANTIATION class BiquadraticEuler<2, float>;
SPRINGFIT_INSTANTIATION class BiquadraticEuler<3, float>;
SPRINGFIT_INSTANTIATION Equilibrium<2, double>
equilibrium(const BiquadraticNetwork<2, double>&, const Scenario<2, double>&, const EquilibriumOptions<2, double>&);
SPRINGFIT_INSTANTIATION Equilibrium<3, double>
equilibrium(const BiquadraticNetwork<3, double>&, const Scenario<3, double>&, const EquilibriumOptions<3, double>&);

} // namespace springfit
