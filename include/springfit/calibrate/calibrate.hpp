// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/calibrate/candidates.hpp>
#include <springfit/calibrate/choose.hpp>
#include <springfit/calibrate/given.hpp>
#include <springfit/calibrate/score.hpp>
#include <springfit/cases/fem_recorder.hpp>
#include <springfit/cases/record_cases.hpp>
#include <springfit/network/builders.hpp>

namespace springfit {

/// The result of a calibration.
template <int Dim>
struct Calibration {
    RecordedCases<Dim, double> cases;       ///< what it was made and judged by
    std::vector<Candidate<Dim>> candidates; ///< all that were made, scored, the given networks first
    Choice choice;                          ///< which of them, and by which rule
    Verdict verdict = Verdict::unfinished;
    Status status = Status::failed; ///< how the fit of the chosen one ended; `interrupted` where anything was cut short
    std::vector<PartError> parts;   ///< held-out errors of the chosen one by kind of case
    double stable_step = 0;         ///< of the chosen one with the first held-out case's clamps, s
    std::vector<Warning> warnings;  ///< of the recording, of the fits and of the result
    std::vector<std::pair<std::string, double>> seconds; ///< of each stage: "reference", "fit", "score"

    [[nodiscard]] const Candidate<Dim>& best() const { return candidates[choice.candidate]; }
};

/// From networks with values to start from and a reference's motions to the network that moves most like it.
///
///     auto result = calibrate(network, split_motions<3, double>({recorded}));
///     write(result.best().network);
///
/// Makes candidates (`make_candidates`), scores them on cases that no fit has seen (`score`), and chooses (`choose`);
/// each stage can be called alone. Throws InvalidArgument where a stage does. A numerical failure is not thrown: the
/// candidates that came about are judged, and `verdict` and `warnings` say what they are worth.
template <int Dim>
[[nodiscard]] Calibration<Dim> calibrate(const std::vector<NamedNetwork<Dim>>& given, RecordedCases<Dim, double> cases,
                                         const CalibrateOptions& options = {});

/// The same from one network, whose own stiffness is the prior.
template <int Dim>
[[nodiscard]] Calibration<Dim> calibrate(const SpringNetwork<Dim, double>& network, RecordedCases<Dim, double> cases,
                                         const CalibrateOptions& options = {}) {
    return calibrate(std::vector<NamedNetwork<Dim>>{{"given", network}}, std::move(cases), options);
}

/// A body of one material, its springs and how its finite element reference is recorded.
template <int Dim>
struct BodyOptions {
    double density = 0;   ///< rho, kg/m^3, > 0
    double thickness = 1; ///< h, m, > 0, of plane bodies
    std::vector<int>
        clamped{};            ///< nodes of the mesh's corners that are held; empty: clamp sets are found (`clamp_sets`)
    bool second_ring = false; ///< springs between opposite vertices of neighbouring simplices, too
    bool volume = false;      ///< simplices that hold their volume, too; for nearly incompressible materials
    std::optional<fem::Dilatation> dilatation{}; ///< of the reference; default: `reference_dilatation`
    RecordCasesOptions<Dim, double> record{};    ///< its execution and progress are those of `how`
    CalibrateOptions how{};
};

/// The springs of a mesh as `BodyOptions` has them, without stiffness: along its edges, and the diagonals of
/// quadrilaterals and hexahedra.
template <int Dim, CellType Cell>
[[nodiscard]] SpringNetwork<Dim, double> springs_of(const Mesh<Dim, double, Cell>& mesh, const BodyOptions<Dim>& body) {
    return springs_along_edges(mesh, {.diagonals = !SimplexCell<Cell>,
                                      .second_ring = body.second_ring,
                                      .volume = body.volume,
                                      .density = body.density,
                                      .thickness = body.thickness});
}

/// From a mesh and its material to the network that moves most like its finite element model.
///
///     auto result = calibrate(mesh, fem::NeoHookean{.young = 5e4, .poisson = 0.45}, {.density = 1000, .volume =
///     true});
///
/// The closed forms are the networks to start from; load cases are recorded with `record_cases`, with a damping so
/// light that it takes a quarter of the explicit step unless `body.record` says another. Throws InvalidArgument for
/// what cannot be used.
template <int Dim, CellType Cell, fem::Material Mat>
    requires(Cell::dimension == Dim)
[[nodiscard]] Calibration<Dim> calibrate(const Mesh<Dim, double, Cell>& mesh, const Mat& material,
                                         const BodyOptions<Dim>& body) {
    const Stopwatch stopwatch;
    const auto corners = corner_mesh(mesh);
    const auto given =
        closed_form_networks(corners, springs_of(corners, body),
                             {.young = material.young, .poisson = material.poisson, .thickness = body.thickness});
    auto specimen = specimen_of(corners, body.density, body.thickness);
    if (!body.clamped.empty()) {
        specimen.clamps = {{body.clamped, {}}};
    }
    auto record = body.record;
    if (!matches_motion(body.how.method)) {
        record.training_equilibria = 0; // nothing would learn from them
    }
    record.execution = body.how.execution;
    record.progress = body.how.progress;
    if (!record.damping_ratio && record.stiffness_damping == 0) {
        record.stiffness_damping = light_damping(given.front().network);
    }
    fem::ModelOptions<double> model;
    model.thickness = body.thickness;
    model.dilatation = body.dilatation.value_or(reference_dilatation<Cell>);
    const auto reference = fem_recorder(mesh, material, body.density, model);
    auto cases = record_cases<Dim, double>(reference, specimen, record);
    const double recording = stopwatch.seconds();
    auto result = calibrate(given, std::move(cases), body.how);
    result.seconds.insert(result.seconds.begin(), {"reference", recording});
    return result;
}

} // namespace springfit

#include <springfit/calibrate/detail/calibrate_impl.hpp>
