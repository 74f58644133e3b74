// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>

#include <springfit/core/execution.hpp>
#include <springfit/simulate/equilibrium.hpp>
#include <springfit/simulate/simulate.hpp>

namespace springfit {

/// The error of motions beside their references.
struct MotionError {
    /// sqrt( sum |x - x_ref|^2 / sum |x_ref - x_rest|^2 ) over the free nodes, frames and cases of the set: 0 is the
    /// reference itself, 1 as bad as not moving at all; infinite where a case could not be simulated to its end.
    double error = 0;
    Status status = Status::converged; ///< of the first case that failed; without one, `interrupted` where it was
    std::vector<double> case_errors;   ///< the same of each case on its own
    std::vector<Status> case_statuses; ///< how the simulation of each case ended
};

template <std::floating_point Scalar>
struct MotionErrorOptions {
    SymplecticEulerOptions<Scalar> step{};
    int max_iterations = 500; ///< Newton iterations of a static case, >= 1
    /// Leave out what is not done once a case fails: the error is infinite either way. Those cases are `interrupted`,
    /// the status of the whole is that of the case that failed.
    bool stop_at_failure = false;
    Execution execution{}; ///< cases are independent of each other
};

namespace detail {

/// The two sums of the error.
struct SquaredDistances {
    double from_reference = 0;
    double of_reference = 0;

    template <int Dim, std::floating_point Scalar>
    void add(const Points<Dim, Scalar>& positions, const Points<Dim, Scalar>& reference,
             const Points<Dim, Scalar>& rest_positions, const FreeNodes& free) {
        for (int i : free.nodes()) {
            from_reference += (positions.col(i) - reference.col(i)).template cast<double>().squaredNorm();
            of_reference += (reference.col(i) - rest_positions.col(i)).template cast<double>().squaredNorm();
        }
    }

    [[nodiscard]] double error() const {
        if (!std::isfinite(from_reference)) {
            return std::numeric_limits<double>::infinity();
        }
        return from_reference > 0 ? std::sqrt(from_reference / of_reference) : 0.;
    }
};

/// Free nodes of a reference, which must be of this size.
template <int Dim, std::floating_point Scalar>
FreeNodes free_of(const Motion<Dim, Scalar>& reference, Index n_nodes) {
    require(reference.n_nodes() == n_nodes, "reference", text(n_nodes, " nodes, as the network"), reference.n_nodes());
    require(reference.n_frames() > 0, "reference", "at least one frame", text("none in '", reference.name, "'"));
    require(static_cast<Index>(reference.positions.size()) == reference.n_frames(), "reference",
            text(reference.n_frames(), " frames of positions"), reference.positions.size());
    return FreeNodes(n_nodes, reference.clamped);
}

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

inline MotionError total_error(const std::vector<SquaredDistances>& sums, std::vector<Status>&& statuses) {
    MotionError result;
    result.case_statuses = std::move(statuses);
    SquaredDistances total;
    for (std::size_t c = 0; c < sums.size(); ++c) {
        total.from_reference += sums[c].from_reference;
        total.of_reference += sums[c].of_reference;
        result.case_errors.push_back(sums[c].error());
        if (result.status == Status::converged || result.status == Status::interrupted) {
            const Status status = result.case_statuses[c];
            result.status = status == Status::converged ? result.status : status;
        }
    }
    result.error = total.error();
    return result;
}

} // namespace detail

/// Error of motions against references of the same frames, `motions[c]` against `references[c]`. A motion that is cut
/// short makes the error infinite, `diverged`. Throws InvalidArgument for other numbers of cases or nodes. O(nodes x
/// frames).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] MotionError motion_error(const std::vector<Motion<Dim, Scalar>>& motions,
                                       const std::vector<Motion<Dim, Scalar>>& references) {
    require(motions.size() == references.size(), "motions", text(references.size(), ", one per reference"),
            motions.size());
    std::vector<detail::SquaredDistances> sums(references.size());
    std::vector<Status> statuses(references.size(), Status::converged);
    for (std::size_t c = 0; c < references.size(); ++c) {
        const FreeNodes free = detail::free_of(references[c], motions[c].n_nodes());
        for (std::size_t t = 0; t < references[c].positions.size(); ++t) {
            if (t >= motions[c].positions.size()) {
                statuses[c] = Status::diverged;
                sums[c].from_reference = std::numeric_limits<double>::infinity();
                break;
            }
            sums[c].template add<Dim, Scalar>(motions[c].positions[t], references[c].positions[t],
                                              references[c].rest_positions, free);
        }
    }
    return detail::total_error(sums, std::move(statuses));
}

