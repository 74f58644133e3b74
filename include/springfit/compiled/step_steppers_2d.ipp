// SPDX-License-Identifier: BSD-3-Clause
// Steppers, statics and equilibria of networks, dimension 2.

namespace springfit {

SPRINGFIT_INSTANTIATION class detail::SpringPotential<2, double>;
SPRINGFIT_INSTANTIATION class detail::HeldSprings<2, double>;
SPRINGFIT_INSTANTIATION NewtonReport<double> minimise(detail::SpringPotential<2, double>&, Values<double>&,
                                                      TurnedSolver<2, double>&, const NewtonOptions<double>&);
SPRINGFIT_INSTANTIATION Equilibrium<2, double> detail::equilibrium(const detail::HeldSprings<2, double>&,
                                                                   const Scenario<2, double>&,
                                                                   const EquilibriumOptions<2, double>&, bool);
SPRINGFIT_INSTANTIATION class detail::SpringPotential<2, float>;
SPRINGFIT_INSTANTIATION class detail::HeldSprings<2, float>;
SPRINGFIT_INSTANTIATION NewtonReport<float> minimise(detail::SpringPotential<2, float>&, Values<float>&,
                                                     TurnedSolver<2, float>&, const NewtonOptions<float>&);
SPRINGFIT_INSTANTIATION Equilibrium<2, float> detail::equilibrium(const detail::HeldSprings<2, float>&,
                                                                  const Scenario<2, float>&,
                                                                  const EquilibriumOptions<2, float>&, bool);
SPRINGFIT_INSTANTIATION class SymplecticEuler<2, double>;
SPRINGFIT_INSTANTIATION class SymplecticEuler<2, float>;
SPRINGFIT_INSTANTIATION class ImplicitEuler<2, double>;
SPRINGFIT_INSTANTIATION class ImplicitEuler<2, float>;
SPRINGFIT_INSTANTIATION class NetworkStatics<2, double>;
SPRINGFIT_INSTANTIATION class NetworkStatics<2, float>;
SPRINGFIT_INSTANTIATION Equilibrium<2, double> equilibrium(const SpringNetwork<2, double>&, const Scenario<2, double>&,
                                                           const EquilibriumOptions<2, double>&);
SPRINGFIT_INSTANTIATION Equilibrium<2, float> equilibrium(const SpringNetwork<2, float>&, const Scenario<2, float>&,
                                                          const EquilibriumOptions<2, float>&);
SPRINGFIT_INSTANTIATION double stable_step(const SpringNetwork<2, double>&, const std::vector<int>&);
SPRINGFIT_INSTANTIATION float stable_step(const SpringNetwork<2, float>&, const std::vector<int>&);

} // namespace springfit
