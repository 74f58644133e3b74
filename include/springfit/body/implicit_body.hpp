// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/body/detail/incremental_potential.hpp>
#include <springfit/body/detail/spring_operator.hpp>

namespace springfit {

/// How far an implicit step goes: by default one linearised step, as in real-time use.
template <std::floating_point Scalar>
struct ImplicitBodyOptions {
    int max_iterations = 1;                 ///< most Newton iterations of a step, >= 1
    Scalar linear_tolerance = Scalar(0.01); ///< relative residual of the first linear solve, in (0, 1)
    int max_linear_iterations = 1000;       ///< most conjugate gradients of an iteration, >= 1
    Scalar tolerance = Scalar(1e-8);        ///< ends the iterations: largest unbalanced force relative to the
                                            ///< largest force that moves a node, > 0
};

/// A network in motion under implicit Euler: stable at any step, first order, and it damps what it does not resolve.
///
///     x minimises  1/(2 h^2) |x - x_n - h v_n|_M^2 + E(x) - f_ext . x + 1/(2h) sum_e c_e (n_e . (r_e - r_e^n))^2 ,
///     v = (x - x_n) / h ,
///
/// n_e lagged, by Newton's method from x_n + h v_n, matrix-free: conjugate gradients with the inverse blocks of the
/// diagonal, on 4 cached numbers per spring. The Hessian leaves the negative part of compressed springs and cells out
/// until forces are within 1/100 of balance, and is exact then. From the second iteration on a step that has gone too
/// far along its direction is shortened, and linear solves are tightened as the gradient falls.
///
/// Two uses. With one iteration, the default, the step is a linearised one, and `linear_tolerance` says what it costs.
/// With many iterations and a small tolerance it is the minimum. `LinearScalar` is the precision of the linear solves
/// alone: single precision, which is faster, suffices for any tolerance as long as the step is not above a few hundred
/// times the stable one.
///
/// Nodes are numbered as in the network outside and by locality inside. Several threads, by the `Execution`, give the
/// same bits as one. A step allocates nothing.
template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar = float>
    requires SpatialDimension<Dim>
class ImplicitBody : public detail::IncrementalPotential<Dim, ScalarType> {
public:
    using Scalar = ScalarType;

    /// At rest, free, without external forces. Throws InvalidArgument for a network or an option that cannot be used.
    explicit ImplicitBody(const SpringNetwork<Dim, Scalar>& network, const ImplicitBodyOptions<Scalar>& options = {},
                          const Execution& execution = {});

    /// The nodes that no force moves: they go on with the velocity they have. All others are free.
    void set_clamped(const std::vector<int>& nodes) { this->clamp(nodes); }

    /// One step of h, s. Where a number is not finite, `diverged`, and the body is as it was.
    ImplicitStepReport<Scalar> step(Scalar h);

    /// The Hessian of the incremental potential of a step of h, about the positions as they are, applied to
    /// displacements `[Dim x n_nodes]`, m: N. `exact` or without negative parts.
    [[nodiscard]] Points<Dim, Scalar> apply_hessian(const Points<Dim, Scalar>& displacements, Scalar h, bool exact);

private:
    using Base = detail::IncrementalPotential<Dim, ScalarType>;
    using Packed = typename Base::Packed;
    using Block = typename Packed::Block;
    using Operator = detail::SpringOperator<Dim, LinearScalar>;
    using Four = detail::Four<Scalar>;
    using Lanes = detail::Simd<Scalar, 4>;
    using Found = typename Base::Found;

    void set_inertia(Scalar h);
    void iterate(Scalar h, ImplicitStepReport<Scalar>& report);
    [[nodiscard]] bool search(Scalar h, bool exact, double decrease, Found& found);
    [[nodiscard]] Found linearise(Scalar h, bool exact);
    template <bool Damped, bool OnBothEnds>
    void add_springs(const std::vector<Block>& blocks, typename Operator::Part& part, Scalar h, bool exact);
    void add_cells(const typename Packed::Domain& domain, typename Operator::Domain& target, bool exact);

    ImplicitBodyOptions<Scalar> m_options;
    Operator m_operator;
    Scalar m_length = 0; ///< what the last direction was multiplied with
};

} // namespace springfit

#include <springfit/body/detail/implicit_body_impl.hpp>
