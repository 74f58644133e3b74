// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <functional>
#include <string>

#include <springfit/core/error.hpp>
#include <springfit/core/types.hpp>

namespace springfit {

/// A factor over time; empty means 1 at all times.
template <std::floating_point Scalar>
using Amplitude = std::function<Scalar(Scalar time)>;

/// Nodes whose motion is prescribed.
template <int Dim, std::floating_point Scalar>
struct Clamp {
    std::vector<int> nodes;
    /// Position of a node at a time, from its rest position; empty means that the nodes stay at rest.
    std::function<Vector<Dim, Scalar>(const Vector<Dim, Scalar>& rest, Scalar time)> position;
};

/// An acceleration of the whole body, as gravity, times an amplitude; acts on a node with its mass.
template <int Dim, std::floating_point Scalar>
struct Gravity {
    Vector<Dim, Scalar> acceleration; ///< m/s^2
    Amplitude<Scalar> amplitude;
};

/// Forces on some nodes, times an amplitude. Tractions and body forces are turned into these (`fem/loads.hpp`).
template <int Dim, std::floating_point Scalar>
struct NodalLoad {
    std::vector<int> nodes;
    Points<Dim, Scalar> forces; ///< [Dim x nodes.size()], N
    Amplitude<Scalar> amplitude;
};

/// One load case: all that is done to a body. It names nodes only, so the same scenario drives the reference and the
/// network.
template <int Dim, std::floating_point Scalar>
struct Scenario {
    std::string name;
    std::vector<Clamp<Dim, Scalar>> clamps;
    std::vector<Gravity<Dim, Scalar>> gravity;
    std::vector<NodalLoad<Dim, Scalar>> loads;
    Points<Dim, Scalar> initial_positions;  ///< [Dim x n_nodes], m; empty: the rest positions
    Points<Dim, Scalar> initial_velocities; ///< [Dim x n_nodes], m/s; empty: at rest
};

/// The nodes that any clamp holds, ascending, each once. Throws InvalidArgument for a node not in [0, n_nodes).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] std::vector<int> clamped_nodes(const Scenario<Dim, Scalar>& scenario, Index n_nodes) {
    std::vector<int> nodes;
    for (const auto& clamp : scenario.clamps) {
        nodes.insert(nodes.end(), clamp.nodes.begin(), clamp.nodes.end());
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    if (!nodes.empty()) {
        require(nodes.front() >= 0, "clamp", "node numbers not below 0", nodes.front());
        require(nodes.back() < n_nodes, "clamp", text("node numbers below ", n_nodes), nodes.back());
    }
    return nodes;
}

/// Moves the clamped columns of `positions` to where the clamps prescribe them at `time`.
template <int Dim, std::floating_point Scalar>
void apply_clamps(const Scenario<Dim, Scalar>& scenario, const Points<Dim, Scalar>& rest_positions, Scalar time,
                  Points<Dim, Scalar>& positions) {
    for (const auto& clamp : scenario.clamps) {
        for (int node : clamp.nodes) {
            const Vector<Dim, Scalar> rest = rest_positions.col(node);
            positions.col(node) = clamp.position ? clamp.position(rest, time) : rest;
        }
    }
}

/// The external forces of a scenario on nodes of the given masses at `time` `[Dim x n_nodes]`, N.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Points<Dim, Scalar> external_forces(const Scenario<Dim, Scalar>& scenario, const Values<Scalar>& masses,
                                                  Scalar time) {
    Points<Dim, Scalar> forces = Points<Dim, Scalar>::Zero(Dim, masses.size());
    for (const auto& gravity : scenario.gravity) {
        const Scalar factor = gravity.amplitude ? gravity.amplitude(time) : Scalar(1);
        forces.noalias() += factor * gravity.acceleration * masses.transpose();
    }
    for (const auto& load : scenario.loads) {
        const Scalar factor = load.amplitude ? load.amplitude(time) : Scalar(1);
        if (factor == 0) {
            continue;
        }
        for (std::size_t a = 0; a < load.nodes.size(); ++a) {
            forces.col(load.nodes[a]) += factor * load.forces.col(static_cast<Index>(a));
        }
    }
    return forces;
}

/// Throws InvalidArgument unless node numbers and array sizes fit a body of `n_nodes` nodes.
template <int Dim, std::floating_point Scalar>
void validate(const Scenario<Dim, Scalar>& scenario, Index n_nodes) {
    (void)clamped_nodes(scenario, n_nodes);
    for (const auto& load : scenario.loads) {
        require(load.forces.cols() == static_cast<Index>(load.nodes.size()), "load",
                text(load.nodes.size(), " forces, one per node"), load.forces.cols());
        require(load.forces.allFinite(), "load", "finite forces", "a value that is not finite");
        for (int node : load.nodes) {
            require(node >= 0 && node < n_nodes, "load", text("node numbers in [0, ", n_nodes, ")"), node);
        }
    }
    for (const auto* start : {&scenario.initial_positions, &scenario.initial_velocities}) {
        require(start->size() == 0 || start->cols() == n_nodes, "initial state",
                text(n_nodes, " columns, one per node"), start->cols());
        require(start->size() == 0 || start->allFinite(), "initial state", "finite values",
                "a value that is not finite");
    }
}

} // namespace springfit
