// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/simulate/projective_euler.hpp>

namespace springfit {

template <int Dim, std::floating_point Scalar>
Status ProjectiveEuler<Dim, Scalar>::advance(State<Dim, Scalar>& state, const Scenario<Dim, Scalar>& scenario,
                                             Scalar dt) {
    require(dt > 0 && std::isfinite(dt), "dt", "a positive time step", dt);
    const Status status =
        detail::advance_body<Dim, Scalar>(m_network, m_body, state, scenario, dt, [](Status s) { return usable(s); });
    return usable(status) ? Status::converged : status;
}

} // namespace springfit
