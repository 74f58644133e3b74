// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <springfit/fem/stiffness.hpp>

namespace springfit::fem {

/// The kind of a plane body: a thin sheet, free to change its thickness, or a slice of a long body, which cannot.
enum class Plane { stress, strain };

/// Where the volume measure theta enters the energy U(theta).
enum class Dilatation {
    pointwise, ///< at each quadrature point: the plain element, which locks near incompressibility
    mean       ///< its mean over a patch: around each node in Tri3 and Tet4, over the cell in the others
};

template <std::floating_point Scalar = double>
struct ModelOptions {
    Scalar thickness = 1;                          ///< h, m, > 0; of plane bodies and membranes
    Plane plane = Plane::stress;                   ///< of plane bodies; membranes are in plane stress
    Dilatation dilatation = Dilatation::pointwise; ///< `mean` for solids and plane strain
    Scalar mass_damping = 0;                       ///< alpha of Rayleigh damping, 1/s, >= 0
    Scalar stiffness_damping = 0;                  ///< beta of Rayleigh damping, s, >= 0
};

/// The kind of an elastic body, by which its solvers are chosen.
struct BodyKind {
    bool is_linear = false;   ///< forces are linear in the displacement
    bool is_membrane = false; ///< a surface in space
    bool is_solid = false;    ///< neither plane nor a membrane
};

/// An elastic body as statics and dynamics see it, whatever its cells and its material: `Model` is one.
///
/// They are compiled once for each dimension and scalar, not for each element and material; a virtual call is made
/// once per assembly or sum over all cells.
template <int Dim, std::floating_point ScalarType>
class ElasticBody {
public:
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    virtual ~ElasticBody() = default;

    /// Rest positions `[Dim x n_nodes]`, m.
    [[nodiscard]] virtual const Points<Dim, Scalar>& rest_positions() const = 0;
    /// Lumped masses `[n_nodes]`, kg, > 0.
    [[nodiscard]] virtual const Values<Scalar>& masses() const = 0;
    [[nodiscard]] virtual const ModelOptions<Scalar>& options() const = 0;
    [[nodiscard]] virtual BodyKind kind() const = 0;

    /// Elastic energy at positions x `[Dim x n_nodes]`, J; not finite where the material does not allow x.
    [[nodiscard]] virtual Scalar energy(const Points<Dim, Scalar>& x) const = 0;
    /// Rounding error of `energy`, whatever the positions, J.
    [[nodiscard]] virtual Scalar energy_rounding() const = 0;
    /// Gradient of the energy `[Dim x n_nodes]`, N: the force that has to act on the nodes to hold them at x.
    [[nodiscard]] virtual Points<Dim, Scalar> internal_forces(const Points<Dim, Scalar>& x) const = 0;

    /// The nodes of each cell, which its stiffness couples.
    [[nodiscard]] virtual Cliques cells() const = 0;
    /// An empty stiffness with the pattern of this body, for `assemble`.
    [[nodiscard]] virtual Stiffness<Dim, Scalar> make_stiffness(const FreeNodes& free) const = 0;
    /// Fills `stiffness` with the exact second derivative of the energy at x, N/m.
    virtual void assemble(const Points<Dim, Scalar>& x, Stiffness<Dim, Scalar>& stiffness) const = 0;

    /// A body of the same cells that preconditions this one: Poisson's ratio at most 0.4 and the dilatation of each
    /// point on its own. (Patches would fill its factor, and this is as good.)
    [[nodiscard]] virtual std::unique_ptr<const ElasticBody> preconditioner() const = 0;

protected:
    ElasticBody() = default;
    ElasticBody(const ElasticBody&) = default;
    ElasticBody(ElasticBody&&) = default;
    ElasticBody& operator=(const ElasticBody&) = default;
    ElasticBody& operator=(ElasticBody&&) = default;
};

/// A type of body that can be stepped and solved: it derives from `ElasticBody` of its dimension and scalar.
template <class M>
concept Elastic = std::derived_from<M, ElasticBody<M::dimension, typename M::Scalar>>;

} // namespace springfit::fem
