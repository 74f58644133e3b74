// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cases/case_set.hpp>
#include <springfit/cases/clamp_sets.hpp>
#include <springfit/motion/transfer.hpp>

namespace springfit {

/// A reference's nodes beside those of a coarser network, and how values pass between the two.
template <int Dim>
struct FineNodes {
    Points<Dim, double> rest_positions; ///< of the reference `[Dim x n_fine]`, m
    Interpolation<double> at_network;   ///< nodes of the reference to nodes of the network
    Interpolation<double> at_fine;      ///< nodes of the network to nodes of the reference

    /// A node of the network is held where held nodes make up this part of what it is read from: whatever the meshes,
    /// the network is then held where the reference is.
    static constexpr double clamped_share = 0.5;

    /// The nodes of the network that are held where these of the reference are.
    [[nodiscard]] std::vector<int> clamped_at_network(const std::vector<int>& clamped) const {
        return targets_of(at_network, clamped, clamped_share);
    }
};

/// Cases that were recorded at the nodes of a finer reference, at the nodes of the network: its motions are transferred
/// and replayed, equilibria from rest. Throws InvalidArgument where `transfer` does. O(frames x weights).
template <int Dim>
[[nodiscard]] CaseSet<Dim, double> at_network(const CaseSet<Dim, double>& fine, const FineNodes<Dim>& nodes,
                                              const Points<Dim, double>& network_rest_positions) {
    CaseSet<Dim, double> coarse;
    for (std::size_t c = 0; c < fine.size(); ++c) {
        auto motion = transfer(fine.motions[c], nodes.at_network, nodes.at_fine, network_rest_positions,
                               FineNodes<Dim>::clamped_share);
        LoadCase<Dim, double> load_case = fine.cases[c];
        load_case.scenario = replay(motion);
        if (motion.n_frames() ==
            1) { // looked for from rest first, as those of a reference on the network's own mesh are
            load_case.scenario.initial_positions.resize(Dim, 0);
        }
        coarse.add(std::move(load_case), std::move(motion));
    }
    return coarse;
}

} // namespace springfit
