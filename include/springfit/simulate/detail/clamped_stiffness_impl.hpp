// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/simulate/detail/clamped_stiffness.hpp>

namespace springfit::detail {

template <class Network>
ClampedStiffness<Network>::ClampedStiffness(const Network& network, const std::vector<int>& clamped)
    : m_network(network), m_potential(network, FreeNodes(network.n_nodes(), clamped)) {
    const Points<dimension, Scalar> unloaded = Points<dimension, Scalar>::Zero(dimension, network.n_nodes());
    auto at_rest = m_potential;
    at_rest.set_statics(network, network.rest_positions, unloaded, Scalar(statics_floor));
    const Values<Scalar> x = free_nodes().template gather<dimension, Scalar>(network.rest_positions);
    for (const auto curvature : {HessianForm::exact, HessianForm::positive_semidefinite}) {
        at_rest.set_exact_below(curvature == HessianForm::exact ? std::numeric_limits<Scalar>::infinity() : Scalar(-1));
        Values<Scalar> gradient(x.size());
        at_rest.gradient(x, gradient);
        m_factor = CorotatedPreconditioner<dimension, Scalar>(at_rest.hessian(x), free_nodes(), neighbours(network),
                                                              network.rest_positions);
        if (m_factor.is_usable()) {
            return;
        }
    }
}

} // namespace springfit::detail
