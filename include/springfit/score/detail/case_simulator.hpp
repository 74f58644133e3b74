// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>
#include <map>
#include <memory>

#include <springfit/cases/load_cases.hpp>
#include <springfit/score/motion_error_options.hpp>
#include <springfit/simulate/equilibrium.hpp>
#include <springfit/simulate/implicit_euler.hpp>
#include <springfit/simulate/simulate.hpp>

namespace springfit::detail {

/// The stiffness that static cases with the same clamps share: each once, and the number of each case's.
template <int Dim, std::floating_point Scalar>
struct StiffnessByClamps {
    std::vector<std::unique_ptr<ClampedStiffness<SpringNetwork<Dim, Scalar>>>> held;
    std::vector<std::size_t> of_case; ///< of no meaning for a case that is not static

    StiffnessByClamps(const SpringNetwork<Dim, Scalar>& network, const std::vector<Scenario<Dim, Scalar>>& scenarios,
                      const std::vector<Motion<Dim, Scalar>>& references, const Execution& execution)
        : of_case(scenarios.size(), 0) {
        std::map<std::vector<int>, std::size_t> numbers;
        std::vector<std::vector<int>> clamps;
        for (std::size_t c = 0; c < scenarios.size(); ++c) {
            if (references[c].n_frames() == 1) {
                const auto [place, is_new] =
                    numbers.try_emplace(clamped_nodes(scenarios[c], network.n_nodes()), numbers.size());
                if (is_new) {
                    clamps.push_back(place->first);
                }
                of_case[c] = place->second;
            }
        }
        held.resize(clamps.size());
        execution.for_chunks(static_cast<Index>(clamps.size()), 1, [&](Index, Index begin, Index) {
            const auto h = static_cast<std::size_t>(begin);
            held[h] = std::make_unique<ClampedStiffness<SpringNetwork<Dim, Scalar>>>(network, clamps[h]);
        });
    }
};

/// Simulates a network under load cases as their references were recorded, whatever it takes.
template <int Dim, std::floating_point Scalar>
class CaseSimulator {
public:
    using Scenarios = std::vector<Scenario<Dim, Scalar>>;
    using Motions = std::vector<Motion<Dim, Scalar>>;

    /// Keeps references to all of them.
    CaseSimulator(const SpringNetwork<Dim, Scalar>& network, const Scenarios& scenarios, const Motions& references,
                  const MotionErrorOptions<Scalar>& options)
        : m_network(network), m_scenarios(scenarios), m_references(references), m_options(options),
          m_most_substeps(most_substeps(network, options)),
          m_explicit(network, {.step_fraction = options.step_fraction, .max_substeps = m_most_substeps}),
          m_stiffness(network, scenarios, references, options.execution) {}

    /// Calls `visit(frame, positions)` for each frame of a case, again from the first where another way is tried; stops
    /// where it returns false, `interrupted`. Else the status says how the last way ended.
    template <class Visit>
    Status run(std::size_t c, const Visit& visit) const {
        return m_references[c].n_frames() == 1 ? rest(c, visit) : move(c, visit);
    }

private:
    /// Of one frame: cells that are pressed flat ask for ever shorter steps.
    static int most_substeps(const SpringNetwork<Dim, Scalar>& network, const MotionErrorOptions<Scalar>& options) {
        const double most =
            options.most_explicit_work / static_cast<double>(network.n_springs() + network.n_cells() + 1);
        return static_cast<int>(std::clamp(most, 1., 1e9));
    }

    template <class Visit>
    Status rest(std::size_t c, const Visit& visit) const {
        EquilibriumOptions<Dim, Scalar> how;
        how.time = m_references[c].times.front();
        how.max_iterations = m_options.max_iterations;
        how.start = m_references[c].positions.front();
        const auto& springs = *m_stiffness.held[m_stiffness.of_case[c]];
        auto found = equilibrium(springs, m_scenarios[c], how, false);
        if (found.status != Status::converged && !m_options.stop_at_failure) {
            how.start.resize(Dim, 0);
            found = equilibrium(springs, m_scenarios[c], how, false);
        }
        if (found.status != Status::converged && !m_options.stop_at_failure) {
            found = rest_by_steps(c, how);
        }
        if (found.status == Status::converged && !visit(0, found.positions)) {
            return Status::interrupted;
        }
        return found.status;
    }

