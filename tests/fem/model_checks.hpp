// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bodies.hpp"
#include "tolerance.hpp"

namespace springfit::test {

/// An affine map near a rotation; in a membrane's plane and out of it.
template <int Dim, class Scalar>
Eigen::Matrix<Scalar, Dim, Dim> stretch_and_turn() {
    Eigen::Matrix<Scalar, Dim, Dim> f = Eigen::Matrix<Scalar, Dim, Dim>::Identity();
    f(0, 0) = Scalar(1.2);
    f(0, 1) = Scalar(0.15);
    f(1, 1) = Scalar(0.9);
    return turn<Dim, Scalar>() * f;
}

/// An affine map gives the energy of one point and no force inside.
template <class B>
void check_affine_map() {
    constexpr int dim = B::dimension;
    using Scalar = typename B::Scalar;
    const auto mesh = box<dim, Scalar, typename B::Cell>(3);
    const auto outer = boundary_nodes(mesh);
    for (const auto& options : settings<B>()) {
        const fem::Model model{mesh, fem::NeoHookean{.young = 3., .poisson = 0.3}, 1., options};
        const auto f = stretch_and_turn<dim, Scalar>();
        const Points<dim, Scalar> x = f * mesh.nodes;
        const Points<dim, Scalar> forces = model.internal_forces(x);
        Scalar inside = 0;
        for (Index i = 0; i < mesh.n_nodes(); ++i) {
            const bool is_middle = i >= mesh.cells.topRows(B::Cell::n_corners).maxCoeff() + 1; // on an edge
            if (!is_middle && !std::binary_search(outer.begin(), outer.end(), static_cast<int>(i))) {
                inside = std::max(inside, forces.col(i).norm());
            }
        }
        CHECK(inside < rounding<Scalar>(300) * forces.norm());
        // the energy does not depend on the mesh: one cell per axis says the same
        const fem::Model coarse{box<dim, Scalar, typename B::Cell>(1), fem::NeoHookean{.young = 3., .poisson = 0.3}, 1.,
                                options};
        CHECK(relative(model.energy(x), coarse.energy(f * coarse.rest_positions()), model.energy(x)) <
              rounding<Scalar>(300));
        CHECK(forces.rowwise().sum().norm() < rounding<Scalar>(300) * forces.norm());
    }
}

/// Rigid motions cost nothing.
template <class B>
void check_rigid_motions() {
    constexpr int dim = B::dimension;
    using Scalar = typename B::Scalar;
    const auto mesh = box<dim, Scalar, typename B::Cell>(2);
    const auto check = [&](const auto& model, const Points<dim, Scalar>& x) {
        const Points<dim, Scalar> scale = model.internal_forces(Scalar(1.5) * mesh.nodes);
        CHECK(model.internal_forces(x).norm() < rounding<Scalar>(300) * scale.norm());
        CHECK(std::abs(model.energy(x)) < rounding<Scalar>(300) * scale.norm());
    };
    const Points<dim, Scalar> moved =
        (turn<dim, Scalar>() * mesh.nodes).colwise() + Vector<dim, Scalar>::Constant(Scalar(0.7));
    for (const auto& options : settings<B>()) {
        check(fem::Model{mesh, fem::NeoHookean{2., 0.4}, 1., options}, moved);
        check(fem::Model{mesh, fem::Corotated{2., 0.4}, 1., options}, moved);
    }
    check(fem::Model{mesh, fem::StVenantKirchhoff{2., 0.4}, 1.}, moved);
    // small strains know translations and infinitesimal rotations only
    Eigen::Matrix<Scalar, dim, dim> spin = Eigen::Matrix<Scalar, dim, dim>::Zero();
    spin(0, dim - 1) = Scalar(0.5);
    spin(dim - 1, 0) = Scalar(-0.5);
    check(fem::Model{mesh, fem::LinearElastic{2., 0.4}, 1.},
          (mesh.nodes + spin * mesh.nodes).colwise() + Vector<dim, Scalar>::Constant(Scalar(0.7)));
}

/// Masses are positive and add up to the body's.
template <class B>
void check_masses() {
    constexpr int dim = B::dimension;
    using Scalar = typename B::Scalar;
    const auto mesh = box<dim, Scalar, typename B::Cell>(3);
    const auto options = settings<B>().front();
    const fem::Model model{mesh, fem::LinearElastic{1., 0.3}, 1000., options};
    const auto total = static_cast<Scalar>(1000. * box_volume<typename B::Cell> * options.thickness);
    CHECK(model.masses().minCoeff() > 0);
    CHECK(relative(model.masses().sum(), total, total) < rounding<Scalar>());
    const SparseMatrix<Scalar> mass = model.consistent_mass(FreeNodes(mesh.n_nodes(), {}));
    const SparseMatrix<Scalar> full = mass.template selfadjointView<Eigen::Lower>();
    CHECK(relative(full.sum(), dim * total, total) < rounding<Scalar>(1000));
    if (B::Cell::n_nodes == B::Cell::n_corners) {
        for (Index i = 0; i < mesh.n_nodes(); ++i) {
            CHECK(relative(full.col(dim * i).sum(), model.masses()(i), model.masses()(i)) < rounding<Scalar>());
        }
    }
}

} // namespace springfit::test
