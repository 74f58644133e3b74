// SPDX-License-Identifier: BSD-3-Clause
// Steppers, statics and equilibria of networks.

namespace springfit {

SPRINGFIT_INSTANTIATION class detail::NetworkPotential<SpringNetwork<2, double>>;
SPRINGFIT_INSTANTIATION class detail::ClampedStiffness<SpringNetwork<2, double>>;
SPRINGFIT_INSTANTIATION NewtonReport<double> minimise(detail::NetworkPotential<SpringNetwork<2, double>>&,
                                                      Values<double>&, CorotatedSolver<2, double>&,
                                                      const NewtonOptions<double>&);
SPRINGFIT_INSTANTIATION Equilibrium<2, double>
detail::equilibrium(const detail::ClampedStiffness<SpringNetwork<2, double>>&, const Scenario<2, double>&,
                    const EquilibriumOptions<2, double>&, bool);
SPRINGFIT_INSTANTIATION class SymplecticEuler<2, double>;
SPRINGFIT_INSTANTIATION class ImplicitEuler<2, double>;
SPRINGFIT_INSTANTIATION class NetworkStatics<2, double>;
SPRINGFIT_INSTANTIATION Equilibrium<2, double> equilibrium(const SpringNetwork<2, double>&, const Scenario<2, double>&,
                                                           const EquilibriumOptions<2, double>&);
SPRINGFIT_INSTANTIATION double stable_step(const SpringNetwork<2, double>&, const std::vector<int>&);
SPRINGFIT_INSTANTIATION class detail::NetworkPotential<SpringNetwork<3, double>>;
SPRINGFIT_INSTANTIATION class detail::ClampedStiffness<SpringNetwork<3, double>>;
SPRINGFIT_INSTANTIATION NewtonReport<double> minimise(detail::NetworkPotential<SpringNetwork<3, double>>&,
                                                      Values<double>&, CorotatedSolver<3, double>&,
                                                      const NewtonOptions<double>&);
SPRINGFIT_INSTANTIATION Equilibrium<3, double>
detail::equilibrium(const detail::ClampedStiffness<SpringNetwork<3, double>>&, const Scenario<3, double>&,
                    const EquilibriumOptions<3, double>&, bool);
SPRINGFIT_INSTANTIATION class SymplecticEuler<3, double>;
SPRINGFIT_INSTANTIATION class ImplicitEuler<3, double>;
SPRINGFIT_INSTANTIATION class NetworkStatics<3, double>;
SPRINGFIT_INSTANTIATION Equilibrium<3, double> equilibrium(const SpringNetwork<3, double>&, const Scenario<3, double>&,
                                                           const EquilibriumOptions<3, double>&);
SPRINGFIT_INSTANTIATION double stable_step(const SpringNetwork<3, double>&, const std::vector<int>&);

} // namespace springfit
