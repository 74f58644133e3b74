// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "instances/instances.hpp"

#include <random>

#include <springfit/mesh/structured.hpp>
#include <springfit/motion/scenario.hpp>
#include <springfit/network/builders.hpp>

namespace springfit::test {

/// A jittered mesh of unit size with random stiffness over a decade; damping up to `damping` times the stiffness.
template <int Dim, std::floating_point Scalar>
SpringNetwork<Dim, Scalar> random_network(Scalar damping, int cells = 2) {
    SpringNetwork<Dim, Scalar> network;
    if constexpr (Dim == 2) {
        auto mesh = triangle_grid<Scalar>({cells + 1, cells}, {Scalar(1.5), Scalar(1)});
        jitter(mesh, Scalar(0.2), 1);
        network = springs_along_edges(mesh);
    } else {
        auto mesh = tetrahedron_grid<Scalar>({cells, cells, cells}, {Scalar(1), Scalar(1), Scalar(1)});
        jitter(mesh, Scalar(0.2), 1);
        network = springs_along_edges(mesh);
    }
    std::mt19937 random(11);
    std::uniform_real_distribution<Scalar> unit(0, 1);
    for (Index e = 0; e < network.n_springs(); ++e) {
        network.stiffness(e) = 10 * std::pow(Scalar(10), unit(random));
        network.damping(e) = damping * unit(random) * network.stiffness(e);
    }
    return network;
}

/// The same network with cells of stiffness between `least` and `most`.
template <int Dim, std::floating_point Scalar>
SpringNetwork<Dim, Scalar> random_network_with_cells(Scalar damping, Scalar least, Scalar most, int cells = 2) {
    auto network = random_network<Dim, Scalar>(damping, cells);
    if constexpr (Dim == 2) {
        auto mesh = triangle_grid<Scalar>({cells + 1, cells}, {Scalar(1.5), Scalar(1)});
        jitter(mesh, Scalar(0.2), 1);
        add_volume_cells(network, mesh);
    } else {
        auto mesh = tetrahedron_grid<Scalar>({cells, cells, cells}, {Scalar(1), Scalar(1), Scalar(1)});
        jitter(mesh, Scalar(0.2), 1);
        add_volume_cells(network, mesh);
    }
    std::mt19937 random(12);
    std::uniform_real_distribution<Scalar> value(least, most);
    for (Index c = 0; c < network.n_cells(); ++c) {
        network.volume_stiffness(c) = value(random);
    }
    return network;
}

/// A start far from rest: the body stretched, sheared and thrown.
template <int Dim, std::floating_point Scalar>
Scenario<Dim, Scalar> thrown(const SpringNetwork<Dim, Scalar>& network, Scalar size = Scalar(0.2)) {
    Scenario<Dim, Scalar> scenario;
    scenario.initial_positions = network.rest_positions;
    scenario.initial_velocities = Points<Dim, Scalar>::Zero(Dim, network.n_nodes());
    for (Index i = 0; i < network.n_nodes(); ++i) {
        const Vector<Dim, Scalar> x = network.rest_positions.col(i);
        scenario.initial_positions.col(i) *= 1 + size;
        scenario.initial_positions(0, i) += size * x(1);
        scenario.initial_velocities(1, i) = 1 + size * x(0) * 3;
    }
    return scenario;
}

/// Two masses 1 and 3 kg on an axis, joined by one spring of length 1 m.
template <int Dim, std::floating_point Scalar>
SpringNetwork<Dim, Scalar> two_masses(Scalar stiffness, Scalar damping) {
    Points<Dim, Scalar> rest = Points<Dim, Scalar>::Zero(Dim, 2);
    rest(0, 1) = 1;
    NodePairs pair(2, 1);
    pair << 0, 1;
    Values<Scalar> masses(2);
    masses << 1, 3;
    auto network = springs_from_list<Dim, Scalar>(rest, pair, masses);
    network.stiffness << stiffness;
    network.damping << damping;
    return network;
}

} // namespace springfit::test

#include "example.ipp" // compiled once
