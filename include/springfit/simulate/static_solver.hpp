// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <springfit/simulate/equilibrium.hpp>

namespace springfit {

/// Static equilibria of a network under one load case after another. A model of the concept StaticSolver.
template <int Dim, std::floating_point ScalarType>
class NetworkStatics {
public:
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    /// Keeps a copy of the network.
    explicit NetworkStatics(SpringNetwork<Dim, Scalar> network) : m_network(std::move(network)) { validate(m_network); }
    NetworkStatics(const NetworkStatics&) = delete; // m_springs refers to m_network
    NetworkStatics& operator=(const NetworkStatics&) = delete;

    [[nodiscard]] const Points<Dim, Scalar>& rest_positions() const { return m_network.rest_positions; }
    [[nodiscard]] const Values<Scalar>& masses() const { return m_network.mass; }

    /// The positions `[Dim x n_nodes]` that `equilibrium` ends with, whether it is stable or not.
    /// The factor and all else that depends on the clamps alone is kept while the same nodes are clamped.
    Status solve_equilibrium(const Scenario<Dim, Scalar>& scenario, Scalar time, Points<Dim, Scalar>& positions);

    /// K u = f with K at the rest positions and f the loads and the springs' own forces there: displacement
    /// `[Dim x n_nodes]`, m. The factorisation is kept while the same nodes are clamped. A flat network in space
    /// answers loads in its plane. Status `failed` where the springs do not resist the loads.
    Status linear_response(const Scenario<Dim, Scalar>& scenario, Scalar time, Points<Dim, Scalar>& displacement);

private:
    void use_clamps(const Scenario<Dim, Scalar>& scenario);

    void prepare_linear();

    SpringNetwork<Dim, Scalar> m_network;
    std::vector<int> m_clamped;
    std::optional<detail::ClampedStiffness<SpringNetwork<Dim, Scalar>>> m_springs; ///< of m_network, for `balance`
    bool m_is_linear_ready = false; ///< the rest is of the present clamps
    FreeNodes m_free;
    BlockMatrix<Dim, Scalar> m_full;  ///< stiffness of all nodes at rest
    BlockMatrix<Dim, Scalar> m_held;  ///< of the free ones
    SymmetricSolver<Scalar> m_solver; ///< holds its factor where it is positive definite
    bool m_is_held = false;
};

/// `SpringNetwork` is a model of the concept StaticReference (`motion/record_static.hpp`).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] NetworkStatics<Dim, Scalar> make_static_solver(const SpringNetwork<Dim, Scalar>& network) {
    return NetworkStatics<Dim, Scalar>(network);
}

} // namespace springfit

#include <springfit/simulate/detail/static_solver_impl.hpp>
