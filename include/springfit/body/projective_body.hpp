// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/body/detail/incremental_potential.hpp>
#include <springfit/body/detail/triangular_factor.hpp>

namespace springfit {

template <std::floating_point Scalar>
struct ProjectiveBodyOptions {
    int max_iterations = 10;         ///< most iterations of a step, >= 1
    Scalar tolerance = Scalar(1e-4); ///< ends the iterations: largest unbalanced force relative to the largest force
                                     ///< that moves a node, > 0
};

/// A network in motion under implicit Euler, by the local-global scheme for mass-spring systems: the incremental
/// potential of `ImplicitBody` is minimised by turns over the directions d_e = l_e n_e of the springs (local) and over
/// the positions with the d_e held (global),
///
///     (M/h^2 + L) x = M/h^2 (x_n + h v_n) + J d + f_ext ,
///
/// L the graph Laplacian with the weights k_e + c_e/h, one matrix for all coordinates. It depends on h and on the
/// clamps alone: it is factorised when they change, and steps share the factor. It is above the Hessian at any
/// positions, so every iteration falls, without a line search, and the limit is the implicit step; but slowly where
/// the body turns or bends much in a step. Damping is that of `ImplicitBody`, its share in the matrix an upper bound.
///
/// An iteration is one pass over springs and two triangular solves. Their cost grows with the fill of the factor: in
/// the plane and for membranes O(n log n), in solids O(n^(4/3)) numbers; docs/springs.md says where it pays.
/// The global solve is done for the change of the positions, in single precision, which limits no result.
///
/// Nodes are numbered as in the network outside. The same bits on any number of threads; the triangular solves use
/// one. A step allocates nothing unless it factorises.
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
class ProjectiveBody : public detail::IncrementalPotential<Dim, ScalarType> {
public:
    using Scalar = ScalarType;

    /// At rest, free, without external forces. Throws InvalidArgument for a network or an option that cannot be used;
    /// cells with volume stiffness are none of its: their energy is not a distance to a projection on one matrix.
    explicit ProjectiveBody(const SpringNetwork<Dim, Scalar>& network,
                            const ProjectiveBodyOptions<Scalar>& options = {}, const Execution& execution = {});

    /// The nodes that no force moves: they go on with the velocity they have. All others are free.
    void set_clamped(const std::vector<int>& nodes);

    [[nodiscard]] int n_factorisations() const { return m_n_factorisations; }
    [[nodiscard]] Index n_factor_entries() const { return m_factor.n_entries(); }

    /// One step of h, s. `diverged`, and the body as it was, where a number is not finite; `failed` where the matrix
    /// cannot be factorised.
    ImplicitStepReport<Scalar> step(Scalar h);

private:
    using Base = detail::IncrementalPotential<Dim, ScalarType>;
    using Four = detail::Four<Scalar>;
    using Found = typename Base::Found;

    void iterate(Scalar h, ImplicitStepReport<Scalar>& report);

    /// The local step: minus the gradient at the positions, J d and all.
    [[nodiscard]] Found evaluate(Scalar h);

    [[nodiscard]] bool factorise(Scalar h);

    ProjectiveBodyOptions<Scalar> m_options;
    detail::TriangularFactor m_factor;
    std::vector<detail::Four<float>> m_residual, m_direction;
    std::vector<char> m_free_before;
    Scalar m_factorised_for = 0;
    int m_n_factorisations = 0;
};

} // namespace springfit

#include <springfit/body/detail/projective_body_impl.hpp>
