// SPDX-License-Identifier: BSD-3-Clause
// Networks of meshes, and their forces.

namespace springfit {

SPRINGFIT_INSTANTIATION void validate(const SpringNetwork<2, double>&);
SPRINGFIT_INSTANTIATION void validate(const Scenario<2, double>&, Index);
SPRINGFIT_INSTANTIATION void validate(const Motion<2, double>&);
SPRINGFIT_INSTANTIATION void add_stiffness(const SpringNetwork<2, double>&, const Points<2, double>&, Curvature,
                                           CliqueMatrix<2, double>&);
SPRINGFIT_INSTANTIATION void compute_accelerations(const SpringNetwork<2, double>&, const Points<2, double>&,
                                                   const Points<2, double>&, const Points<2, double>&,
                                                   Points<2, double>&);
SPRINGFIT_INSTANTIATION void validate(const SpringNetwork<2, float>&);
SPRINGFIT_INSTANTIATION void validate(const Scenario<2, float>&, Index);
SPRINGFIT_INSTANTIATION void validate(const Motion<2, float>&);
SPRINGFIT_INSTANTIATION void add_stiffness(const SpringNetwork<2, float>&, const Points<2, float>&, Curvature,
                                           CliqueMatrix<2, float>&);
SPRINGFIT_INSTANTIATION void compute_accelerations(const SpringNetwork<2, float>&, const Points<2, float>&,
                                                   const Points<2, float>&, const Points<2, float>&, Points<2, float>&);
SPRINGFIT_INSTANTIATION void validate(const SpringNetwork<3, double>&);
SPRINGFIT_INSTANTIATION void validate(const Scenario<3, double>&, Index);
SPRINGFIT_INSTANTIATION void validate(const Motion<3, double>&);
SPRINGFIT_INSTANTIATION void add_stiffness(const SpringNetwork<3, double>&, const Points<3, double>&, Curvature,
                                           CliqueMatrix<3, double>&);
SPRINGFIT_INSTANTIATION void compute_accelerations(const SpringNetwork<3, double>&, const Points<3, double>&,
                                                   const Points<3, double>&, const Points<3, double>&,
                                                   Points<3, double>&);
SPRINGFIT_INSTANTIATION void validate(const SpringNetwork<3, float>&);
SPRINGFIT_INSTANTIATION void validate(const Scenario<3, float>&, Index);
SPRINGFIT_INSTANTIATION void validate(const Motion<3, float>&);
SPRINGFIT_INSTANTIATION void add_stiffness(const SpringNetwork<3, float>&, const Points<3, float>&, Curvature,
                                           CliqueMatrix<3, float>&);
SPRINGFIT_INSTANTIATION void compute_accelerations(const SpringNetwork<3, float>&, const Points<3, float>&,
                                                   const Points<3, float>&, const Points<3, float>&, Points<3, float>&);

SPRINGFIT_INSTANTIATION SpringNetwork<2, double> springs_along_edges(const Mesh<2, double, Tri3>&,
                                                                     const SpringOptions<double>&);
SPRINGFIT_INSTANTIATION SpringNetwork<2, float> springs_along_edges(const Mesh<2, float, Tri3>&,
                                                                    const SpringOptions<float>&);
SPRINGFIT_INSTANTIATION SpringNetwork<2, double> springs_along_edges(const Mesh<2, double, Quad4>&,
                                                                     const SpringOptions<double>&);
SPRINGFIT_INSTANTIATION SpringNetwork<2, float> springs_along_edges(const Mesh<2, float, Quad4>&,
                                                                    const SpringOptions<float>&);
SPRINGFIT_INSTANTIATION SpringNetwork<3, double> springs_along_edges(const Mesh<3, double, Tet4>&,
                                                                     const SpringOptions<double>&);
SPRINGFIT_INSTANTIATION SpringNetwork<3, float> springs_along_edges(const Mesh<3, float, Tet4>&,
                                                                    const SpringOptions<float>&);
SPRINGFIT_INSTANTIATION SpringNetwork<3, double> springs_along_edges(const Mesh<3, double, Hex8>&,
                                                                     const SpringOptions<double>&);
SPRINGFIT_INSTANTIATION SpringNetwork<3, float> springs_along_edges(const Mesh<3, float, Hex8>&,
                                                                    const SpringOptions<float>&);
SPRINGFIT_INSTANTIATION SpringNetwork<3, double> springs_along_edges(const Mesh<3, double, Tri3>&,
                                                                     const SpringOptions<double>&);
SPRINGFIT_INSTANTIATION SpringNetwork<3, float> springs_along_edges(const Mesh<3, float, Tri3>&,
                                                                    const SpringOptions<float>&);

} // namespace springfit
