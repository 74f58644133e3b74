// SPDX-License-Identifier: BSD-3-Clause
// The finite elements of tetrahedral bodies, compiled once for all parts.
#include <springfit/score/frequency.hpp>

#include "solid.hpp"

namespace study {

namespace {

fem::ModelOptions<double> model_options(const ReferenceKind& reference) {
    fem::ModelOptions<double> options;
    options.dilatation = reference.mean_dilatation ? fem::Dilatation::mean : fem::Dilatation::pointwise;
    return options;
}

/// Calls `visit` with the material.
template <class Visit>
auto with_material(const ReferenceKind& reference, const Visit& visit) {
    switch (reference.material) {
    case MaterialKind::st_venant_kirchhoff: return visit(fem::StVenantKirchhoff{young, reference.poisson});
    case MaterialKind::neo_hookean: return visit(fem::NeoHookean{young, reference.poisson});
    default: return visit(fem::LinearElastic{young, reference.poisson});
    }
}

} // namespace

std::string name_of(MaterialKind material) {
    return with_material({.material = material}, [](const auto& own) { return std::string(own.name); });
}

FemRecorder<3, double> recorder_of(const TetMesh& mesh, const ReferenceKind& reference) {
    return with_material(reference, [&](const auto& material) {
        return fem_recorder(mesh, material, density, model_options(reference));
    });
}

RecordedCases<3, double> record_swings(const CaseRecorder<3, double>& reference,
                                       const std::vector<LoadCase<3, double>>& cases, double stiffness_damping,
                                       double frame_time, int frames, const Settings& settings) {
    auto recorded =
        record_motions(reference, cases, stiffness_damping,
                       {.dt = frame_time, .frames = frames, .steps_per_frame = 2, .progress = until_interrupted()},
                       settings.execution);
    stop_if_interrupted();
    return recorded;
}

double reference_frequency(const TetMesh& mesh, const ReferenceKind& reference, const std::vector<int>& clamped) {
    return with_material(reference, [&](const auto& material) {
        return lowest_frequency(fem::Model{mesh, material, density, model_options(reference)}, clamped).omega;
    });
}

double network_frequency(const SpringNetwork<3, double>& network, const std::vector<int>& clamped) {
    const auto found = lowest_frequency(network, clamped);
    return found.status == Status::failed ? std::numeric_limits<double>::quiet_NaN() : found.omega;
}

} // namespace study
