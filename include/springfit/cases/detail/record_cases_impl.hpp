// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

#include <springfit/cases/record_cases.hpp>

namespace springfit {

namespace detail {

template <int Dim, std::floating_point Scalar>
void validate(const RecordCasesOptions<Dim, Scalar>& options) {
    require(options.training_motions >= 1, "training_motions", "at least one", options.training_motions);
    require(options.held_out_motions >= 1, "held_out_motions", "at least one", options.held_out_motions);
    require(options.frames >= 4, "frames", "at least 4", options.frames);
    require(options.steps_per_frame >= 1, "steps_per_frame", "at least one", options.steps_per_frame);
    const auto is_part = [](const std::optional<Scalar>& value) { return !value || (*value > 0 && *value < 1); };
    require(is_part(options.deformation), "deformation", "a part of the body's size in (0, 1)",
            options.deformation.value_or(0));
    require(!options.damping_ratio || (*options.damping_ratio >= 0 && *options.damping_ratio < 1), "damping_ratio",
            "a part of critical in [0, 1)", options.damping_ratio.value_or(0));
    require(options.stiffness_damping >= 0 && std::isfinite(options.stiffness_damping), "stiffness_damping",
            "a time not below 0", options.stiffness_damping);
    require(options.training_equilibria >= 0, "training_equilibria", "a number not below 0",
            options.training_equilibria);
    require(options.held_out_loads >= 0, "held_out_loads", "a number not below 0", options.held_out_loads);
    require(options.held_out_kinds >= 0, "held_out_kinds", "a number not below 0", options.held_out_kinds);
    require(options.clamp_sets >= 1, "clamp_sets", "at least one", options.clamp_sets);
    require(is_part(options.strain), "strain", "a strain in (0, 1)", options.strain.value_or(0));
    require(options.small_strain > 0 && options.small_strain <= 1, "small_strain", "a part in (0, 1]",
            options.small_strain);
}

/// Records what `record_cases` returns, one part after another.
template <int Dim, std::floating_point Scalar>
class CaseRecording {
public:
    using Cases = std::vector<LoadCase<Dim, Scalar>>;
    using Scenarios = std::vector<Scenario<Dim, Scalar>>;

    CaseRecording(const CaseRecorder<Dim, Scalar>& reference, const Specimen<Dim, Scalar>& specimen,
                  const RecordCasesOptions<Dim, Scalar>& options)
        : m_reference(reference), m_specimen(specimen), m_options(options) {
        Scenario<Dim, Scalar> held;
        held.clamps = specimen.clamps;
        const std::vector<int> nodes = clamped_nodes(held, specimen.n_nodes());
        std::erase_if(m_specimen.surface, [&](int node) { // a hand does not reach where the body is held
            return std::binary_search(nodes.begin(), nodes.end(), node);
        });
    }

    [[nodiscard]] RecordedCases<Dim, Scalar> record() {
        choose_sizes();
        record_motions();
        if (m_reference.finds_equilibria() && m_options.training_equilibria > 0 && !m_result.interrupted) {
            record_equilibria();
        }
        if (!m_result.interrupted) {
            require(!m_result.training.empty() && !m_result.held_out.empty(), "reference",
                    "at least one recorded training and held-out case", "none that converged");
        }
        return std::move(m_result);
    }

private:
    void choose_sizes() {
        const bool is_linear = m_reference.is_linear();
        m_result.strain = m_options.strain.value_or(is_linear ? Scalar(0.001) : Scalar(0.05));
        m_result.deformation = m_options.deformation.value_or(is_linear ? Scalar(0.005) : Scalar(0.05));
        if (is_linear && !m_options.strain) {
            m_result.warnings.push_back(
                {.code = WarningCode::small_strain,
                 .about = "reference",
                 .message = text("the reference is linear, which is true at small strain alone: its loads strain by ",
                                 m_result.strain),
                 .advice = "a material for large strain (neo-Hookean) shows what the springs do there",
                 .values = {{"strain", static_cast<double>(m_result.strain)}}});
        }
    }

