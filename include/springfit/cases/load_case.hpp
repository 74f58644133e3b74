// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <springfit/cases/load_kinds.hpp>

namespace springfit {

/// The purpose of a load case: to be learnt from, or to judge what was learnt in one of three ways.
enum class CaseRole {
    training,
    unseen_load, ///< kinds and clamps that training has, other loads
    unseen_kind, ///< kinds that training never shows
    unseen_clamp ///< clamps that training never shows
};

[[nodiscard]] constexpr std::string_view to_string(CaseRole role) {
    switch (role) {
    case CaseRole::training: return "training";
    case CaseRole::unseen_load: return "unseen load";
    case CaseRole::unseen_kind: return "unseen kind";
    case CaseRole::unseen_clamp: return "unseen clamp";
    }
    return "unknown";
}

/// A scenario with what it is.
template <int Dim, std::floating_point Scalar>
struct LoadCase {
    Scenario<Dim, Scalar> scenario;
    std::optional<LoadKind> kind{}; ///< none: of a recorded motion
    int clamp_set = 0;              ///< number of the clamp set, the body's own is 0
    CaseRole role = CaseRole::training;
    Scalar strain = 0; ///< that the linear response to the loads was scaled to; 0: not scaled by strain
};

/// The scenarios of the load cases that have a role, in their order.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] std::vector<Scenario<Dim, Scalar>> scenarios_with(const std::vector<LoadCase<Dim, Scalar>>& cases,
                                                                CaseRole role) {
    std::vector<Scenario<Dim, Scalar>> scenarios;
    for (const auto& load_case : cases) {
        if (load_case.role == role) {
            scenarios.push_back(load_case.scenario);
        }
    }
    return scenarios;
}

} // namespace springfit
