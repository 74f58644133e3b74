// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <springfit/cases/case_recorder.hpp>
#include <springfit/cases/case_set.hpp>
#include <springfit/cases/strain.hpp>
#include <springfit/core/stage.hpp>

namespace springfit {

/// How load cases are scaled and brought to rest.
template <int Dim, std::floating_point Scalar>
struct RecordEquilibriaOptions {
    Scalar strain = Scalar(0.05); ///< of the specimen's edges in the linear response (`scale_to_strain`), in (0, 1)
    /// Largest displacement in that response, as a part of the body's size, above 0. It comes first in slender bodies
    /// and in those that swing on a thin clamp: far beyond it a case is about that swing alone.
    Scalar deformation = Scalar(0.25);
    /// Displacements `[Dim x n_nodes]` under small loads; empty: the reference's own `linear_responses`.
    std::function<std::vector<Points<Dim, Scalar>>(const std::vector<Scenario<Dim, Scalar>>&)> responses{};
    Execution execution{};
    ProgressCallback progress{}; ///< called once per case; returning false leaves out the cases not begun yet
};

/// Load cases of one's own choice, their loads scaled to one strain, each with the equilibrium of the reference under
/// it: a stage of `record_cases`.
///
///     auto cases = record_equilibria(reference, specimen, random_load_cases(specimen, {.training = 60}));
///
/// Loads under which the reference finds no equilibrium, or goes more than one and a half times as far as its linear
/// response (it buckles, or topples), are halved, up to six times. Cases are sorted by their roles; those that find no
/// equilibrium even then are left out, with a warning, and there may be none.
/// Throws InvalidArgument for a specimen without edges, for a strain out of range, and where the reference does.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] RecordedCases<Dim, Scalar>
record_equilibria(const CaseRecorder<Dim, Scalar>& reference, const Specimen<Dim, Scalar>& specimen,
                  std::vector<LoadCase<Dim, Scalar>> cases,
                  const std::type_identity_t<RecordEquilibriaOptions<Dim, Scalar>>& options = {});

/// Load cases of one's own choice as they are, each with the reference's motion in time under it: a stage of
/// `record_cases`.
///
/// `stiffness_damping` is beta of D = beta K, s, heeded where damping can be set. A motion that ends early is kept as
/// far as it came, with a warning, if it has three frames. Throws InvalidArgument where the reference does.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] RecordedCases<Dim, Scalar>
record_motions(const CaseRecorder<Dim, Scalar>& reference, std::vector<LoadCase<Dim, Scalar>> cases,
               std::type_identity_t<Scalar> stiffness_damping,
               const std::type_identity_t<RecordOptions<Scalar>>& options, const Execution& execution = {});

} // namespace springfit

#include <springfit/cases/detail/record_load_cases_impl.hpp>
