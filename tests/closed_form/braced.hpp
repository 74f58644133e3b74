// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/mesh/structured.hpp>
#include <springfit/network/builders.hpp>

namespace springfit::test {

/// Energy of springs under a small uniform strain: sum 1/2 k (n' eps n l)^2.
template <int Dim, class Scalar>
Scalar spring_energy(const SpringNetwork<Dim, Scalar>& network, const Eigen::Matrix<Scalar, Dim, Dim>& strain) {
    Scalar energy = 0;
    for (Index e = 0; e < network.n_springs(); ++e) {
        const Vector<Dim, Scalar> r =
            network.rest_positions.col(network.springs(1, e)) - network.rest_positions.col(network.springs(0, e));
        const Scalar stretch = r.dot(strain * r) / r.norm();
        energy += network.stiffness(e) * stretch * stretch / 2;
    }
    return energy;
}

/// lambda/2 tr^2 + mu eps : eps per volume.
template <int Dim, class Scalar>
Scalar elastic_density(const Eigen::Matrix<Scalar, Dim, Dim>& strain, Scalar lambda, Scalar mu) {
    return lambda / 2 * strain.trace() * strain.trace() + mu * strain.squaredNorm();
}

template <int Dim, class Scalar>
Eigen::Matrix<Scalar, Dim, Dim> random_strain() {
    const Eigen::Matrix<Scalar, Dim, Dim> any = Eigen::Matrix<Scalar, Dim, Dim>::Random();
    return any + any.transpose();
}

enum class Bracing { faces, bodies, both };

/// Edges with the diagonals of one kind or both.
template <class Scalar>
SpringNetwork<3, Scalar> braced(const Mesh<3, Scalar, Hex8>& mesh, Bracing bracing) {
    const Index per_cell[] = {12, 4, 16};
    const Index from[] = {0, 12, 0};
    std::vector<std::array<int, 2>> pairs;
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        for (const auto& edge : Hex8::edges) {
            pairs.push_back({mesh.cells(edge[0], c), mesh.cells(edge[1], c)});
        }
        for (Index d = 0; d < per_cell[static_cast<int>(bracing)]; ++d) {
            const auto& diagonal = Hex8::diagonals[static_cast<std::size_t>(from[static_cast<int>(bracing)] + d)];
            pairs.push_back({mesh.cells(diagonal[0], c), mesh.cells(diagonal[1], c)});
        }
    }
    return springs_from_list<3, Scalar>(mesh.nodes, springfit::detail::sorted_unique_pairs(pairs));
}

} // namespace springfit::test
