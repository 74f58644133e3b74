// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <springfit/motion/record_static.hpp>

#include "body.hpp"

namespace program {

/// The small static answer of a body to a load, by which loads and times are scaled.
struct LinearResponse {
    double largest_displacement = 0; ///< m
    double frequency = 0; ///< angular, of the slowest motion that the load excites, rad/s (Rayleigh's quotient)
};

/// The FEM reference behind the program, whatever its cells and material; it speaks of the mesh's vertices alone.
template <int Dim>
class FemReference {
public:
    using Scenario = springfit::Scenario<Dim, double>;

    virtual ~FemReference() = default;

    /// The answers to loads that share their clamps, by linear elasticity on the mesh's own cells. Poisson's ratio is
    /// taken as 0.3 at most, which keeps plain cells from locking and changes the answer little.
    [[nodiscard]] virtual std::vector<LinearResponse> respond(const std::vector<Scenario>& scenarios) const = 0;

    /// Records the motion under a scenario with material damping D = beta K, s.
    [[nodiscard]] virtual springfit::Recording<Dim, double>
    record(const Scenario& scenario, double beta, const springfit::RecordOptions<double>& options) const = 0;

    /// Scales the loads to the wanted strain of the edges and records the equilibrium under each; a case that finds
    /// none comes back without frames.
    [[nodiscard]] virtual std::vector<springfit::Recording<Dim, double>>
    record_statics(std::vector<Scenario>& scenarios, double strain,
                   const springfit::StaticRecordOptions<double>& options) const = 0;

    [[nodiscard]] virtual std::string element() const = 0;
};

/// The FEM model of a mesh for the element and material asked for. Throws InvalidArgument where they do not fit the
/// mesh.
template <int Dim>
[[nodiscard]] std::unique_ptr<FemReference<Dim>> make_fem_reference(const AnyMesh& mesh, const FitOptions& options);

} // namespace program