    /// The largest factor that a load may have by the strain of its linear response u, which the motion overshoots.
    [[nodiscard]] Scalar factor_of_strain(const Points<Dim, Scalar>& u) const {
        if (m_options.deformation || m_specimen.edges.cols() == 0) {
            return std::numeric_limits<Scalar>::infinity();
        }
        return m_result.strain / overshoot /
               scaled_strain(linear_edge_strain(m_specimen.edges, m_specimen.rest_positions, u));
    }

    [[nodiscard]] std::vector<Points<Dim, Scalar>> responses(const Scenarios& scenarios) const {
        if (m_options.responses) {
            return m_options.responses(scenarios);
        }
        require(m_reference.finds_equilibria(), "responses",
                "linear responses to scale loads by, as those of a network",
                "none, for a reference that moves in time alone");
        return m_reference.linear_responses(scenarios, {.execution = m_options.execution});
    }

    /// Scales the loads of motions; returns the lowest frequency, rad/s.
    [[nodiscard]] Scalar scale_to_deformation(Scenarios& scenarios) const {
        const auto& rest = m_specimen.rest_positions;
        const auto displacements = responses(scenarios);
        require(displacements.size() == scenarios.size(), "responses",
                text(scenarios.size(), " displacements, one per scenario"), displacements.size());
        Scalar slowest = std::numeric_limits<Scalar>::infinity();
        for (std::size_t c = 0; c < scenarios.size(); ++c) {
            const auto& u = displacements[c];
            require(
                u.cols() == rest.cols(), "clamps", "nodes that keep the body from moving as a whole",
                text("a body that still can, with ", clamped_nodes(scenarios[c], rest.cols()).size(), " nodes held"));
            const auto forces = external_forces<Dim, Scalar>(scenarios[c], m_specimen.masses, 0);
            const Scalar work = forces.cwiseProduct(u).sum();
            const Scalar inertia = (u.colwise().squaredNorm() * m_specimen.masses)(0);
            const Scalar factor = m_result.deformation * m_specimen.size() / u.colwise().norm().maxCoeff();
            scale_loads(scenarios[c], std::min(factor, factor_of_strain(u)));
            slowest = std::min(slowest, std::sqrt(work / inertia));
        }
        require(slowest > 0 && std::isfinite(slowest), "responses", "displacements along the loads", slowest);
        return slowest;
    }

    void record_motions() {
        Cases cases = random_load_cases(m_specimen, {.training = m_options.training_motions,
                                                     .clamps = 1,
                                                     .held_out_loads = 1,
                                                     .held_out_kinds = m_options.held_out_motions - 1,
                                                     .held_out_clamp = 0,
                                                     .seed = m_options.seed});
        // Those that judge come first: an early end leaves something to judge by.
        std::stable_partition(cases.begin(), cases.end(),
                              [](const auto& load_case) { return load_case.role != CaseRole::training; });
        Scenarios scenarios;
        for (auto& load_case : cases) {
            scenarios.push_back(load_case.scenario);
        }
        const Scalar slowest = scale_to_deformation(scenarios);
        m_result.period = 2 * std::numbers::pi_v<Scalar> / slowest;
        m_result.stiffness_damping = !m_reference.takes_damping() ? m_reference.stiffness_damping()
                                     : m_options.damping_ratio    ? 2 * *m_options.damping_ratio / slowest
                                                                  : m_options.stiffness_damping;
        const Scalar duration = n_periods * m_result.period;
        RecordOptions<Scalar> how;
        how.frames = m_options.frames;
        how.steps_per_frame = m_options.steps_per_frame;
        how.dt = duration / static_cast<Scalar>(how.frames - 1);
        how.progress = m_options.progress;
        for (std::size_t c = 0; c < cases.size(); ++c) {
            set_amplitude(scenarios[c], ramp_and_release(ramp * duration, Scalar(0.6) * duration));
            cases[c].scenario = std::move(scenarios[c]);
        }
        m_result.add(springfit::record_motions(m_reference, std::move(cases), m_result.stiffness_damping, how,
                                               m_options.execution));
    }

