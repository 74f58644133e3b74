// SPDX-License-Identifier: BSD-3-Clause
// In single precision: matrices, factors, solvers, networks, and the FEM's statics and dynamics.

namespace springfit {

SPRINGFIT_INSTANTIATION class SymmetricMatrix<float>;
SPRINGFIT_INSTANTIATION class SymmetricSolver<float>;
SPRINGFIT_INSTANTIATION class BlockMatrix<2, float>;
SPRINGFIT_INSTANTIATION class BlockMatrix<3, float>;
SPRINGFIT_INSTANTIATION class detail::NodeCholesky<2, float>;
SPRINGFIT_INSTANTIATION class detail::NodeCholesky<3, float>;
SPRINGFIT_INSTANTIATION class CorotatedPreconditioner<2, float>;
SPRINGFIT_INSTANTIATION class CorotatedPreconditioner<3, float>;
SPRINGFIT_INSTANTIATION class CorotatedSolver<2, float>;
SPRINGFIT_INSTANTIATION class CorotatedSolver<3, float>;
SPRINGFIT_INSTANTIATION class fem::Stiffness<2, float>;
SPRINGFIT_INSTANTIATION class fem::Stiffness<3, float>;
SPRINGFIT_INSTANTIATION void validate(const SpringNetwork<2, float>&);
SPRINGFIT_INSTANTIATION void validate(const Scenario<2, float>&, Index);
SPRINGFIT_INSTANTIATION void validate(const Motion<2, float>&);
SPRINGFIT_INSTANTIATION void add_stiffness(const SpringNetwork<2, float>&, const Points<2, float>&, HessianForm,
                                           BlockMatrix<2, float>&);
SPRINGFIT_INSTANTIATION void compute_accelerations(const SpringNetwork<2, float>&, const Points<2, float>&,
                                                   const Points<2, float>&, const Points<2, float>&, Points<2, float>&);
SPRINGFIT_INSTANTIATION void validate(const SpringNetwork<3, float>&);
SPRINGFIT_INSTANTIATION void validate(const Scenario<3, float>&, Index);
SPRINGFIT_INSTANTIATION void validate(const Motion<3, float>&);
SPRINGFIT_INSTANTIATION void add_stiffness(const SpringNetwork<3, float>&, const Points<3, float>&, HessianForm,
                                           BlockMatrix<3, float>&);
SPRINGFIT_INSTANTIATION void compute_accelerations(const SpringNetwork<3, float>&, const Points<3, float>&,
                                                   const Points<3, float>&, const Points<3, float>&, Points<3, float>&);
SPRINGFIT_INSTANTIATION SpringNetwork<2, float> springs_along_edges(const Mesh<2, float, Tri3>&,
                                                                    const SpringOptions<float>&);
SPRINGFIT_INSTANTIATION SpringNetwork<2, float> springs_along_edges(const Mesh<2, float, Quad4>&,
                                                                    const SpringOptions<float>&);
SPRINGFIT_INSTANTIATION SpringNetwork<3, float> springs_along_edges(const Mesh<3, float, Tet4>&,
                                                                    const SpringOptions<float>&);
SPRINGFIT_INSTANTIATION SpringNetwork<3, float> springs_along_edges(const Mesh<3, float, Hex8>&,
                                                                    const SpringOptions<float>&);
SPRINGFIT_INSTANTIATION SpringNetwork<3, float> springs_along_edges(const Mesh<3, float, Tri3>&,
                                                                    const SpringOptions<float>&);

} // namespace springfit

namespace springfit::fem {

SPRINGFIT_INSTANTIATION class Statics<2, float>;
SPRINGFIT_INSTANTIATION class Statics<3, float>;
SPRINGFIT_INSTANTIATION class Dynamics<2, float>;
SPRINGFIT_INSTANTIATION class Dynamics<3, float>;

} // namespace springfit::fem