    /// Follows the equilibrium while the loads grow.
    [[nodiscard]] Equilibrium<Dim, Scalar> rest_by_steps(std::size_t c, EquilibriumOptions<Dim, Scalar> how) const {
        constexpr int n_steps = 4;
        Equilibrium<Dim, Scalar> found;
        for (int step = 1; step <= n_steps; ++step) {
            auto part = m_scenarios[c];
            scale_loads(part, Scalar(step) / Scalar(n_steps));
            found = equilibrium(*m_stiffness.held[m_stiffness.of_case[c]], part, how, false);
            if (found.status != Status::converged) {
                break;
            }
            how.start = found.positions;
        }
        return found;
    }

    template <class Visit>
    Status move(std::size_t c, const Visit& visit) const {
        const auto& times = m_references[c].times;
        double substeps = 0;
        Scalar before = 0;
        for (const Scalar time : times) {
            substeps += time > before ? m_explicit.n_substeps(time - before) : 0;
            before = time;
        }
        const bool is_short =
            substeps * static_cast<double>(m_network.n_springs() + m_network.n_cells()) <= m_options.most_explicit_work;
        if (!is_short) {
            return move_implicitly(c, visit);
        }
        Status status = Status::failed;
        for (const Scalar fraction : {m_options.step_fraction, m_options.step_fraction / 4}) {
            SymplecticEuler<Dim, Scalar> stepper(m_network,
                                                 {.step_fraction = fraction, .max_substeps = m_most_substeps});
            status = for_frames<Dim, Scalar>(
                stepper, m_scenarios[c], times, std::numeric_limits<int>::max(),
                [&](std::size_t frame, const State<Dim, Scalar>& state) { return visit(frame, state.positions); });
            if (status == Status::converged || status == Status::interrupted || m_options.stop_at_failure) {
                break;
            }
        }
        return status;
    }

    /// The error of implicit Euler is about h times something: x(h / 2) + (x(h / 2) - x(h)) is of second order.
    template <class Visit>
    Status move_implicitly(std::size_t c, const Visit& visit) const {
        const auto& times = m_references[c].times;
        ImplicitEuler<Dim, Scalar> stepper(m_network);
        State<Dim, Scalar> coarse = stepper.start(m_scenarios[c]);
        State<Dim, Scalar> fine = coarse;
        const auto advance = [&](State<Dim, Scalar>& state, Scalar to, int steps) {
            const Scalar h = (to - state.time) / static_cast<Scalar>(steps);
            for (int step = 0; step < steps; ++step) {
                if (const Status status = stepper.advance(state, m_scenarios[c], h); status != Status::converged) {
                    return status;
                }
            }
            state.time = to;
            return Status::converged;
        };
        for (std::size_t t = 0; t < times.size(); ++t) {
            if (times[t] > coarse.time) {
                Status status = advance(coarse, times[t], m_options.implicit_steps_per_frame);
                if (status == Status::converged) {
                    status = advance(fine, times[t], 2 * m_options.implicit_steps_per_frame);
                }
                if (status != Status::converged) {
                    return status;
                }
            }
            if (!visit(t, Points<Dim, Scalar>(2 * fine.positions - coarse.positions))) {
                return Status::interrupted;
            }
        }
        return Status::converged;
    }

    const SpringNetwork<Dim, Scalar>& m_network;
    const Scenarios& m_scenarios;
    const Motions& m_references;
    MotionErrorOptions<Scalar> m_options;
    int m_most_substeps;
    SymplecticEuler<Dim, Scalar> m_explicit; ///< tells how many steps it takes
    StiffnessByClamps<Dim, Scalar> m_stiffness;
};

} // namespace springfit::detail
