// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/calibrate/candidates.hpp>
#include <springfit/calibrate/choose.hpp>
#include <springfit/calibrate/given.hpp>
#include <springfit/calibrate/period.hpp>
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
    double period = 0;              ///< of the body's slowest motion, as the first closed form has it, s; 0: none
    double damping_ratio = 0;       ///< of the chosen one's slowest motion, by the damping D = beta K, part of critical
    double stable_step = 0;         ///< of the chosen one with the first held-out case's clamps, s
    std::vector<Warning> warnings;  ///< of the recording, of the fits and of the result
    std::vector<std::pair<std::string, double>> seconds; ///< of each stage: "reference", "fit", "score"

    [[nodiscard]] const Candidate<Dim>& best() const { return candidates[choice.candidate]; }
};

/// A body's network with more or fewer parts than another: along the edges alone, with cells that hold their volume,
/// with the second ring.
template <int Dim>
struct NetworkVariant {
    std::string parts;                      ///< what it has, for names: "cells"; empty for the first
    std::vector<NamedNetwork<Dim>> given{}; ///< networks with values to start from
};

/// From variants of a network and a reference's motions to the network that moves most like it. The variants are tried
/// in their order until the best so far is good; of those that are near each other, the one with the fewest parts is
/// returned. All but the last are fitted in few iterations.
template <int Dim>
[[nodiscard]] Calibration<Dim> calibrate(const std::vector<NetworkVariant<Dim>>& variants,
                                         RecordedCases<Dim, double> cases, const CalibrateOptions& options = {});

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
                                         const CalibrateOptions& options = {}) {
    return calibrate(std::vector<NetworkVariant<Dim>>{{"", given}}, std::move(cases), options);
}

/// The same from one network, whose own stiffness is the prior.
template <int Dim>
[[nodiscard]] Calibration<Dim> calibrate(const SpringNetwork<Dim, double>& network, RecordedCases<Dim, double> cases,
                                         const CalibrateOptions& options = {}) {
    return calibrate(std::vector<NamedNetwork<Dim>>{{"given", network}}, std::move(cases), options);
}

/// Which springs and cells a body gets.
enum class Parts {
    automatic, ///< springs along edges; where they end worse than good, with cells, then with the second ring, too
    given      ///< those that are asked for
};

/// A body of one material, its springs and how its finite element reference is recorded.
template <int Dim>
struct BodyOptions {
    double density = 0;   ///< rho, kg/m^3, > 0
    double thickness = 1; ///< h, m, > 0, of plane bodies
    std::vector<int>
        clamped{}; ///< nodes of the mesh's corners that are held; empty: clamp sets are found (`clamp_sets`)
    Parts parts = Parts::automatic; ///< `given` where `second_ring` or `volume` is
    bool second_ring = false;       ///< springs between opposite vertices of neighbouring simplices, too
    bool volume = false;            ///< cells that hold their volume, too; for nearly incompressible materials
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

/// The variants that `body.parts` says, each with the values of the closed forms.
template <int Dim, CellType Cell>
[[nodiscard]] std::vector<NetworkVariant<Dim>> network_variants(const Mesh<Dim, double, Cell>& mesh,
                                                                const IsotropicSolid& solid, BodyOptions<Dim> body) {
    std::vector<NetworkVariant<Dim>> variants;
    const auto add = [&](const char* parts) {
        variants.push_back({parts, closed_form_networks(mesh, springs_of(mesh, body), solid)});
    };
    add("");
    if (body.parts == Parts::automatic && !body.volume && !body.second_ring && !is_membrane<Dim, double, Cell>) {
        body.volume = true;
        add("cells");
        if constexpr (SimplexCell<Cell>) {
            body.second_ring = true;
            add("cells, second ring");
        }
    }
    return variants;
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
    const auto variants = network_variants(
        corners, {.young = material.young, .poisson = material.poisson, .thickness = body.thickness}, body);
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
        record.stiffness_damping = light_damping(variants.front().given.front().network);
    }
    fem::ModelOptions<double> model;
    model.thickness = body.thickness;
    model.dilatation = body.dilatation.value_or(reference_dilatation<Cell>);
    const auto reference = fem_recorder(mesh, material, body.density, model);
    auto cases = record_cases<Dim, double>(reference, specimen, record);
    const double recording = stopwatch.seconds();
    auto result = calibrate(variants, std::move(cases), body.how);
    result.seconds.insert(result.seconds.begin(), {"reference", recording});
    return result;
}

} // namespace springfit

#include <springfit/calibrate/detail/calibrate_impl.hpp>
