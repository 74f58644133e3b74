// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <mutex>
#include <numeric>

#include <springfit/score/detail/case_simulator.hpp>

namespace springfit {

/// The error of motions beside their references.
struct MotionError {
    /// sqrt( sum |x - x_ref|^2 / sum |x_ref - x_rest|^2 ) over the free nodes that were seen, frames and cases of the
    /// set: 0 is the reference itself, 1 as bad as not moving at all. A case that cannot be simulated to its end counts
    /// as 1.
    double error = 0;
    Status status = Status::converged; ///< of the first case that failed; without one, `interrupted` where it was
    std::vector<double> case_errors;   ///< the same of each case on its own
    std::vector<Status> case_statuses; ///< how the simulation of each case ended
};

namespace detail {

/// The two sums of the error.
struct SquaredDistances {
    double from_reference = 0;
    double of_reference = 0;

    /// A frame of the reference, beside positions.
    template <int Dim, std::floating_point Scalar>
    void add(const Points<Dim, Scalar>& positions, const Motion<Dim, Scalar>& reference, std::size_t frame,
             const FreeNodes& free) {
        const auto& there = reference.positions[frame];
        for_observed(reference, frame, free.nodes(), [&](int i) {
            from_reference += (positions.col(i) - there.col(i)).template cast<double>().squaredNorm();
            of_reference += (there.col(i) - reference.rest_positions.col(i)).template cast<double>().squaredNorm();
        });
    }

    /// As if the network had not moved.
    template <int Dim, std::floating_point Scalar>
    void set_failed(const Motion<Dim, Scalar>& reference, const FreeNodes& free) {
        *this = {};
        for (std::size_t t = 0; t < reference.positions.size(); ++t) {
            add(reference.rest_positions, reference, t, free);
        }
    }

    [[nodiscard]] double error() const { return from_reference > 0 ? std::sqrt(from_reference / of_reference) : 0.; }
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
/// short counts as 1, `diverged`. Throws InvalidArgument for other numbers of cases or nodes. O(nodes x
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
                sums[c].set_failed(references[c], free);
                break;
            }
            sums[c].add(motions[c].positions[t], references[c], t, free);
        }
    }
    return detail::total_error(sums, std::move(statuses));
}

/// Error of a network on a set of cases: it is simulated under each scenario at the frame times of its reference; a
/// reference of a single frame is a static equilibrium and is compared with the network's own under the clamps of the
/// scenario.
///
/// The sums run over the nodes that are not clamped in the reference. An equilibrium is looked for from the reference's
/// positions, then from the scenario's start, then in load steps. A motion in time is stepped explicitly (symplectic
/// Euler), where it diverges in shorter steps; where the stable step is so short that this would take long, implicitly
/// (implicit Euler of two step lengths, extrapolated). A case that fails in all of these counts as 1, and its status
/// says why. So does a motion that stops half way: a network is not scored on the part that it survives. Interrupted,
/// the error is that of the frames compared so far. Throws InvalidArgument for scenarios, references and network that
/// do not fit together. O(springs x sub-steps), no frame is kept.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] MotionError
motion_error(const SpringNetwork<Dim, Scalar>& network, const std::vector<Scenario<Dim, Scalar>>& scenarios,
             const std::vector<Motion<Dim, Scalar>>& references, const ProgressCallback& progress = {},
             const MotionErrorOptions<Scalar>& options = {}) {
    require(scenarios.size() == references.size(), "scenarios", text(references.size(), ", one per reference"),
            scenarios.size());
    require(options.max_iterations >= 1, "max_iterations", "at least one iteration", options.max_iterations);
    require(options.implicit_steps_per_frame >= 1, "implicit_steps_per_frame", "at least one step",
            options.implicit_steps_per_frame);
    std::vector<FreeNodes> free;
    double n_frames = 0;
    for (std::size_t c = 0; c < references.size(); ++c) {
        free.push_back(detail::free_of(references[c], network.n_nodes()));
        validate(scenarios[c], network.n_nodes());
        detail::check_frame_times(references[c].times);
        n_frames += static_cast<double>(references[c].n_frames());
    }
    const detail::CaseSimulator<Dim, Scalar> simulator(network, scenarios, references, options);
    std::vector<detail::SquaredDistances> sums(references.size());
    std::vector<Status> statuses(references.size(), Status::interrupted);
    std::mutex reporting;
    double n_done = 0;
    std::atomic<bool> stopped = false;
    std::vector<std::size_t> order(references.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    if (options.stop_at_failure) {
        std::stable_partition(order.begin(), order.end(), [&](std::size_t c) { return references[c].n_frames() == 1; });
    }
    std::atomic<Index> first_failed = static_cast<Index>(references.size()); // place in the order, whoever runs it
    const auto add_done = [&](double frames) {
        const std::scoped_lock lock(reporting);
        n_done += frames;
        stopped = stopped || !go_on(progress, "score", n_done / n_frames);
        return !stopped;
    };
    const auto score_case = [&](Index place) {
        const std::size_t c = order[static_cast<std::size_t>(place)];
        const auto& reference = references[c];
        double compared = 0; // frames, in the present try
        const auto compare = [&](std::size_t frame, const Points<Dim, Scalar>& positions) {
            if (frame == 0 && compared > 0) { // another try
                sums[c] = {};
                if (!add_done(-compared)) {
                    return false;
                }
                compared = 0;
            }
            sums[c].add(positions, reference, frame, free[c]);
            compared += 1;
            return add_done(1);
        };
        statuses[c] = simulator.run(c, compare);
        if (statuses[c] != Status::converged && statuses[c] != Status::interrupted) {
            sums[c].set_failed(reference, free[c]);
            (void)add_done(static_cast<double>(reference.n_frames()) - compared);
            Index before = first_failed;
            while (place < before && !first_failed.compare_exchange_weak(before, place)) {
            }
        }
    };
    options.execution.for_chunks(static_cast<Index>(references.size()), 1, [&](Index, Index begin, Index end) {
        for (Index place = begin; place < end && !stopped; ++place) {
            if (!options.stop_at_failure || place < first_failed) {
                score_case(place);
            }
        }
    });
    if (options.stop_at_failure) {
        for (auto place = static_cast<std::size_t>(first_failed) + 1; place < references.size(); ++place) {
            const std::size_t c = order[place];
            sums[c].set_failed(references[c], free[c]);
            statuses[c] = Status::interrupted;
        }
    }
    return detail::total_error(sums, std::move(statuses));
}

} // namespace springfit
