// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/motion/surface.hpp>

#include "cases.hpp"

namespace program {

/// The body on the reference's finer mesh, as the network on the coarser one sees it.
template <int Dim>
class CoarseFromFine {
public:
    /// Hands the masses of the fine mesh to the network, total kept. Throws InvalidArgument where a node of the network
    /// gets none, and where `--clamp` holds too few of its nodes.
    CoarseFromFine(const FineMesh& fine, const FitOptions& options, Discretisation<Dim>& network);

    [[nodiscard]] const springfit::Specimen<Dim, double>& body() const { return m_body; }

    /// The boundary of the fine mesh, carried by the network.
    [[nodiscard]] const springfit::CarriedSurface<Dim, double>& surface() const { return m_surface; }

    /// True where clamping these nodes of the fine mesh leaves the network no rigid motion.
    [[nodiscard]] bool holds_network(const std::vector<int>& clamped) const;

    /// Load cases that were recorded on the fine mesh, carried to the nodes of the network; the fine motions of the
    /// held-out ones are kept.
    [[nodiscard]] ReferenceCases<Dim> carried_to_network(ReferenceCases<Dim> recorded);

    /// The report's part on how far the fine nodes that the network carries are from where the reference had them in
    /// the held-out cases: under the network's own motion, and were its nodes to move as the reference does.
    [[nodiscard]] springfit::io::Json errors_at_fine_nodes(const springfit::SpringNetwork<Dim, double>& network,
                                                           const CaseSet<Dim>& held_out,
                                                           const springfit::Execution& execution) const;

    /// What the reference did in the first held-out case, at the points of the surface.
    [[nodiscard]] springfit::Motion<Dim, double> shown_at_surface() const;

private:
    const FineMesh& m_fine;
    springfit::Points<Dim, double> m_network_positions; ///< at rest
    springfit::Specimen<Dim, double> m_body;
    springfit::CarriedSurface<Dim, double> m_surface;
    std::vector<int> m_surface_nodes;                       ///< of the fine mesh
    std::vector<springfit::Motion<Dim, double>> m_held_out; ///< of the fine mesh
};

} // namespace program
