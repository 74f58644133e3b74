// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/calibrate/candidate.hpp>
#include <springfit/closed_form/all.hpp>
#include <springfit/closed_form/cauchy_split.hpp>
#include <springfit/simulate/stable_step.hpp>

namespace springfit {

/// A network with the values of every closed form that holds for its mesh, the most common one first; with cells that
/// hold their volume, those of `cauchy_split` last. Networks to start from and to compare with.
///
/// Throws InvalidArgument where `closed_forms` does, and where no form holds.
template <int Dim, CellType Cell>
[[nodiscard]] std::vector<NamedNetwork<Dim>> closed_form_networks(const Mesh<Dim, double, Cell>& mesh,
                                                                  const SpringNetwork<Dim, double>& network,
                                                                  const IsotropicSolid& solid) {
    std::vector<NamedNetwork<Dim>> networks;
    for (const auto& [name, form] : closed_forms(mesh, network.springs, solid)) {
        networks.push_back({name, network, form.n_clamped, form.caveat});
        apply(form, networks.back().network);
    }
    require(!networks.empty(), "mesh", "cells for whose springs some closed form holds", Cell::name);
    if constexpr (SimplexCell<Cell> && Cell::dimension == Dim) {
        if (network.n_cells() > 0) {
            const auto split = cauchy_split(mesh, network.springs, solid);
            networks.push_back({"cauchy_split", network, 0, split.springs.caveat});
            apply(split, networks.back().network);
        }
    }
    return networks;
}

/// beta, s, of a damping that takes a quarter of a network's explicit step: with zeta = beta omega / 2 at the highest
/// frequency omega = 2 / h, the step shrinks by sqrt(1 + zeta^2) - zeta, which is 0.744 at zeta = 0.3. Our definition
/// of damping that is light. The network is taken without its own damping.
template <int Dim>
[[nodiscard]] double light_damping(SpringNetwork<Dim, double> network) {
    network.damping.setZero();
    return 0.3 * stable_step(network);
}

} // namespace springfit