/// Error of a network on a set of cases: it is simulated under each scenario at the frame times of its reference
/// (`simulate`); a reference of a single frame is a static equilibrium and is compared with the network's own under the
/// clamps of the scenario, found from the reference's positions or, where that fails, from the scenario's start.
///
/// The sums run over the nodes that are not clamped in the reference. A case that diverges, takes too many sub-steps or
/// finds no equilibrium makes the error infinite, and the status says why: a network is not scored on the part of a
/// motion that it survives. Interrupted, the error is that of the frames compared so far. Throws InvalidArgument for
/// scenarios, references and network that do not fit together. O(springs x sub-steps), no frame is kept.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] MotionError
motion_error(const SpringNetwork<Dim, Scalar>& network, const std::vector<Scenario<Dim, Scalar>>& scenarios,
             const std::vector<Motion<Dim, Scalar>>& references, const ProgressCallback& progress = {},
             const MotionErrorOptions<Scalar>& options = {}) {
    require(scenarios.size() == references.size(), "scenarios", text(references.size(), ", one per reference"),
            scenarios.size());
    require(options.max_iterations >= 1, "max_iterations", "at least one iteration", options.max_iterations);
    std::vector<FreeNodes> free;
    double n_frames = 0;
    for (std::size_t c = 0; c < references.size(); ++c) {
        free.push_back(detail::free_of(references[c], network.n_nodes()));
        validate(scenarios[c], network.n_nodes());
        detail::check_frame_times(references[c].times);
        n_frames += static_cast<double>(references[c].n_frames());
    }
    const SymplecticEuler<Dim, Scalar> prototype(network, options.step);
    const detail::StiffnessByClamps<Dim, Scalar> statics_of(network, scenarios, references, options.execution);
    std::vector<detail::SquaredDistances> sums(references.size());
    std::vector<Status> statuses(references.size(), Status::interrupted);
    std::mutex reporting;
    double n_done = 0;
    std::atomic<bool> stopped = false;
    const auto frame_done = [&] {
        const std::scoped_lock lock(reporting);
        n_done += 1;
        stopped = stopped || !go_on(progress, "score", n_done / n_frames);
        return !stopped;
    };
    const auto score_case = [&](std::size_t c) {
        const auto& reference = references[c];
        const auto compare = [&](std::size_t frame, const Points<Dim, Scalar>& positions) {
            sums[c].template add<Dim, Scalar>(positions, reference.positions[frame], reference.rest_positions, free[c]);
            return frame_done();
        };
        if (reference.n_frames() == 1) {
            EquilibriumOptions<Dim, Scalar> statics;
            statics.time = reference.times.front();
            statics.max_iterations = options.max_iterations;
            statics.start = reference.positions.front();
            const auto& springs = *statics_of.held[statics_of.of_case[c]];
            auto rest = detail::equilibrium(springs, scenarios[c], statics, false);
            if (rest.status != Status::converged) {
                statics.start.resize(Dim, 0);
                rest = detail::equilibrium(springs, scenarios[c], statics, false);
            }
            statuses[c] = rest.status;
            if (rest.status == Status::converged && !compare(0, rest.positions)) {
                statuses[c] = Status::interrupted;
            }
        } else {
            auto stepper = prototype;
            statuses[c] = detail::for_frames<Dim, Scalar>(
                stepper, scenarios[c], reference.times, options.step.max_substeps,
                [&](std::size_t frame, const State<Dim, Scalar>& state) { return compare(frame, state.positions); });
        }
        if (statuses[c] != Status::converged && statuses[c] != Status::interrupted) {
            sums[c].from_reference = std::numeric_limits<double>::infinity();
            stopped = stopped || options.stop_at_failure;
        }
    };
    options.execution.for_chunks(static_cast<Index>(references.size()), 1, [&](Index, Index begin, Index end) {
        for (Index c = begin; c < end && !stopped; ++c) {
            score_case(static_cast<std::size_t>(c));
        }
    });
    return detail::total_error(sums, std::move(statuses));
}

} // namespace springfit
