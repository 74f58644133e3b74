// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>

#include <springfit/mesh/structured.hpp>

namespace springfit::test {

template <int Dim, class Scalar>
Points<Dim, Scalar> random_points(int n, Scalar low, Scalar high) {
    std::mt19937 random(11);
    std::uniform_real_distribution<Scalar> coordinate(low, high);
    return Points<Dim, Scalar>::NullaryExpr(Dim, n, [&] { return coordinate(random); });
}

template <class Mesh>
Mesh shaken(Mesh mesh) {
    jitter(mesh, typename decltype(mesh.nodes)::Scalar(0.2), 5);
    return mesh;
}

} // namespace springfit::test
