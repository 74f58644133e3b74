// SPDX-License-Identifier: BSD-3-Clause
// Networks of the tests, in single precision too, and scenarios.

namespace springfit {

SPRINGFIT_INSTANTIATION SpringNetwork<2, double> springs_from_list(const Points<2, double>&, const NodePairs&,
                                                                   const Values<double>&);
SPRINGFIT_INSTANTIATION void add_volume_cells(SpringNetwork<2, double>&, const Mesh<2, double, Tri3>&);
SPRINGFIT_INSTANTIATION double elastic_energy(const SpringNetwork<2, double>&, const Points<2, double>&);
SPRINGFIT_INSTANTIATION void add_elastic_forces(const SpringNetwork<2, double>&, const Points<2, double>&,
                                                Points<2, double>&);
SPRINGFIT_INSTANTIATION void add_spring_forces(const SpringNetwork<2, double>&, const Points<2, double>&,
                                               const Points<2, double>&, Points<2, double>&);
SPRINGFIT_INSTANTIATION double volume_energy(const SpringNetwork<2, double>&, const Points<2, double>&);
SPRINGFIT_INSTANTIATION void add_volume_forces(const SpringNetwork<2, double>&, const Points<2, double>&,
                                               Points<2, double>&);
SPRINGFIT_INSTANTIATION BlockMatrix<2, double> network_matrix(const SpringNetwork<2, double>&, const FreeNodes&);
SPRINGFIT_INSTANTIATION double stable_step_at(const SpringNetwork<2, double>&, const Points<2, double>&,
                                              const std::vector<int>&);
SPRINGFIT_INSTANTIATION std::vector<int> clamped_nodes(const Scenario<2, double>&, Index);
SPRINGFIT_INSTANTIATION Points<2, double> external_forces(const Scenario<2, double>&, const Values<double>&, double);
SPRINGFIT_INSTANTIATION SpringNetwork<3, double> springs_from_list(const Points<3, double>&, const NodePairs&,
                                                                   const Values<double>&);
SPRINGFIT_INSTANTIATION void add_volume_cells(SpringNetwork<3, double>&, const Mesh<3, double, Tet4>&);
SPRINGFIT_INSTANTIATION double elastic_energy(const SpringNetwork<3, double>&, const Points<3, double>&);
SPRINGFIT_INSTANTIATION void add_elastic_forces(const SpringNetwork<3, double>&, const Points<3, double>&,
                                                Points<3, double>&);
SPRINGFIT_INSTANTIATION void add_spring_forces(const SpringNetwork<3, double>&, const Points<3, double>&,
                                               const Points<3, double>&, Points<3, double>&);
SPRINGFIT_INSTANTIATION double volume_energy(const SpringNetwork<3, double>&, const Points<3, double>&);
SPRINGFIT_INSTANTIATION void add_volume_forces(const SpringNetwork<3, double>&, const Points<3, double>&,
                                               Points<3, double>&);
SPRINGFIT_INSTANTIATION BlockMatrix<3, double> network_matrix(const SpringNetwork<3, double>&, const FreeNodes&);
SPRINGFIT_INSTANTIATION double stable_step_at(const SpringNetwork<3, double>&, const Points<3, double>&,
                                              const std::vector<int>&);
SPRINGFIT_INSTANTIATION std::vector<int> clamped_nodes(const Scenario<3, double>&, Index);
SPRINGFIT_INSTANTIATION Points<3, double> external_forces(const Scenario<3, double>&, const Values<double>&, double);
SPRINGFIT_INSTANTIATION void validate(const SpringNetwork<2, float>&);
SPRINGFIT_INSTANTIATION void validate(const Scenario<2, float>&, Index);
SPRINGFIT_INSTANTIATION void validate(const Motion<2, float>&);
SPRINGFIT_INSTANTIATION void add_stiffness(const SpringNetwork<2, float>&, const Points<2, float>&, HessianForm,
                                           BlockMatrix<2, float>&);
SPRINGFIT_INSTANTIATION void compute_accelerations(const SpringNetwork<2, float>&, const Points<2, float>&,
                                                   const Points<2, float>&, const Points<2, float>&, Points<2, float>&);
SPRINGFIT_INSTANTIATION SpringNetwork<2, float> springs_along_edges(const Mesh<2, float, Tri3>&,
                                                                    const SpringOptions<float>&);
SPRINGFIT_INSTANTIATION SpringNetwork<2, float> springs_from_list(const Points<2, float>&, const NodePairs&,
                                                                  const Values<float>&);
SPRINGFIT_INSTANTIATION void add_volume_cells(SpringNetwork<2, float>&, const Mesh<2, float, Tri3>&);
SPRINGFIT_INSTANTIATION float elastic_energy(const SpringNetwork<2, float>&, const Points<2, float>&);
SPRINGFIT_INSTANTIATION void add_elastic_forces(const SpringNetwork<2, float>&, const Points<2, float>&,
                                                Points<2, float>&);
SPRINGFIT_INSTANTIATION void add_spring_forces(const SpringNetwork<2, float>&, const Points<2, float>&,
                                               const Points<2, float>&, Points<2, float>&);
SPRINGFIT_INSTANTIATION float volume_energy(const SpringNetwork<2, float>&, const Points<2, float>&);
SPRINGFIT_INSTANTIATION void add_volume_forces(const SpringNetwork<2, float>&, const Points<2, float>&,
                                               Points<2, float>&);
SPRINGFIT_INSTANTIATION BlockMatrix<2, float> network_matrix(const SpringNetwork<2, float>&, const FreeNodes&);
SPRINGFIT_INSTANTIATION float stable_step_at(const SpringNetwork<2, float>&, const Points<2, float>&,
                                             const std::vector<int>&);
SPRINGFIT_INSTANTIATION std::vector<int> clamped_nodes(const Scenario<2, float>&, Index);
SPRINGFIT_INSTANTIATION Points<2, float> external_forces(const Scenario<2, float>&, const Values<float>&, float);
SPRINGFIT_INSTANTIATION void validate(const SpringNetwork<3, float>&);
SPRINGFIT_INSTANTIATION void validate(const Scenario<3, float>&, Index);
SPRINGFIT_INSTANTIATION void validate(const Motion<3, float>&);
SPRINGFIT_INSTANTIATION void add_stiffness(const SpringNetwork<3, float>&, const Points<3, float>&, HessianForm,
                                           BlockMatrix<3, float>&);
SPRINGFIT_INSTANTIATION void compute_accelerations(const SpringNetwork<3, float>&, const Points<3, float>&,
                                                   const Points<3, float>&, const Points<3, float>&, Points<3, float>&);
SPRINGFIT_INSTANTIATION SpringNetwork<3, float> springs_along_edges(const Mesh<3, float, Tet4>&,
                                                                    const SpringOptions<float>&);
SPRINGFIT_INSTANTIATION SpringNetwork<3, float> springs_from_list(const Points<3, float>&, const NodePairs&,
                                                                  const Values<float>&);
SPRINGFIT_INSTANTIATION void add_volume_cells(SpringNetwork<3, float>&, const Mesh<3, float, Tet4>&);
SPRINGFIT_INSTANTIATION float elastic_energy(const SpringNetwork<3, float>&, const Points<3, float>&);
SPRINGFIT_INSTANTIATION void add_elastic_forces(const SpringNetwork<3, float>&, const Points<3, float>&,
                                                Points<3, float>&);
SPRINGFIT_INSTANTIATION void add_spring_forces(const SpringNetwork<3, float>&, const Points<3, float>&,
                                               const Points<3, float>&, Points<3, float>&);
SPRINGFIT_INSTANTIATION float volume_energy(const SpringNetwork<3, float>&, const Points<3, float>&);
SPRINGFIT_INSTANTIATION void add_volume_forces(const SpringNetwork<3, float>&, const Points<3, float>&,
                                               Points<3, float>&);
SPRINGFIT_INSTANTIATION BlockMatrix<3, float> network_matrix(const SpringNetwork<3, float>&, const FreeNodes&);
SPRINGFIT_INSTANTIATION float stable_step_at(const SpringNetwork<3, float>&, const Points<3, float>&,
                                             const std::vector<int>&);
SPRINGFIT_INSTANTIATION std::vector<int> clamped_nodes(const Scenario<3, float>&, Index);
SPRINGFIT_INSTANTIATION Points<3, float> external_forces(const Scenario<3, float>&, const Values<float>&, float);

} // namespace springfit
