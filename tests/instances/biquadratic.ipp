// SPDX-License-Identifier: BSD-3-Clause
// Biquadratic springs.

namespace springfit {

SPRINGFIT_INSTANTIATION void validate(const BiquadraticNetwork<2, double>&);
SPRINGFIT_INSTANTIATION BiquadraticNetwork<2, double> biquadratic_network(const Mesh<2, double, Tri3>&,
                                                                          const BiquadraticOptions<double>&);
SPRINGFIT_INSTANTIATION BiquadraticCoefficients<double> delingette(const Mesh<2, double, Tri3>&, const IsotropicSolid&);
SPRINGFIT_INSTANTIATION void apply(const BiquadraticCoefficients<double>&, BiquadraticNetwork<2, double>&);
SPRINGFIT_INSTANTIATION double elastic_energy(const BiquadraticNetwork<2, double>&, const Points<2, double>&);
SPRINGFIT_INSTANTIATION void add_elastic_forces(const BiquadraticNetwork<2, double>&, const Points<2, double>&,
                                                Points<2, double>&);
SPRINGFIT_INSTANTIATION void add_forces(const BiquadraticNetwork<2, double>&, const Points<2, double>&,
                                        const Points<2, double>&, Points<2, double>&);
SPRINGFIT_INSTANTIATION void compute_accelerations(const BiquadraticNetwork<2, double>&, const Points<2, double>&,
                                                   const Points<2, double>&, const Points<2, double>&,
                                                   Points<2, double>&);
SPRINGFIT_INSTANTIATION BlockMatrix<2, double> network_matrix(const BiquadraticNetwork<2, double>&, const FreeNodes&);
SPRINGFIT_INSTANTIATION void add_stiffness(const BiquadraticNetwork<2, double>&, const Points<2, double>&, HessianForm,
                                           BlockMatrix<2, double>&);
SPRINGFIT_INSTANTIATION double stable_step_at(const BiquadraticNetwork<2, double>&, const Points<2, double>&);
SPRINGFIT_INSTANTIATION void validate(const BiquadraticNetwork<3, double>&);
SPRINGFIT_INSTANTIATION BiquadraticNetwork<3, double> biquadratic_network(const Mesh<3, double, Tri3>&,
                                                                          const BiquadraticOptions<double>&);
SPRINGFIT_INSTANTIATION BiquadraticCoefficients<double> delingette(const Mesh<3, double, Tri3>&, const IsotropicSolid&);
SPRINGFIT_INSTANTIATION void apply(const BiquadraticCoefficients<double>&, BiquadraticNetwork<3, double>&);
SPRINGFIT_INSTANTIATION double elastic_energy(const BiquadraticNetwork<3, double>&, const Points<3, double>&);
SPRINGFIT_INSTANTIATION void add_elastic_forces(const BiquadraticNetwork<3, double>&, const Points<3, double>&,
                                                Points<3, double>&);
SPRINGFIT_INSTANTIATION void add_forces(const BiquadraticNetwork<3, double>&, const Points<3, double>&,
                                        const Points<3, double>&, Points<3, double>&);
SPRINGFIT_INSTANTIATION void compute_accelerations(const BiquadraticNetwork<3, double>&, const Points<3, double>&,
                                                   const Points<3, double>&, const Points<3, double>&,
                                                   Points<3, double>&);
SPRINGFIT_INSTANTIATION BlockMatrix<3, double> network_matrix(const BiquadraticNetwork<3, double>&, const FreeNodes&);
SPRINGFIT_INSTANTIATION void add_stiffness(const BiquadraticNetwork<3, double>&, const Points<3, double>&, HessianForm,
                                           BlockMatrix<3, double>&);
SPRINGFIT_INSTANTIATION double stable_step_at(const BiquadraticNetwork<3, double>&, const Points<3, double>&);
SPRINGFIT_INSTANTIATION void validate(const BiquadraticNetwork<2, float>&);
SPRINGFIT_INSTANTIATION BiquadraticNetwork<2, float> biquadratic_network(const Mesh<2, float, Tri3>&,
                                                                         const BiquadraticOptions<float>&);
SPRINGFIT_INSTANTIATION BiquadraticCoefficients<float> delingette(const Mesh<2, float, Tri3>&, const IsotropicSolid&);
SPRINGFIT_INSTANTIATION void apply(const BiquadraticCoefficients<float>&, BiquadraticNetwork<2, float>&);
SPRINGFIT_INSTANTIATION float elastic_energy(const BiquadraticNetwork<2, float>&, const Points<2, float>&);
SPRINGFIT_INSTANTIATION void add_elastic_forces(const BiquadraticNetwork<2, float>&, const Points<2, float>&,
                                                Points<2, float>&);
SPRINGFIT_INSTANTIATION void add_forces(const BiquadraticNetwork<2, float>&, const Points<2, float>&,
                                        const Points<2, float>&, Points<2, float>&);
SPRINGFIT_INSTANTIATION void compute_accelerations(const BiquadraticNetwork<2, float>&, const Points<2, float>&,
                                                   const Points<2, float>&, const Points<2, float>&, Points<2, float>&);
SPRINGFIT_INSTANTIATION BlockMatrix<2, float> network_matrix(const BiquadraticNetwork<2, float>&, const FreeNodes&);
SPRINGFIT_INSTANTIATION void add_stiffness(const BiquadraticNetwork<2, float>&, const Points<2, float>&, HessianForm,
                                           BlockMatrix<2, float>&);
SPRINGFIT_INSTANTIATION float stable_step_at(const BiquadraticNetwork<2, float>&, const Points<2, float>&);
SPRINGFIT_INSTANTIATION void validate(const BiquadraticNetwork<3, float>&);
SPRINGFIT_INSTANTIATION BiquadraticNetwork<3, float> biquadratic_network(const Mesh<3, float, Tri3>&,
                                                                         const BiquadraticOptions<float>&);
SPRINGFIT_INSTANTIATION BiquadraticCoefficients<float> delingette(const Mesh<3, float, Tri3>&, const IsotropicSolid&);
SPRINGFIT_INSTANTIATION void apply(const BiquadraticCoefficients<float>&, BiquadraticNetwork<3, float>&);
SPRINGFIT_INSTANTIATION float elastic_energy(const BiquadraticNetwork<3, float>&, const Points<3, float>&);
SPRINGFIT_INSTANTIATION void add_elastic_forces(const BiquadraticNetwork<3, float>&, const Points<3, float>&,
                                                Points<3, float>&);
SPRINGFIT_INSTANTIATION void add_forces(const BiquadraticNetwork<3, float>&, const Points<3, float>&,
                                        const Points<3, float>&, Points<3, float>&);
SPRINGFIT_INSTANTIATION void compute_accelerations(const BiquadraticNetwork<3, float>&, const Points<3, float>&,
                                                   const Points<3, float>&, const Points<3, float>&, Points<3, float>&);
SPRINGFIT_INSTANTIATION BlockMatrix<3, float> network_matrix(const BiquadraticNetwork<3, float>&, const FreeNodes&);
SPRINGFIT_INSTANTIATION void add_stiffness(const BiquadraticNetwork<3, float>&, const Points<3, float>&, HessianForm,
                                           BlockMatrix<3, float>&);
SPRINGFIT_INSTANTIATION float stable_step_at(const BiquadraticNetwork<3, float>&, const Points<3, float>&);

} // namespace springfit
