// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numeric>
#include <random>

#include <springfit/cases/clamp_sets.hpp>
#include <springfit/cases/specimen.hpp>
#include <springfit/closed_form/van_gelder.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/network/builders.hpp>
#include <springfit/network/masses.hpp>

namespace springfit::test {

/// A box of a few cells, 30 by 50 cm in the plane.
template <int Dim>
[[nodiscard]] auto small_box() {
    if constexpr (Dim == 2) {
        return triangle_grid<double>({3, 5}, {0.3, 0.5});
    } else {
        return tetrahedron_grid<double>({2, 3, 2}, {0.2, 0.3, 0.2});
    }
}

/// That box, clamped where y = 0.
template <int Dim>
[[nodiscard]] Specimen<Dim, double> small_specimen() {
    auto body = specimen_of(small_box<Dim>(), 1000.);
    body.clamps = {{side_nodes(body.rest_positions, {.axis = 1}), {}}};
    return body;
}

/// Its edges as springs, by Van Gelder's closed form.
template <int Dim>
[[nodiscard]] SpringNetwork<Dim, double> small_network() {
    const auto mesh = small_box<Dim>();
    auto network = springs_along_edges(mesh, {.density = 1000.});
    network.stiffness = van_gelder(mesh, network.springs, {.young = 1e4, .poisson = 0.3}).stiffness;
    return network;
}

/// That network with stiffness that varies from spring to spring, to find again.
template <int Dim>
[[nodiscard]] SpringNetwork<Dim, double> hidden_network() {
    auto network = small_network<Dim>();
    for (Index e = 0; e < network.n_springs(); ++e) {
        network.stiffness(e) *= 1 + 0.5 * std::sin(static_cast<double>(e));
    }
    return network;
}

/// The network with the same stiffness everywhere.
template <int Dim>
[[nodiscard]] SpringNetwork<Dim, double> even(SpringNetwork<Dim, double> network) {
    network.stiffness.setConstant(network.stiffness.mean());
    return network;
}

/// A box three times as long as wide, its inner nodes moved, not clamped.
template <int Dim, class Scalar>
[[nodiscard]] Specimen<Dim, Scalar> box_body() {
    const auto body_of = [](auto mesh) {
        jitter(mesh, Scalar(0.2), 3);
        return Specimen<Dim, Scalar>{mesh.nodes, node_masses(mesh, Scalar(1000)), boundary_nodes(mesh), {}};
    };
    if constexpr (Dim == 2) {
        return body_of(triangle_grid<Scalar>({9, 3}, {Scalar(3), Scalar(1)}));
    } else {
        return body_of(tetrahedron_grid<Scalar>({9, 3, 4}, {Scalar(3), Scalar(1), Scalar(1.2)}));
    }
}

/// A flat sheet in space, 2 by 1; all of it is surface.
template <class Scalar>
[[nodiscard]] Specimen<3, Scalar> sheet_body() {
    const auto plane = triangle_grid<Scalar>({8, 4}, {Scalar(2), Scalar(1)});
    Specimen<3, Scalar> body{membrane(plane).nodes, node_masses(plane, Scalar(1)), {}, {}};
    body.surface.resize(static_cast<std::size_t>(body.n_nodes()));
    std::iota(body.surface.begin(), body.surface.end(), 0);
    return body;
}

/// A body with its nodes in another order, and the way back.
template <int Dim, class Scalar>
struct Renumbered {
    Specimen<Dim, Scalar> body;
    std::vector<int> old; ///< number in the first body of each node of this one

    [[nodiscard]] std::vector<int> back(std::vector<int> nodes) const {
        for (int& node : nodes) {
            node = old[static_cast<std::size_t>(node)];
        }
        std::sort(nodes.begin(), nodes.end());
        return nodes;
    }
};

template <int Dim, class Scalar>
[[nodiscard]] Renumbered<Dim, Scalar> renumbered(const Specimen<Dim, Scalar>& body, unsigned seed) {
    Renumbered<Dim, Scalar> result;
    result.old.resize(static_cast<std::size_t>(body.n_nodes()));
    std::iota(result.old.begin(), result.old.end(), 0);
    std::mt19937 random(seed);
    std::shuffle(result.old.begin(), result.old.end(), random);
    std::vector<int> number(result.old.size());
    for (std::size_t i = 0; i < result.old.size(); ++i) {
        number[static_cast<std::size_t>(result.old[i])] = static_cast<int>(i);
    }
    result.body.rest_positions = body.rest_positions(Eigen::all, result.old);
    result.body.masses = body.masses(result.old);
    const auto renumber = [&](std::vector<int> nodes) {
        for (int& node : nodes) {
            node = number[static_cast<std::size_t>(node)];
        }
        return nodes;
    };
    result.body.surface = renumber(body.surface);
    for (const auto& clamp : body.clamps) {
        result.body.clamps.push_back({renumber(clamp.nodes), clamp.position});
    }
    return result;
}

} // namespace springfit::test
