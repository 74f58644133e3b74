// SPDX-License-Identifier: BSD-3-Clause
// Steppers, statics and equilibria of networks, dimension 3.

namespace springfit {

SPRINGFIT_INSTANTIATION class detail::SpringPotential<3, double>;
SPRINGFIT_INSTANTIATION class detail::HeldSprings<3, double>;
SPRINGFIT_INSTANTIATION NewtonReport<double> minimise(detail::SpringPotential<3, double>&, Values<double>&,
                                                      TurnedSolver<3, double>&, const NewtonOptions<double>&);
SPRINGFIT_INSTANTIATION Equilibrium<3, double> detail::equilibrium(const detail::HeldSprings<3, double>&,
                                                                   const Scenario<3, double>&,
                                                                   const EquilibriumOptions<3, double>&, bool);
SPRINGFIT_INSTANTIATION class detail::SpringPotential<3, float>;
SPRINGFIT_INSTANTIATION class detail::HeldSprings<3, float>;
SPRINGFIT_INSTANTIATION NewtonReport<float> minimise(detail::SpringPotential<3, float>&, Values<float>&,
                                                     TurnedSolver<3, float>&, const NewtonOptions<float>&);
SPRINGFIT_INSTANTIATION Equilibrium<3, float> detail::equilibrium(const detail::HeldSprings<3, float>&,
                                                                  const Scenario<3, float>&,
                                                                  const EquilibriumOptions<3, float>&, bool);
SPRINGFIT_INSTANTIATION class SymplecticEuler<3, double>;
SPRINGFIT_INSTANTIATION class SymplecticEuler<3, float>;
SPRINGFIT_INSTANTIATION class ImplicitEuler<3, double>;
SPRINGFIT_INSTANTIATION class ImplicitEuler<3, float>;
SPRINGFIT_INSTANTIATION class NetworkStatics<3, double>;
SPRINGFIT_INSTANTIATION class NetworkStatics<3, float>;
SPRINGFIT_INSTANTIATION Equilibrium<3, double> equilibrium(const SpringNetwork<3, double>&, const Scenario<3, double>&,
                                                           const EquilibriumOptions<3, double>&);
SPRINGFIT_INSTANTIATION Equilibrium<3, float> equilibrium(const SpringNetwork<3, float>&, const Scenario<3, float>&,
                                                          const EquilibriumOptions<3, float>&);
SPRINGFIT_INSTANTIATION double stable_step(const SpringNetwork<3, double>&, const std::vector<int>&);
SPRINGFIT_INSTANTIATION float stable_step(const SpringNetwork<3, float>&, const std::vector<int>&);

} // namespace springfit
