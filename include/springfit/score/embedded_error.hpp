// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cases/coarse_cases.hpp>
#include <springfit/core/stage.hpp>
#include <springfit/motion/surface.hpp>
#include <springfit/score/motion_error.hpp>

namespace springfit {

/// The distance of the fine nodes that a network carries from where the reference had them.
struct EmbeddedError {
    MotionError by_network;   ///< under the network's own motion
    MotionError by_reference; ///< were the network's nodes to move as the reference does: what carrying alone costs
};

namespace detail {

/// Positions of the network in the frames of a case: as far as it comes in time, at rest for a single frame.
template <int Dim>
std::vector<Points<Dim, double>>
positions_under(const SpringNetwork<Dim, double>& network, const Scenario<Dim, double>& scenario,
                const Motion<Dim, double>& reference, const ProgressCallback& progress) {
    if (reference.n_frames() > 1) {
        return simulate(network, scenario, reference.times, progress).motion.positions;
    }
    EquilibriumOptions<Dim, double> how;
    how.time = reference.times.front();
    how.max_iterations = 100;
    auto rest = equilibrium(network, scenario, how);
    if (rest.status != Status::converged) {
        how.start = reference.positions.front();
        rest = equilibrium(network, scenario, how);
    }
    (void)go_on(progress, "equilibrium", 1);
    return rest.status == Status::converged ? std::vector{rest.positions} : std::vector<Points<Dim, double>>{};
}

} // namespace detail

/// Errors at the nodes of a finer reference in cases: `coarse` has them at the network's nodes (`at_network`), `fine`
/// as they were recorded. All fine nodes count, those that are held in the reference as well. The error is infinite
/// where the callback ended the work. Throws InvalidArgument for sets that do not fit together.
template <int Dim>
[[nodiscard]] EmbeddedError embedded_error(const SpringNetwork<Dim, double>& network,
                                           const CaseSet<Dim, double>& coarse, const CaseSet<Dim, double>& fine,
                                           const FineNodes<Dim>& nodes, const Execution& execution = {},
                                           const ProgressCallback& progress = {}) {
    require(coarse.size() == fine.size(), "coarse", text(fine.size(), " cases, as the fine"), coarse.size());
    const std::size_t n = fine.size();
    std::vector<Motion<Dim, double>> by_network(n);
    std::vector<Motion<Dim, double>> by_reference(n);
    std::vector<Motion<Dim, double>> recorded = fine.motions;
    Stage stage(progress, "score fine nodes", n);
    execution.for_chunks(static_cast<Index>(n), 1, [&](Index, Index begin, Index) {
        const auto c = static_cast<std::size_t>(begin);
        const auto carried = [&](const std::vector<Points<Dim, double>>& frames) {
            Motion<Dim, double> motion;
            motion.rest_positions = nodes.rest_positions;
            for (const auto& positions : frames) {
                motion.positions.push_back(
                    deform<Dim, double>(nodes.at_fine, nodes.rest_positions, network.rest_positions, positions));
            }
            return motion;
        };
        by_network[c] =
            carried(detail::positions_under<Dim>(network, coarse.cases[c].scenario, coarse.motions[c], stage.part(c)));
        by_reference[c] = carried(coarse.motions[c].positions);
        recorded[c].clamped.clear(); // the network may move those, too
    });
    EmbeddedError result{motion_error(by_network, recorded), motion_error(by_reference, recorded)};
    if (stage.stopped()) {
        result.by_network.error = std::numeric_limits<double>::infinity();
    }
    return result;
}

/// A recorded motion at some of its nodes, in their order. O(frames x nodes).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Motion<Dim, Scalar> motion_at(const Motion<Dim, Scalar>& motion, const std::vector<int>& nodes) {
    const auto pick = [&](const std::vector<Points<Dim, Scalar>>& frames) {
        std::vector<Points<Dim, Scalar>> picked;
        for (const auto& frame : frames) {
            picked.push_back(frame(Eigen::all, nodes));
        }
        return picked;
    };
    Motion<Dim, Scalar> result;
    result.name = motion.name;
    result.rest_positions = motion.rest_positions(Eigen::all, nodes);
    for (std::size_t p = 0; p < nodes.size(); ++p) {
        if (std::binary_search(motion.clamped.begin(), motion.clamped.end(), nodes[p])) {
            result.clamped.push_back(static_cast<int>(p));
        }
    }
    result.times = motion.times;
    result.positions = pick(motion.positions);
    result.velocities = pick(motion.velocities);
    result.accelerations = pick(motion.accelerations);
    result.external_forces = pick(motion.external_forces);
    return result;
}

} // namespace springfit
