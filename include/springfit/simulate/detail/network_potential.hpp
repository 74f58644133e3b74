// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/simulate/detail/network_bounds.hpp>
#include <springfit/solve/newton.hpp>

namespace springfit::detail {

/// The potential energy that an equilibrium minimises over the coordinates of the free nodes, E(x) - f . (x - start).
///
/// Its Hessian is the exact one, which converges quadratically, where the gradient has become small. Far from the
/// minimum, compressed springs make it indefinite and a Newton step along it poor: there it is the semidefinite one, at
/// once or, from `start_exact()` on, as soon as the solver meets negative curvature.
///
/// `Network` is a `SpringNetwork` or a `BiquadraticNetwork`.
template <class Network>
class NetworkPotential {
public:
    static constexpr int dimension = Network::dimension;
    using Scalar = typename Network::Scalar;

    NetworkPotential(const Network& network, const FreeNodes& free) : m_matrix(network_matrix(network, free)) {}

    [[nodiscard]] const FreeNodes& free_nodes() const { return m_matrix.free_nodes(); }
    [[nodiscard]] const BlockMatrix<dimension, Scalar>& matrix() const { return m_matrix; }

    /// Clamped nodes stand as in `positions`, now and in what follows; `external` is held by pointer until the next.
    ///
    /// `floor`, relative to the largest entry of the Hessian's diagonal, is added to the diagonal: it keeps the matrix
    /// regular where nothing holds a node, as across a flat membrane, and moves no minimum.
    void set_statics(const Network& network, const Points<dimension, Scalar>& positions,
                     const Points<dimension, Scalar>& external, Scalar floor = 0) {
        m_network = &network;
        m_external = &external;
        m_points = positions;
        m_start = positions;
        m_floor = floor;
    }

    /// The Hessian is exact where no entry of the gradient exceeds this, N.
    void set_exact_below(Scalar gradient) { m_exact_below = gradient; }

    /// The Hessian is exact until `use_semidefinite()`.
    void start_exact() { m_is_semidefinite = false; }

    /// Takes the semidefinite Hessian far from the minimum; false where it is in use already or the minimum is near.
    [[nodiscard]] bool use_semidefinite();

    /// A node farther than this from where `set_statics` found it is lost, m.
    void set_reach(Scalar reach) { m_reach = reach; }

    /// Nothing holds the network: a node has gone out of reach.
    [[nodiscard]] bool is_lost(const Values<Scalar>& x) {
        return !((positions(x) - m_start).cwiseAbs().maxCoeff() <= m_reach);
    }

    /// Positions of all nodes for the free coordinates x, m.
    [[nodiscard]] const Points<dimension, Scalar>& positions(const Values<Scalar>& x) {
        free_nodes().template scatter<dimension, Scalar>(x, m_points);
        return m_points;
    }

    [[nodiscard]] Scalar energy(const Values<Scalar>& x);

    void gradient(const Values<Scalar>& x, Values<Scalar>& gradient);

    /// At the point whose gradient was asked for last.
    [[nodiscard]] const SparseMatrix<Scalar>& hessian(const Values<Scalar>& x);

    /// The rounding of the energy at the coordinates last used, J: its terms may cancel.
    [[nodiscard]] Scalar energy_rounding() const;

    /// The gradient that rounding of the coordinates alone makes, N.
    [[nodiscard]] Scalar gradient_rounding(const Points<dimension, Scalar>& positions) const;

private:
    BlockMatrix<dimension, Scalar> m_matrix;
    const Network* m_network = nullptr;
    const Points<dimension, Scalar>* m_external = nullptr;
    Scalar m_floor = 0;
    Scalar m_exact_below = 0;
    Scalar m_reach = std::numeric_limits<Scalar>::infinity();
    bool m_is_near = false;
    bool m_is_semidefinite = true;      ///< far from the minimum
    Points<dimension, Scalar> m_points; ///< all nodes; the free ones at the x last asked for
    Points<dimension, Scalar> m_start;
    Points<dimension, Scalar> m_forces;
};

} // namespace springfit::detail

#include <springfit/simulate/detail/network_potential_impl.hpp>