    void record_equilibria() {
        Cases cases = random_load_cases(m_specimen, {.training = m_options.training_equilibria,
                                                     .clamps = m_options.clamp_sets,
                                                     .held_out_loads = m_options.held_out_loads,
                                                     .held_out_kinds = m_options.held_out_kinds,
                                                     .held_out_clamp = 0,
                                                     .seed = m_options.seed + 1000}); // other loads than those in time
        if (m_options.holds) {
            const auto n_left_out = std::erase_if(cases, [&](const auto& load_case) {
                return !m_options.holds(clamped_nodes(load_case.scenario, m_specimen.n_nodes()));
            });
            if (n_left_out > 0) {
                m_result.warnings.push_back(
                    {.code = WarningCode::clamps_left_out,
                     .about = "equilibria",
                     .message =
                         text(n_left_out, " equilibria are left out: their clamps hold the reference, but too few "
                                          "nodes of the network"),
                     .advice = "more nodes of the network may help",
                     .values = {{"left_out", static_cast<double>(n_left_out)}}});
            }
        }
        // Half of the training is at small strain, which is quick to record and to match and tells as much of most
        // springs.
        Cases judging, large, small;
        std::size_t n_training = 0;
        for (auto& load_case : cases) {
            auto& part = load_case.role != CaseRole::training ? judging : n_training++ % 2 == 1 ? small : large;
            part.push_back(std::move(load_case));
        }
        Stage stage(m_options.progress, "record equilibria", 3);
        record_equilibria(std::move(judging), m_result.strain, stage.part(0));
        record_equilibria(std::move(large), m_result.strain, stage.part(1));
        record_equilibria(std::move(small), m_result.strain * m_options.small_strain, stage.part(2));
    }

    void record_equilibria(Cases cases, Scalar strain, const ProgressCallback& progress) {
        if (!cases.empty()) {
            m_result.add(springfit::record_equilibria(m_reference, m_specimen, std::move(cases),
                                                      {.strain = strain,
                                                       .responses = m_options.responses,
                                                       .execution = m_options.execution,
                                                       .progress = progress}));
        }
    }

    static constexpr Scalar n_periods = Scalar(1.25); ///< that a motion lasts, of the slowest response
    static constexpr Scalar ramp = Scalar(0.3);       ///< part of the motion in which loads grow
    /// An oscillator whose load grows over the time t of its period T as in `ramp_and_release`, then stays, swings out
    /// to 1 + 3 (sin a - a cos a) / a^3, a = pi t / T, times its response at rest: Fourier's transform of the load's
    /// growth.
    inline static const Scalar overshoot = [] {
        const Scalar a = std::numbers::pi_v<Scalar> * ramp * n_periods;
        return 1 + 3 * (std::sin(a) - a * std::cos(a)) / (a * a * a);
    }();

    const CaseRecorder<Dim, Scalar>& m_reference;
    Specimen<Dim, Scalar> m_specimen;
    const RecordCasesOptions<Dim, Scalar>& m_options;
    RecordedCases<Dim, Scalar> m_result;
};

} // namespace detail

template <int Dim, std::floating_point Scalar>
RecordedCases<Dim, Scalar> record_cases(const CaseRecorder<Dim, Scalar>& reference,
                                        const Specimen<Dim, Scalar>& specimen,
                                        const std::type_identity_t<RecordCasesOptions<Dim, Scalar>>& options) {
    detail::validate(options);
    validate(specimen);
    return detail::CaseRecording<Dim, Scalar>(reference, specimen, options).record();
}

} // namespace springfit
