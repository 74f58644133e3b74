// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cases/clamp_sets.hpp>
#include <springfit/cases/load_case.hpp>

namespace springfit {

/// Amplitude that rises smoothly from 0 to 1 over `ramp`, holds, and from `release` on falls as smoothly over half of
/// `ramp`: afterwards the body swings freely.
template <std::floating_point Scalar>
[[nodiscard]] Amplitude<Scalar> ramp_and_release(Scalar ramp, Scalar release) {
    require(ramp > 0, "ramp", "a positive time", ramp);
    require(release >= ramp, "release", text("a time not before the end of the ramp, ", ramp), release);
    return [ramp, release](Scalar time) {
        const auto step = [](Scalar s) {
            s = std::clamp(s, Scalar(0), Scalar(1));
            return s * s * (3 - 2 * s);
        };
        return step(time / ramp) - step(2 * (time - release) / ramp);
    };
}

/// Multiplies all forces and accelerations of a scenario.
template <int Dim, std::floating_point Scalar>
void scale_loads(Scenario<Dim, Scalar>& scenario, std::type_identity_t<Scalar> factor) {
    for (auto& load : scenario.loads) {
        load.forces *= factor;
    }
    for (auto& gravity : scenario.gravity) {
        gravity.acceleration *= factor;
    }
}

/// Gives all forces and accelerations of a scenario one amplitude over time.
template <int Dim, std::floating_point Scalar>
void set_amplitude(Scenario<Dim, Scalar>& scenario, const Amplitude<Scalar>& amplitude) {
    for (auto& load : scenario.loads) {
        load.amplitude = amplitude;
    }
    for (auto& gravity : scenario.gravity) {
        gravity.amplitude = amplitude;
    }
}

struct LoadCaseOptions {
    int training = 18;      ///< cases under all clamps together, >= 1
    int clamps = 3;         ///< clamp sets to train under, the body's own first, >= 1
    int held_out_loads = 6; ///< >= 0
    int held_out_kinds = 5; ///< >= 0; the first five, one of each kind, are under the body's own clamps
    int held_out_clamp = 6; ///< >= 0; with 0, no other clamp set than the training's is looked for
    unsigned seed = 1;      ///< fixes every case
    /// Fixes the held-out cases alone, which are then the same however many are trained on; none: `seed` fixes them.
    std::optional<unsigned> held_out_seed{};
};

/// Random load cases, to learn from and to judge by in three ways (`CaseRole`); none is scaled yet and all are constant
/// in time (`scale_to_strain`, `set_amplitude`). Every scenario carries its own clamps. Kinds and clamps take turns
/// such that every kind comes under every clamp. Throws InvalidArgument where `random_load` and `clamp_sets` do.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] std::vector<LoadCase<Dim, Scalar>> random_load_cases(const Specimen<Dim, Scalar>& body,
                                                                   const LoadCaseOptions& options = {}) {
    require(options.training >= 1, "training", "at least one load case", options.training);
    require(options.clamps >= 1, "clamps", "at least one clamp set", options.clamps);
    require(options.held_out_loads >= 0, "held_out_loads", "a number not below 0", options.held_out_loads);
    require(options.held_out_kinds >= 0, "held_out_kinds", "a number not below 0", options.held_out_kinds);
    require(options.held_out_clamp >= 0, "held_out_clamp", "a number not below 0", options.held_out_clamp);
    int clamps = std::min(options.clamps, options.training);

    // The body's own clamps, which may move, then nodes at rest; the last is held out.
    std::vector<Specimen<Dim, Scalar>> clamped{body};
    if (clamps > 1 || options.held_out_clamp > 0 || body.clamps.empty()) {
        ClampSets sets = clamp_sets(body, {.training = clamps, .held_out = options.held_out_clamp > 0});
        clamps = static_cast<int>(sets.training.size()); // fewer for a body in pieces
        if (options.held_out_clamp > 0) {
            sets.training.push_back(sets.held_out);
        }
        if (body.clamps.empty()) {
            clamped[0].clamps = {{sets.training[0], {}}};
        }
        for (std::size_t s = 1; s < sets.training.size(); ++s) {
            clamped.push_back(body);
            clamped.back().clamps = {{sets.training[s], {}}};
        }
    }

    unsigned seed_of_cases = options.seed;
    unsigned case_number = 0;
    std::vector<LoadCase<Dim, Scalar>> cases;
    const auto add = [&](CaseRole role, LoadKind kind, int clamp) {
        // Different seeds give different cases; the factor is odd, so no two cases of one seed are alike.
        const unsigned seed = 2654435761u * seed_of_cases + 40503u * ++case_number;
        cases.push_back({.scenario = random_load(kind, clamped[static_cast<std::size_t>(clamp)], seed),
                         .kind = kind,
                         .clamp_set = clamp,
                         .role = role});
        cases.back().scenario.name = text(to_string(kind), " ", case_number, ", clamp ", clamp + 1);
    };
    const auto kind_of = [](const auto& kinds, int c) { return kinds[static_cast<std::size_t>(c) % kinds.size()]; };
    constexpr int n_held_out = static_cast<int>(held_out_kinds.size());
    for (int c = 0; c < options.training; ++c) {
        add(CaseRole::training, kind_of(training_kinds, c / clamps), c % clamps);
    }
    if (options.held_out_seed) {
        seed_of_cases = *options.held_out_seed;
        case_number = static_cast<unsigned>(clamps); // as after one training case under each clamp
    }
    for (int c = 0; c < options.held_out_loads; ++c) {
        add(CaseRole::unseen_load, kind_of(training_kinds, c / clamps), c % clamps);
    }
    for (int c = 0; c < options.held_out_kinds; ++c) {
        add(CaseRole::unseen_kind, kind_of(held_out_kinds, c), c / n_held_out % clamps);
    }
    for (int c = 0; c < options.held_out_clamp; ++c) {
        add(CaseRole::unseen_clamp, kind_of(training_kinds, c), clamps);
    }
    return cases;
}

} // namespace springfit
