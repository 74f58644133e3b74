// SPDX-License-Identifier: BSD-3-Clause
// Meshes of the tests.

namespace springfit {

SPRINGFIT_INSTANTIATION Mesh<2, double, Tri3> triangle_grid(const GridSize<2>&, const Vector<2, double>&);
SPRINGFIT_INSTANTIATION Mesh<2, double, Quad4> quad_grid(const GridSize<2>&, const Vector<2, double>&);
SPRINGFIT_INSTANTIATION Mesh<3, double, Tet4> tetrahedron_grid(const GridSize<3>&, const Vector<3, double>&);
SPRINGFIT_INSTANTIATION Mesh<3, double, Hex8> hex_grid(const GridSize<3>&, const Vector<3, double>&);
SPRINGFIT_INSTANTIATION void jitter(Mesh<2, double, Tri3>&, double, unsigned);
SPRINGFIT_INSTANTIATION void jitter(Mesh<2, double, Quad4>&, double, unsigned);
SPRINGFIT_INSTANTIATION void jitter(Mesh<3, double, Tet4>&, double, unsigned);
SPRINGFIT_INSTANTIATION void jitter(Mesh<3, double, Hex8>&, double, unsigned);
SPRINGFIT_INSTANTIATION void validate(const Mesh<2, double, Tri3>&);
SPRINGFIT_INSTANTIATION NodePairs edges(const Mesh<2, double, Tri3>&);
SPRINGFIT_INSTANTIATION std::vector<int> boundary_nodes(const Mesh<2, double, Tri3>&);
SPRINGFIT_INSTANTIATION std::vector<Facet<Tri3>> boundary_facets(const Mesh<2, double, Tri3>&);
SPRINGFIT_INSTANTIATION Values<double> cell_volumes(const Mesh<2, double, Tri3>&, double);
SPRINGFIT_INSTANTIATION Values<double> node_masses(const Mesh<2, double, Tri3>&, double, double);
SPRINGFIT_INSTANTIATION void validate(const Mesh<2, double, Quad4>&);
SPRINGFIT_INSTANTIATION NodePairs edges(const Mesh<2, double, Quad4>&);
SPRINGFIT_INSTANTIATION std::vector<int> boundary_nodes(const Mesh<2, double, Quad4>&);
SPRINGFIT_INSTANTIATION std::vector<Facet<Quad4>> boundary_facets(const Mesh<2, double, Quad4>&);
SPRINGFIT_INSTANTIATION Values<double> cell_volumes(const Mesh<2, double, Quad4>&, double);
SPRINGFIT_INSTANTIATION Values<double> node_masses(const Mesh<2, double, Quad4>&, double, double);
SPRINGFIT_INSTANTIATION void validate(const Mesh<3, double, Tet4>&);
SPRINGFIT_INSTANTIATION NodePairs edges(const Mesh<3, double, Tet4>&);
SPRINGFIT_INSTANTIATION std::vector<int> boundary_nodes(const Mesh<3, double, Tet4>&);
SPRINGFIT_INSTANTIATION std::vector<Facet<Tet4>> boundary_facets(const Mesh<3, double, Tet4>&);
SPRINGFIT_INSTANTIATION Values<double> cell_volumes(const Mesh<3, double, Tet4>&, double);
SPRINGFIT_INSTANTIATION Values<double> node_masses(const Mesh<3, double, Tet4>&, double, double);
SPRINGFIT_INSTANTIATION void validate(const Mesh<3, double, Hex8>&);
SPRINGFIT_INSTANTIATION NodePairs edges(const Mesh<3, double, Hex8>&);
SPRINGFIT_INSTANTIATION std::vector<int> boundary_nodes(const Mesh<3, double, Hex8>&);
SPRINGFIT_INSTANTIATION std::vector<Facet<Hex8>> boundary_facets(const Mesh<3, double, Hex8>&);
SPRINGFIT_INSTANTIATION Values<double> cell_volumes(const Mesh<3, double, Hex8>&, double);
SPRINGFIT_INSTANTIATION Values<double> node_masses(const Mesh<3, double, Hex8>&, double, double);
SPRINGFIT_INSTANTIATION Mesh<2, float, Tri3> triangle_grid(const GridSize<2>&, const Vector<2, float>&);
SPRINGFIT_INSTANTIATION Mesh<2, float, Quad4> quad_grid(const GridSize<2>&, const Vector<2, float>&);
SPRINGFIT_INSTANTIATION Mesh<3, float, Tet4> tetrahedron_grid(const GridSize<3>&, const Vector<3, float>&);
SPRINGFIT_INSTANTIATION Mesh<3, float, Hex8> hex_grid(const GridSize<3>&, const Vector<3, float>&);
SPRINGFIT_INSTANTIATION void jitter(Mesh<2, float, Tri3>&, float, unsigned);
SPRINGFIT_INSTANTIATION void jitter(Mesh<2, float, Quad4>&, float, unsigned);
SPRINGFIT_INSTANTIATION void jitter(Mesh<3, float, Tet4>&, float, unsigned);
SPRINGFIT_INSTANTIATION void validate(const Mesh<2, float, Tri3>&);
SPRINGFIT_INSTANTIATION NodePairs edges(const Mesh<2, float, Tri3>&);
SPRINGFIT_INSTANTIATION std::vector<int> boundary_nodes(const Mesh<2, float, Tri3>&);
SPRINGFIT_INSTANTIATION std::vector<Facet<Tri3>> boundary_facets(const Mesh<2, float, Tri3>&);
SPRINGFIT_INSTANTIATION Values<float> cell_volumes(const Mesh<2, float, Tri3>&, float);
SPRINGFIT_INSTANTIATION Values<float> node_masses(const Mesh<2, float, Tri3>&, float, float);
SPRINGFIT_INSTANTIATION void validate(const Mesh<3, float, Tet4>&);
SPRINGFIT_INSTANTIATION NodePairs edges(const Mesh<3, float, Tet4>&);
SPRINGFIT_INSTANTIATION std::vector<int> boundary_nodes(const Mesh<3, float, Tet4>&);
SPRINGFIT_INSTANTIATION std::vector<Facet<Tet4>> boundary_facets(const Mesh<3, float, Tet4>&);
SPRINGFIT_INSTANTIATION Values<float> cell_volumes(const Mesh<3, float, Tet4>&, float);
SPRINGFIT_INSTANTIATION Values<float> node_masses(const Mesh<3, float, Tet4>&, float, float);
SPRINGFIT_INSTANTIATION void validate(const Mesh<3, double, Tri3>&);

} // namespace springfit
