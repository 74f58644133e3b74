// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <springfit/cases/record_load_cases.hpp>

namespace springfit {

/// The load cases to record: how many, how large and how long. The defaults are those that `calibrate` learns from.
template <int Dim, std::floating_point Scalar>
struct RecordCasesOptions {
    using Scenarios = std::vector<Scenario<Dim, Scalar>>;

    // Motions in time, under the specimen's own clamps: loaded in a ramp, then released.
    int training_motions = 6; ///< >= 1
    int held_out_motions = 3; ///< >= 1: a load of a trained kind, then kinds that training never shows
    int frames = 32;          ///< of each, >= 4
    int steps_per_frame = 2;  ///< of the reference, >= 1: at one its own step is .04 of a motion, at two .01
    /// Largest displacement aimed at, as a part of the body's size, in (0, 1); none: 0.05 (of a linear reference
    /// 0.005), or less where `strain` is reached before.
    std::optional<Scalar> deformation{};
    std::optional<Scalar> damping_ratio{}; ///< of the slowest motion, in [0, 1); heeded where damping can be set
    Scalar stiffness_damping = 0;          ///< else beta of D = beta K, s, >= 0

    // Equilibria, under several clamp sets, where the reference finds any.
    int training_equilibria = 36; ///< >= 0; with 0 there are none to judge by either
    int held_out_loads = 6;       ///< of kinds and clamps that training has, >= 0
    int held_out_kinds = 5;       ///< of kinds that training never shows, >= 0
    int clamp_sets = 3;           ///< the specimen's own first, >= 1
    /// Strain of those that judge and of every second to learn from, in (0, 1); none: 0.05, and 0.001 of a linear
    /// reference, which is true at small strain alone.
    std::optional<Scalar> strain{};
    Scalar small_strain = Scalar(0.02); ///< of the others, as a part of that: quick to record and to match; in (0, 1]

    unsigned seed = 1; ///< fixes every load case

    /// Displacements `[Dim x n_nodes]` under small loads, by which loads and times are scaled; empty: the reference's
    /// own `linear_responses`. One that finds no equilibria takes those of a network with the values of a closed form.
    std::function<std::vector<Points<Dim, Scalar>>(const Scenarios&)> responses{};
    /// False for clamped nodes whose equilibria are left out; empty: none are.
    std::function<bool(const std::vector<int>&)> holds{};

    Execution execution{};
    ProgressCallback progress{}; ///< returning false ends the running stage with the cases that are done
};

/// Load cases of a specimen, recorded: motions in time and equilibria, to learn from and to judge by.
///
/// Loads are scaled by the linear response to them: those of equilibria to one strain of the specimen's edges, those of
/// motions to one largest displacement, or to the same strain, overshoot and all, where it comes first, as in thin or
/// slender parts.
/// (`record_motions` and `record_equilibria` do it for cases of your own.) Motions last 1.25 periods of the slowest
/// response u to a load f, omega^2 = f . u / (u . M u) (Rayleigh's quotient); the ramp takes 0.3 of that time, the
/// release comes at 0.6 of it. Cases that the reference does not come through are left out, with a warning.
///
/// Throws InvalidArgument for an option out of range, for a specimen of other nodes than the reference, for clamps that
/// do not hold the body ("clamps"), and where no case to learn from or none to judge by came about ("reference"). Where
/// the callback asked to stop, `interrupted` is set and the cases are those that were done, even none.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] RecordedCases<Dim, Scalar>
record_cases(const CaseRecorder<Dim, Scalar>& reference, const Specimen<Dim, Scalar>& specimen,
             const std::type_identity_t<RecordCasesOptions<Dim, Scalar>>& options = {});

/// The same for any model of the concept Reference, which is asked for several cases at the same time.
template <Reference R>
[[nodiscard]] auto record_cases(
    const R& reference,
    const Specimen<ReferenceRecorder<R>::dimension, typename ReferenceRecorder<R>::Scalar>& specimen,
    const RecordCasesOptions<ReferenceRecorder<R>::dimension, typename ReferenceRecorder<R>::Scalar>& options = {}) {
    const ReferenceRecorder<R> recorder(reference);
    const CaseRecorder<ReferenceRecorder<R>::dimension, typename ReferenceRecorder<R>::Scalar>& base = recorder;
    return record_cases(base, specimen, options);
}

} // namespace springfit

#include <springfit/cases/detail/record_cases_impl.hpp>
