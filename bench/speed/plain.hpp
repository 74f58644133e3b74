// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

/// What an engineer writes in an hour, without any library: the baselines that the benchmarks stand beside.
namespace plain {

template <int Dim, class Scalar>
struct Body {
    std::vector<Scalar> x, v, f, mass;        // Dim per node, one mass per node
    std::vector<int> ends;                    // two per spring
    std::vector<Scalar> k, rest_length, damping;
    std::vector<char> fixed;
};

/// One symplectic Euler step, springs in their given order.
template <int Dim, class Scalar>
void step(Body<Dim, Scalar>& body, Scalar dt) {
    for (Scalar& f : body.f) {
        f = 0;
    }
    const std::size_t n_springs = body.k.size();
    for (std::size_t e = 0; e < n_springs; ++e) {
        const Scalar* xi = &body.x[static_cast<std::size_t>(Dim * body.ends[2 * e])];
        const Scalar* xj = &body.x[static_cast<std::size_t>(Dim * body.ends[2 * e + 1])];
        const Scalar* vi = &body.v[static_cast<std::size_t>(Dim * body.ends[2 * e])];
        const Scalar* vj = &body.v[static_cast<std::size_t>(Dim * body.ends[2 * e + 1])];
        Scalar* fi = &body.f[static_cast<std::size_t>(Dim * body.ends[2 * e])];
        Scalar* fj = &body.f[static_cast<std::size_t>(Dim * body.ends[2 * e + 1])];
        Scalar r[Dim];
        Scalar length2 = 0;
        Scalar rate = 0;
        for (int d = 0; d < Dim; ++d) {
            r[d] = xj[d] - xi[d];
            length2 += r[d] * r[d];
            rate += r[d] * (vj[d] - vi[d]);
        }
        const Scalar length = std::sqrt(length2);
        const Scalar pull = (body.k[e] * (length - body.rest_length[e]) + body.damping[e] * rate / length) / length;
        for (int d = 0; d < Dim; ++d) {
            fi[d] += pull * r[d];
            fj[d] -= pull * r[d];
        }
    }
    for (std::size_t i = 0; i < body.mass.size(); ++i) {
        if (body.fixed[i]) {
            continue;
        }
        for (int d = 0; d < Dim; ++d) {
            body.v[Dim * i + d] += dt * body.f[Dim * i + d] / body.mass[i];
            body.x[Dim * i + d] += dt * body.v[Dim * i + d];
        }
    }
}

} // namespace plain
