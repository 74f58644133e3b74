// SPDX-License-Identifier: BSD-3-Clause
// The closed forms that hold for a mesh.

namespace springfit {

SPRINGFIT_INSTANTIATION std::vector<NamedClosedForm<double>> closed_forms(const Mesh<2, double, Quad4>&,
                                                                          const NodePairs&, const IsotropicSolid&);
SPRINGFIT_INSTANTIATION std::vector<NamedClosedForm<double>> closed_forms(const Mesh<3, double, Hex8>&,
                                                                          const NodePairs&, const IsotropicSolid&);
SPRINGFIT_INSTANTIATION std::vector<NamedClosedForm<double>> closed_forms(const Mesh<2, double, Tri3>&,
                                                                          const NodePairs&, const IsotropicSolid&);
SPRINGFIT_INSTANTIATION std::vector<NamedClosedForm<double>> closed_forms(const Mesh<3, double, Tet4>&,
                                                                          const NodePairs&, const IsotropicSolid&);
SPRINGFIT_INSTANTIATION std::vector<NamedClosedForm<double>> closed_forms(const Mesh<3, double, Tri3>&,
                                                                          const NodePairs&, const IsotropicSolid&);

} // namespace springfit
