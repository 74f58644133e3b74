// SPDX-License-Identifier: BSD-3-Clause
// In single precision: bodies laid out for real time, steppers, equilibria and scores.

namespace springfit {

SPRINGFIT_INSTANTIATION class SpringBody<2, float>;
SPRINGFIT_INSTANTIATION class SpringBody<3, float>;
SPRINGFIT_INSTANTIATION class SpringBatch<2, float>;
SPRINGFIT_INSTANTIATION class SpringBatch<3, float>;
SPRINGFIT_INSTANTIATION class ImplicitBody<2, float>;
SPRINGFIT_INSTANTIATION class ImplicitBody<3, float>;
SPRINGFIT_INSTANTIATION class ProjectiveBody<2, float>;
SPRINGFIT_INSTANTIATION class ProjectiveBody<3, float>;
SPRINGFIT_INSTANTIATION class detail::NetworkPotential<SpringNetwork<2, float>>;
SPRINGFIT_INSTANTIATION class detail::ClampedStiffness<SpringNetwork<2, float>>;
SPRINGFIT_INSTANTIATION NewtonReport<float> minimise(detail::NetworkPotential<SpringNetwork<2, float>>&, Values<float>&,
                                                     CorotatedSolver<2, float>&, const NewtonOptions<float>&);
SPRINGFIT_INSTANTIATION Equilibrium<2, float>
detail::equilibrium(const detail::ClampedStiffness<SpringNetwork<2, float>>&, const Scenario<2, float>&,
                    const EquilibriumOptions<2, float>&, bool);
SPRINGFIT_INSTANTIATION class SymplecticEuler<2, float>;
SPRINGFIT_INSTANTIATION class ImplicitEuler<2, float>;
SPRINGFIT_INSTANTIATION class NetworkStatics<2, float>;
SPRINGFIT_INSTANTIATION Equilibrium<2, float> equilibrium(const SpringNetwork<2, float>&, const Scenario<2, float>&,
                                                          const EquilibriumOptions<2, float>&);
SPRINGFIT_INSTANTIATION float stable_step(const SpringNetwork<2, float>&, const std::vector<int>&);
SPRINGFIT_INSTANTIATION class detail::NetworkPotential<SpringNetwork<3, float>>;
SPRINGFIT_INSTANTIATION class detail::ClampedStiffness<SpringNetwork<3, float>>;
SPRINGFIT_INSTANTIATION NewtonReport<float> minimise(detail::NetworkPotential<SpringNetwork<3, float>>&, Values<float>&,
                                                     CorotatedSolver<3, float>&, const NewtonOptions<float>&);
SPRINGFIT_INSTANTIATION Equilibrium<3, float>
detail::equilibrium(const detail::ClampedStiffness<SpringNetwork<3, float>>&, const Scenario<3, float>&,
                    const EquilibriumOptions<3, float>&, bool);
SPRINGFIT_INSTANTIATION class SymplecticEuler<3, float>;
SPRINGFIT_INSTANTIATION class ImplicitEuler<3, float>;
SPRINGFIT_INSTANTIATION class NetworkStatics<3, float>;
SPRINGFIT_INSTANTIATION Equilibrium<3, float> equilibrium(const SpringNetwork<3, float>&, const Scenario<3, float>&,
                                                          const EquilibriumOptions<3, float>&);
SPRINGFIT_INSTANTIATION float stable_step(const SpringNetwork<3, float>&, const std::vector<int>&);
SPRINGFIT_INSTANTIATION MotionError motion_error(const SpringNetwork<2, float>&, const std::vector<Scenario<2, float>>&,
                                                 const std::vector<Motion<2, float>>&, const ProgressCallback&,
                                                 const MotionErrorOptions<float>&);
SPRINGFIT_INSTANTIATION MotionError motion_error(const SpringNetwork<3, float>&, const std::vector<Scenario<3, float>>&,
                                                 const std::vector<Motion<3, float>>&, const ProgressCallback&,
                                                 const MotionErrorOptions<float>&);

} // namespace springfit
