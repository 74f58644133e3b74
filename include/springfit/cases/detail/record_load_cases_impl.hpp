// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cases/record_load_cases.hpp>

namespace springfit {

namespace detail {

/// A body whose largest displacement is beyond so many times that of its linear response has buckled or toppled.
inline constexpr double buckled = 1.5;
/// How often the loads of such a case are halved at most.
inline constexpr int most_halvings = 6;

/// Halves the loads of cases in which the reference buckles, or finds no equilibrium, and records them again, until
/// they do not: beyond, a case is about that fall alone, and its strain is far above what was asked for. A case that
/// buckles to the last is `failed`.
/// `scenarios` are scaled by `factors`, per unit of which `responses` are.
template <int Dim, std::floating_point Scalar>
void record_unbuckled(const CaseRecorder<Dim, Scalar>& reference, const std::vector<Points<Dim, Scalar>>& responses,
                      std::vector<Scalar>& factors, std::vector<Scenario<Dim, Scalar>>& scenarios,
                      std::vector<Recording<Dim, Scalar>>& recordings, StaticRecordOptions<Scalar> how) {
    how.progress = [ask = how.progress](const Progress& progress) { return go_on(ask, progress.stage, 1); };
    const auto has_buckled = [&](std::size_t c) {
        const auto& [motion, status] = recordings[c];
        if (factors[c] == 0 || status == Status::interrupted) {
            return false;
        }
        const Scalar expected = factors[c] * responses[c].colwise().norm().maxCoeff();
        return status != Status::converged ||
               (motion.positions[0] - motion.rest_positions).colwise().norm().maxCoeff() > Scalar(buckled) * expected;
    };
    for (int halving = 0; halving < most_halvings; ++halving) {
        std::vector<std::size_t> again;
        std::vector<Scenario<Dim, Scalar>> halved;
        for (std::size_t c = 0; c < scenarios.size(); ++c) {
            if (has_buckled(c)) {
                scale_loads(scenarios[c], Scalar(0.5));
                factors[c] /= 2;
                again.push_back(c);
                halved.push_back(scenarios[c]);
            }
        }
        if (again.empty()) {
            return;
        }
        auto recorded = reference.record_statics(halved, how);
        for (std::size_t a = 0; a < again.size(); ++a) {
            recordings[again[a]] = std::move(recorded[a]);
        }
    }
    for (std::size_t c = 0; c < scenarios.size(); ++c) {
        recordings[c].status = has_buckled(c) ? Status::failed : recordings[c].status;
    }
}

} // namespace detail

template <int Dim, std::floating_point Scalar>
RecordedCases<Dim, Scalar>
record_equilibria(const CaseRecorder<Dim, Scalar>& reference, const Specimen<Dim, Scalar>& specimen,
                  std::vector<LoadCase<Dim, Scalar>> cases,
                  const std::type_identity_t<RecordEquilibriaOptions<Dim, Scalar>>& options) {
    require(specimen.edges.cols() > 0, "specimen", "edges, whose strain loads are scaled by", "none");
    std::vector<Scenario<Dim, Scalar>> scenarios;
    for (const auto& load_case : cases) {
        scenarios.push_back(load_case.scenario);
    }
    const StaticRecordOptions<Scalar> how{.execution = options.execution, .progress = options.progress};
    std::vector<Points<Dim, Scalar>> responses;
    const auto respond = [&](const auto& all) {
        responses = options.responses ? options.responses(all)
                                      : reference.linear_responses(all, {.execution = options.execution});
        return responses;
    };
    auto factors = scale_to_strain<Dim, Scalar>(scenarios, specimen.edges, specimen.rest_positions, options.strain,
                                                respond, options.deformation * specimen.size());
    auto recordings = reference.record_statics(scenarios, how);
    if (!options.responses) { // those of another model say nothing of how this one bends
        detail::record_unbuckled(reference, responses, factors, scenarios, recordings, how);
    }
    RecordedCases<Dim, Scalar> recorded;
    for (std::size_t c = 0; c < cases.size(); ++c) {
        auto& [motion, status] = recordings[c];
        if (status == Status::converged) {
            motion.name = "static " + scenarios[c].name;
            cases[c].scenario = std::move(scenarios[c]);
            if (factors[c] > 0) {
                cases[c].strain =
                    factors[c] *
                    detail::scaled_strain(linear_edge_strain(specimen.edges, specimen.rest_positions, responses[c]));
            }
            recorded.add(std::move(cases[c]), std::move(motion));
        } else if (status == Status::interrupted) {
            recorded.interrupted = true;
        } else {
            recorded.warnings.push_back(
                {.code = WarningCode::no_equilibrium,
                 .about = scenarios[c].name,
                 .message = text("static load case ", scenarios[c].name,
                                 ": the reference found no equilibrium, or buckled, however small the load"),
                 .advice = "a smaller strain may help",
                 .values = {{"strain", static_cast<double>(options.strain)}}});
        }
    }
    return recorded;
}

template <int Dim, std::floating_point Scalar>
RecordedCases<Dim, Scalar>
record_motions(const CaseRecorder<Dim, Scalar>& reference, std::vector<LoadCase<Dim, Scalar>> cases,
               std::type_identity_t<Scalar> stiffness_damping,
               const std::type_identity_t<RecordOptions<Scalar>>& options, const Execution& execution) {
    Stage stage(options.progress, "record motions", cases.size());
    std::vector<Recording<Dim, Scalar>> recordings(cases.size());
    for (auto& recording : recordings) {
        recording.status = Status::interrupted;
    }
    RecordedCases<Dim, Scalar> recorded;
    recorded.stiffness_damping = reference.takes_damping() ? stiffness_damping : reference.stiffness_damping();
    execution.for_chunks(static_cast<Index>(cases.size()), 1, [&](Index, Index begin, Index) {
        const auto c = static_cast<std::size_t>(begin);
        auto mine = options;
        mine.progress = stage.part(c);
        if (!stage.stopped()) {
            recordings[c] = reference.record(cases[c].scenario, stiffness_damping, mine);
        }
    });
    for (std::size_t c = 0; c < cases.size(); ++c) {
        auto& [motion, status] = recordings[c];
        const std::string& name = cases[c].scenario.name;
        if (status == Status::interrupted) {
            recorded.interrupted = true;
            continue;
        }
        if (status != Status::converged) {
            recorded.warnings.push_back(
                {.code = WarningCode::reference_ended_early,
                 .about = name,
                 .message = text("load case ", name, ": the reference ended as ", to_string(status), " after ",
                                 motion.n_frames(), " of ", options.frames, " frames"),
                 .advice = "a smaller deformation may help",
                 .values = {{"frames", static_cast<double>(motion.n_frames())},
                            {"frames_wanted", static_cast<double>(options.frames)}}});
        }
        if (motion.n_frames() >= 3) {
            recorded.add(std::move(cases[c]), std::move(motion));
        }
    }
    return recorded;
}

} // namespace springfit
