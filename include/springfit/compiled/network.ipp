// SPDX-License-Identifier: BSD-3-Clause
// Networks of meshes, and their forces.

namespace springfit {

SPRINGFIT_INSTANTIATION void validate(const SpringNetwork<2, double>&);
SPRINGFIT_INSTANTIATION void validate(const Scenario<2, double>&, Index);
SPRINGFIT_INSTANTIATION void validate(const Motion<2, double>&);
SPRINGFIT_INSTANTIATION void add_stiffness(const SpringNetwork<2, double>&, const Points<2, double>&, HessianForm,
                                           BlockMatrix<2, double>&);
SPRINGFIT_INSTANTIATION void compute_accelerations(const SpringNetwork<2, double>&, const Points<2, double>&,
                                                   const Points<2, double>&, const Points<2, double>&,
                                                   Points<2, double>&);
SPRINGFIT_INSTANTIATION void validate(const SpringNetwork<3, double>&);
SPRINGFIT_INSTANTIATION void validate(const Scenario<3, double>&, Index);
SPRINGFIT_INSTANTIATION void validate(const Motion<3, double>&);
SPRINGFIT_INSTANTIATION void add_stiffness(const SpringNetwork<3, double>&, const Points<3, double>&, HessianForm,
                                           BlockMatrix<3, double>&);
SPRINGFIT_INSTANTIATION void compute_accelerations(const SpringNetwork<3, double>&, const Points<3, double>&,
                                                   const Points<3, double>&, const Points<3, double>&,
                                                   Points<3, double>&);
SPRINGFIT_INSTANTIATION SpringNetwork<2, double> springs_along_edges(const Mesh<2, double, Tri3>&,
                                                                     const SpringOptions<double>&);
SPRINGFIT_INSTANTIATION SpringNetwork<2, double> springs_along_edges(const Mesh<2, double, Quad4>&,
                                                                     const SpringOptions<double>&);
SPRINGFIT_INSTANTIATION SpringNetwork<3, double> springs_along_edges(const Mesh<3, double, Tet4>&,
                                                                     const SpringOptions<double>&);
SPRINGFIT_INSTANTIATION SpringNetwork<3, double> springs_along_edges(const Mesh<3, double, Hex8>&,
                                                                     const SpringOptions<double>&);
SPRINGFIT_INSTANTIATION SpringNetwork<3, double> springs_along_edges(const Mesh<3, double, Tri3>&,
                                                                     const SpringOptions<double>&);

} // namespace springfit
