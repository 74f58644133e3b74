// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <map>
#include <mutex>
#include <type_traits>

#include <springfit/core/execution.hpp>
#include <springfit/motion/record.hpp>

namespace springfit {

/// Finds where a body comes to rest under one load case after another; what it learns of one it may use for the next.
///
/// `solve_equilibrium` ends with the equilibrium under the loads and clamps at a time, `linear_response` with the
/// displacement that small loads would make, K u = f_ext at the rest positions; both return `converged` or say why they
/// could not.
template <class S>
concept StaticSolver = requires(S solver, const Scenario<S::dimension, typename S::Scalar>& scenario,
                                typename S::Scalar time, Points<S::dimension, typename S::Scalar>& nodes) {
    { solver.rest_positions() } -> std::convertible_to<Points<S::dimension, typename S::Scalar>>;
    { solver.masses() } -> std::convertible_to<Values<typename S::Scalar>>;
    { solver.solve_equilibrium(scenario, time, nodes) } -> std::same_as<Status>;
    { solver.linear_response(scenario, time, nodes) } -> std::same_as<Status>;
};

/// A model whose equilibria can be recorded: `make_static_solver(model)` gives what finds them.
///
/// Models of the concept: `fem::Model` and `SpringNetwork` (`simulate/static_solver.hpp`).
template <class R>
concept StaticReference = requires(const R& reference) {
    { make_static_solver(reference) } -> StaticSolver;
};

template <std::floating_point Scalar>
struct StaticRecordOptions {
    Scalar time = 0;             ///< when loads and clamps are read, s
    Execution execution{};       ///< for many cases: they are shared out in groups that have their clamps in common
    ProgressCallback progress{}; ///< called once per case; returning false leaves out the cases not begun yet
};

namespace detail {

/// Cases that one static solver takes in turn. More would leave threads idle, fewer waste what a solver learns.
inline constexpr std::size_t cases_per_solver = 8;

/// Groups of at most `cases_per_solver` scenarios with the same clamped nodes, in the order of their first ones.
template <int Dim, std::floating_point Scalar>
std::vector<std::vector<std::size_t>> groups_by_clamps(const std::vector<Scenario<Dim, Scalar>>& scenarios,
                                                       Index n_nodes) {
    std::vector<std::vector<std::size_t>> groups;
    std::map<std::vector<int>, std::size_t> open; // clamped nodes to the group that still has room
    for (std::size_t c = 0; c < scenarios.size(); ++c) {
        validate(scenarios[c], n_nodes);
        const auto place = open.try_emplace(clamped_nodes(scenarios[c], n_nodes), groups.size()).first;
        if (place->second == groups.size() || groups[place->second].size() == cases_per_solver) {
            place->second = groups.size();
            groups.emplace_back();
        }
        groups[place->second].push_back(c);
    }
    return groups;
}

/// Calls `visit(solver, c)` for each scenario c, one solver for each group; stops where `progress` returns false.
template <StaticReference R, class Visit>
void for_static_cases(const R& reference, const std::vector<Scenario<R::dimension, typename R::Scalar>>& scenarios,
                      const StaticRecordOptions<typename R::Scalar>& options, std::string_view stage,
                      const Visit& visit) {
    require(std::isfinite(options.time), "time", "a finite time", options.time);
    const auto groups = groups_by_clamps(scenarios, make_static_solver(reference).rest_positions().cols());
    std::mutex reporting;
    std::size_t n_done = 0;
    std::atomic<bool> stopped = false;
    options.execution.for_chunks(static_cast<Index>(groups.size()), 1, [&](Index, Index begin, Index) {
        if (stopped) {
            return;
        }
        auto solver = make_static_solver(reference);
        for (std::size_t c : groups[static_cast<std::size_t>(begin)]) {
            if (stopped) {
                return;
            }
            visit(solver, c);
            const std::scoped_lock lock(reporting);
            const double fraction = static_cast<double>(++n_done) / static_cast<double>(scenarios.size());
            stopped = stopped || !go_on(options.progress, stage, fraction);
        }
    });
}

} // namespace detail

/// The equilibria of a reference under many load cases, each as a motion of one frame at rest at `options.time`.
///
/// Load cases may have different clamps; those that share them share a solver. A case that finds no equilibrium, or is
/// not reached before an interruption, has no frame, and its status says why: `diverged` where the reference found
/// positions, or the loads are forces, that are not finite. The results do not depend on the execution. Throws
/// InvalidArgument for a scenario that does not fit the body, and for positions or masses of another number of nodes.
template <StaticReference R>
[[nodiscard]] std::vector<Recording<R::dimension, typename R::Scalar>>
record_statics(const R& reference, const std::vector<Scenario<R::dimension, typename R::Scalar>>& scenarios,
               const StaticRecordOptions<std::type_identity_t<typename R::Scalar>>& options = {}) {
    constexpr int dim = R::dimension;
    using Scalar = typename R::Scalar;
    std::vector<Recording<dim, Scalar>> recordings(scenarios.size());
    for (auto& recording : recordings) {
        recording.status = Status::interrupted;
    }
    detail::for_static_cases(reference, scenarios, options, "record", [&](auto& solver, std::size_t c) {
        auto& [motion, status] = recordings[c];
        motion.name = scenarios[c].name;
        motion.rest_positions = solver.rest_positions();
        motion.clamped = clamped_nodes(scenarios[c], motion.n_nodes());
        Points<dim, Scalar> positions;
        Points<dim, Scalar> external;
        status = solver.solve_equilibrium(scenarios[c], options.time, positions);
        if (status == Status::converged) {
            detail::check_nodes<dim, Scalar>(positions, "positions", motion.n_nodes());
            detail::check_masses<Scalar>(solver.masses(), motion.n_nodes());
            external = external_forces<dim, Scalar>(scenarios[c], solver.masses(), options.time);
            status = positions.allFinite() && external.allFinite() ? status : Status::diverged;
        }
        if (status == Status::converged) {
            motion.times = {options.time};
            motion.velocities = {Points<dim, Scalar>::Zero(dim, motion.n_nodes())};
            motion.accelerations = motion.velocities;
            motion.positions = {std::move(positions)};
            motion.external_forces = {std::move(external)};
        }
    });
    return recordings;
}

/// The equilibrium of a reference under one load case, as a motion of one frame at rest; see `record_statics`.
template <StaticReference R>
[[nodiscard]] Recording<R::dimension, typename R::Scalar>
record_static(const R& reference, const Scenario<R::dimension, typename R::Scalar>& scenario,
              std::type_identity_t<typename R::Scalar> time = 0) {
    return record_statics(reference, {scenario}, {.time = time}).front();
}

/// The response to small loads, K u = f_ext with K at the rest positions: the displacement of each case `[Dim x
/// n_nodes]`, m; empty where the clamps do not hold the body, where it is not finite, and where an interruption came
/// first. Throws as `record_statics` does.
template <StaticReference R>
[[nodiscard]] std::vector<Points<R::dimension, typename R::Scalar>>
linear_responses(const R& reference, const std::vector<Scenario<R::dimension, typename R::Scalar>>& scenarios,
                 const StaticRecordOptions<std::type_identity_t<typename R::Scalar>>& options = {}) {
    std::vector<Points<R::dimension, typename R::Scalar>> responses(scenarios.size());
    detail::for_static_cases(reference, scenarios, options, "linear responses", [&](auto& solver, std::size_t c) {
        if (solver.linear_response(scenarios[c], options.time, responses[c]) != Status::converged) {
            responses[c].resize(R::dimension, 0);
            return;
        }
        detail::check_nodes<R::dimension, typename R::Scalar>(responses[c], "a displacement",
                                                              solver.rest_positions().cols());
        if (!responses[c].allFinite()) {
            responses[c].resize(R::dimension, 0);
        }
    });
    return responses;
}

} // namespace springfit
