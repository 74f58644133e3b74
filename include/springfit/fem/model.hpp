// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fem/detail/law.hpp>
#include <springfit/fem/elastic_body.hpp>
#include <springfit/mesh/element.hpp>
#include <springfit/mesh/mesh.hpp>

namespace springfit::fem {

/// Throws InvalidArgument where `validate` of the mesh does, and for a cell that is inverted or has no volume at rest,
/// naming it. O(cells).
template <int Dim, std::floating_point Scalar, FiniteElementCell Cell>
void validate(const Mesh<Dim, Scalar, Cell>& mesh);

/// An elastic body by finite elements: energies, internal forces, tangents and masses at the nodes of a mesh.
///
///     const fem::Model model{mesh, fem::NeoHookean{.young = 5e4, .poisson = 0.45}, 1000.};
///     const Points<3, double> f = model.internal_forces(x); // M a = f_ext - f(x) - D v
///
/// W = sum over quadrature points of w_q shear(F_q), plus sum over patches of V_p U(theta_p) with
/// theta_p = sum_q w_q theta_q / V_p; a patch is one point unless the dilatation is `mean`. Triangles and
/// quadrilaterals in space make a membrane: F is [3 x 2], in plane stress. The rest gradients are kept at every point.
/// A model of the concept Reference (`fem/dynamics.hpp`).
template <int Dim, std::floating_point ScalarType, FiniteElementCell Cell, Material Mat>
    requires SpatialDimension<Dim>
class Model final : public ElasticBody<Dim, ScalarType> {
public:
    using Scalar = ScalarType;
    static constexpr bool is_membrane = springfit::is_membrane<Dim, Scalar, Cell>;
    static constexpr bool is_solid = Cell::dimension == 3;
    static constexpr bool is_linear = std::same_as<Mat, LinearElastic>; ///< forces are linear in the displacement

    /// `density` rho in kg/m^3, > 0. Throws InvalidArgument for a mesh, material or option that cannot be used.
    Model(const Mesh<Dim, Scalar, Cell>& mesh, const Mat& material, double density,
          const ModelOptions<Scalar>& options = {});

    [[nodiscard]] const Mesh<Dim, Scalar, Cell>& mesh() const { return m_mesh; }
    [[nodiscard]] const Mat& material() const { return m_material; }
    [[nodiscard]] const ModelOptions<Scalar>& options() const override { return m_options; }
    [[nodiscard]] Scalar density() const { return m_density; }
    [[nodiscard]] BodyKind kind() const override {
        return {.is_linear = is_linear, .is_membrane = is_membrane, .is_solid = is_solid};
    }
    /// Rest positions `[Dim x n_nodes]`, m.
    [[nodiscard]] const Points<Dim, Scalar>& rest_positions() const override { return m_mesh.nodes; }
    /// Lumped masses `[n_nodes]`, kg, all positive with the exact total: row sums of the consistent mass in linear
    /// cells, its diagonal scaled to the cell's mass in quadratic ones.
    [[nodiscard]] const Values<Scalar>& masses() const override { return m_masses; }

    /// Consistent mass of the free nodes, int rho N_a N_b dV in each direction; lower triangle, kg.
    [[nodiscard]] SparseMatrix<Scalar> consistent_mass(const FreeNodes& free) const;

    /// Elastic energy at positions x `[Dim x n_nodes]`, J; not finite where the material does not allow x.
    [[nodiscard]] Scalar energy(const Points<Dim, Scalar>& x) const override;

    /// Rounding error of `energy`, whatever the positions: its terms are of the size of E times volume, J.
    [[nodiscard]] Scalar energy_rounding() const override {
        return 4 * std::numeric_limits<Scalar>::epsilon() * static_cast<Scalar>(m_material.young) * m_weights.sum();
    }

