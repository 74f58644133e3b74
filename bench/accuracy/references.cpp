// SPDX-License-Identifier: BSD-3-Clause
// The finite elements of tetrahedral bodies, compiled once for all parts.
#include <springfit/fem/dynamics.hpp>
#include <springfit/fem/statics.hpp>
#include <springfit/motion/record.hpp>
#include <springfit/score/frequency.hpp>

#include "solid.hpp"

namespace study {

namespace {

/// Calls `visit` with the finite element model.
template <class Visit>
auto with_model(const TetMesh& mesh, const ReferenceKind& reference, const Visit& visit) {
    fem::ModelOptions<double> options;
    options.dilatation = reference.mean_dilatation ? fem::Dilatation::mean : fem::Dilatation::pointwise;
    options.stiffness_damping = reference.stiffness_damping;
    switch (reference.material) {
    case MaterialKind::st_venant_kirchhoff:
        return visit(fem::Model{mesh, fem::StVenantKirchhoff{young, reference.poisson}, density, options});
    case MaterialKind::neo_hookean:
        return visit(fem::Model{mesh, fem::NeoHookean{young, reference.poisson}, density, options});
    default: return visit(fem::Model{mesh, fem::LinearElastic{young, reference.poisson}, density, options});
    }
}

} // namespace

std::string name_of(MaterialKind material) {
    switch (material) {
    case MaterialKind::st_venant_kirchhoff: return std::string(fem::StVenantKirchhoff::name);
    case MaterialKind::neo_hookean: return std::string(fem::NeoHookean::name);
    default: return std::string(fem::LinearElastic::name);
    }
}

CaseSets<3> record_solid(const TetMesh& mesh, const ReferenceKind& reference, const Specimen<3, double>& body,
                         const CaseSettings& cases, const Settings& settings) {
    return with_model(mesh, reference,
                      [&](const auto& model) { return record_sets(model, edges(mesh), body, cases, settings); });
}

Cases<3> record_solid(const TetMesh& mesh, const ReferenceKind& reference,
                      const std::vector<Scenario<3, double>>& scenarios, double strain, const Settings& settings) {
    return with_model(mesh, reference, [&](const auto& model) {
        return record_equilibria(model, edges(mesh), scenarios, strain, settings.execution);
    });
}

Cases<3> record_swings(const TetMesh& mesh, const ReferenceKind& reference,
                       const std::vector<Scenario<3, double>>& scenarios, double frame_time, int frames,
                       const Settings& settings) {
    std::vector<Recording<3, double>> recordings(scenarios.size());
    with_model(mesh, reference, [&](const auto& model) {
        settings.execution.for_chunks(static_cast<Index>(scenarios.size()), 1, [&](Index, Index begin, Index) {
            const auto c = static_cast<std::size_t>(begin);
            recordings[c] =
                record(model, scenarios[c],
                       {.dt = frame_time, .frames = frames, .steps_per_frame = 2, .progress = until_interrupted()});
        });
    });
    stop_if_interrupted();
    Cases<3> result;
    for (std::size_t c = 0; c < scenarios.size(); ++c) {
        if (recordings[c].status == Status::converged) {
            result.add(scenarios[c], std::move(recordings[c].motion));
        } else {
            ++result.left_out;
        }
    }
    return result;
}

double reference_frequency(const TetMesh& mesh, const ReferenceKind& reference, const std::vector<int>& clamped) {
    return with_model(mesh, reference, [&](const auto& model) { return lowest_frequency(model, clamped).omega; });
}

double network_frequency(const SpringNetwork<3, double>& network, const std::vector<int>& clamped) {
    const auto found = lowest_frequency(network, clamped);
    return found.status == Status::failed ? std::numeric_limits<double>::quiet_NaN() : found.omega;
}

} // namespace study
