// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/closed_form/isotropic_solid.hpp>
#include <springfit/fem/model.hpp>
#include <springfit/network/forces.hpp>

namespace springfit::test {

/// Tangent stiffness of a network in its rest positions over all nodes, dense.
template <int Dim>
[[nodiscard]] DenseMatrix<double> network_stiffness(const SpringNetwork<Dim, double>& network) {
    auto matrix = network_matrix(network, FreeNodes(network.n_nodes(), {}));
    add_stiffness<Dim, double>(network, network.rest_positions, HessianForm::exact, matrix);
    const DenseMatrix<double> lower = matrix.matrix();
    return lower.selfadjointView<Eigen::Lower>();
}

/// Stiffness of the plain linear finite elements over all nodes, dense; plane stress in the plane.
template <int Dim, class Cell>
[[nodiscard]] DenseMatrix<double> element_stiffness(const Mesh<Dim, double, Cell>& mesh, const IsotropicSolid& solid) {
    fem::ModelOptions<double> options;
    options.thickness = Cell::dimension == 2 ? solid.thickness : 1;
    options.plane = solid.plane_strain ? fem::Plane::strain : fem::Plane::stress;
    const fem::Model model{mesh, fem::LinearElastic{solid.young, solid.poisson}, 1., options};
    const DenseMatrix<double> lower = model.stiffness(mesh.nodes, FreeNodes(mesh.n_nodes(), {}));
    return lower.selfadjointView<Eigen::Lower>();
}

/// A regular tetrahedron.
[[nodiscard]] inline Mesh<3, double, Tet4> regular_tetrahedron(double edge) {
    Mesh<3, double, Tet4> mesh;
    mesh.nodes.resize(3, 4);
    mesh.nodes << 0, 1, 0, 1, /**/ 0, 1, 1, 0, /**/ 0, 0, 1, 1;
    mesh.nodes *= edge / std::sqrt(2.);
    mesh.cells.resize(4, 1);
    mesh.cells << 0, 1, 2, 3;
    return mesh;
}

} // namespace springfit::test
