// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/mesh/structured.hpp>
#include <springfit/network/biquadratic_network.hpp>

namespace springfit::test {

/// Jittered triangles; in space rolled up around an axis, so that they are curved.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Mesh<Dim, Scalar, Tri3> triangles(int cells = 3) {
    auto flat = triangle_grid<Scalar>({cells, cells}, {Scalar(1), Scalar(1)});
    jitter(flat, Scalar(0.2), 1);
    if constexpr (Dim == 2) {
        return flat;
    } else {
        auto mesh = membrane(flat);
        for (Index i = 0; i < mesh.n_nodes(); ++i) {
            const Scalar angle = mesh.nodes(0, i);
            mesh.nodes.col(i) << std::sin(angle), mesh.nodes(1, i), std::cos(angle);
        }
        return mesh;
    }
}

/// Every coordinate moved by up to `size`.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Points<Dim, Scalar> moved(Points<Dim, Scalar> points, Scalar size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<Scalar> unit(-1, 1);
    for (Scalar& value : points.reshaped()) {
        value += size * unit(random);
    }
    return points;
}

/// Coefficients at random, the angular ones of either sign.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] BiquadraticNetwork<Dim, Scalar> random_biquadratic() {
    auto network = biquadratic_network(triangles<Dim, Scalar>(), {.density = Scalar(3), .thickness = Scalar(0.1)});
    std::mt19937 random(5);
    std::uniform_real_distribution<Scalar> unit(0, 1);
    for (Index t = 0; t < network.n_triangles(); ++t) {
        for (int i = 0; i < 3; ++i) {
            network.tensile(i, t) = 1 + unit(random);
            network.angular(i, t) = unit(random) - Scalar(0.5);
            network.rest_length(i, t) *= 1 + (unit(random) - Scalar(0.5)) / 5;
        }
    }
    return network;
}

} // namespace springfit::test