    /// Gradient of the energy `[Dim x n_nodes]`, N: the force that has to act on the nodes to hold them at x.
    [[nodiscard]] Points<Dim, Scalar> internal_forces(const Points<Dim, Scalar>& x) const override;

    [[nodiscard]] Cliques cells() const override { return cliques_of(m_mesh.cells); }

    /// An empty stiffness with the pattern of this body, for `assemble`.
    [[nodiscard]] Stiffness<Dim, Scalar> make_stiffness(const FreeNodes& free) const override {
        return {free, cells(), has_node_patches()};
    }

    /// Fills `stiffness` with the exact second derivative of the energy at x, N/m.
    void assemble(const Points<Dim, Scalar>& x, Stiffness<Dim, Scalar>& stiffness) const override;

    /// The same as one sparse matrix, lower triangle `[Dim * n_free x Dim * n_free]`.
    [[nodiscard]] SparseMatrix<Scalar> stiffness(const Points<Dim, Scalar>& x, const FreeNodes& free) const {
        auto result = make_stiffness(free);
        assemble(x, result);
        return result.matrix().assembled();
    }

    [[nodiscard]] std::unique_ptr<const ElasticBody<Dim, Scalar>> preconditioner() const override;

    /// Calls `visit(cell, N, dV)` at the points of the mass rule: shape functions `[n_nodes of a cell]` and rest volume
    /// dV (area times thickness), for integrals over the rest body.
    template <class Visit>
    void for_mass_points(const Visit& visit) const;

private:
    static constexpr int n = Cell::n_nodes;
    static constexpr int plane = Cell::dimension; // columns of F
    static constexpr int n_points = static_cast<int>(Element<Cell>::stiffness_rule.size());
    /// One point per cell: its nodes' patches. More points: the cell itself.
    static constexpr bool patches_at_nodes = n_points == 1;

    using CellPoints = Eigen::Matrix<Scalar, Dim, n>;
    using Gradients = Eigen::Matrix<Scalar, n, plane>;
    using Deformation = Eigen::Matrix<Scalar, Dim, plane>;
    using PointResponse = detail::Response<Dim, plane, Scalar>;
    using Pressures = std::vector<detail::Volumetric<Scalar>>; // of the patches

    [[nodiscard]] bool is_mean() const { return m_options.dilatation == Dilatation::mean; }
    [[nodiscard]] bool has_node_patches() const { return is_mean() && patches_at_nodes; }

    void check_options() const;
    void take_rest_gradients();
    void take_masses();
    [[nodiscard]] CellPoints cell_points(const Points<Dim, Scalar>& x, Index cell) const;
    [[nodiscard]] Eigen::Map<const Gradients> gradients(Index point) const {
        return Eigen::Map<const Gradients>(m_gradients.col(point).data());
    }
    template <int Order>
    void evaluate(Index point, const Deformation& f, PointResponse& out) const;
    template <class Visit>
    void for_patches(Index cell, const Visit& visit) const;
    [[nodiscard]] Pressures patch_pressures(const Points<Dim, Scalar>& x) const;
    [[nodiscard]] Scalar pressure_on(Index cell, const Pressures& pressures) const;

    Mesh<Dim, Scalar, Cell> m_mesh;
    Mat m_material;
    ModelOptions<Scalar> m_options;
    Scalar m_density;
    detail::Law<Mat, Scalar> m_law;
    Eigen::Matrix<Scalar, n * plane, Eigen::Dynamic> m_gradients; ///< dN_a/dX, one column per point
    Values<Scalar> m_weights;                                     ///< rest volume of each point, m^3
    Eigen::Matrix<Scalar, Dim * plane, Eigen::Dynamic> m_frames;  ///< tangents of a membrane's points
    Values<Scalar> m_patch_volumes;                               ///< of the mean dilatation, m^3
    Values<Scalar> m_masses;
};

} // namespace springfit::fem

#include <springfit/fem/detail/model_energy_impl.hpp>
#include <springfit/fem/detail/model_impl.hpp>
