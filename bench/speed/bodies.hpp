// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>
#include <string>
#include <type_traits>

#include <benchmark/benchmark.h>

#include <springfit/mesh/structured.hpp>
#include <springfit/network/builders.hpp>

#include "plain.hpp"

namespace bench {

template <int Dim, class Scalar>
[[nodiscard]] std::string name(const std::string& what, springfit::Index springs) {
    return what + "/" + std::to_string(Dim) + "d/" + (std::is_same_v<Scalar, float> ? "float" : "double") + "/" +
           std::to_string(springs);
}

/// Springs along the edges of a jittered grid of simplices, about `springs` of them (3 per node in the plane, 7 in
/// space), with stiffness over a decade and light damping; on request with its cells, 2 per node or 6, of the springs'
/// stiffness.
template <int Dim, class Scalar>
[[nodiscard]] springfit::SpringNetwork<Dim, Scalar> network(springfit::Index springs, bool volume = false) {
    using namespace springfit;
    const SpringOptions<Scalar> options{.volume = volume, .density = Scalar(1000)};
    auto result = [&] {
        if constexpr (Dim == 2) {
            const int n = static_cast<int>(std::lround(std::sqrt(static_cast<double>(springs) / 3)));
            auto mesh = triangle_grid<Scalar>({n, n}, {Scalar(1), Scalar(1)});
            jitter(mesh, Scalar(0.2), 1);
            return springs_along_edges(mesh, options);
        } else {
            const int n = static_cast<int>(std::lround(std::cbrt(static_cast<double>(springs) / 7)));
            auto mesh = tetrahedron_grid<Scalar>({n, n, n}, {Scalar(1), Scalar(1), Scalar(1)});
            jitter(mesh, Scalar(0.2), 1);
            return springs_along_edges(mesh, options);
        }
    }();
    std::mt19937 random(2);
    std::uniform_real_distribution<Scalar> decade(0, 1);
    for (Index e = 0; e < result.n_springs(); ++e) {
        result.stiffness(e) = Scalar(1e4) * std::pow(Scalar(10), decade(random)) * result.rest_length(e);
        result.damping(e) = Scalar(1e-3) * result.stiffness(e);
    }
    if (volume) {
        result.volume_stiffness.setConstant(Scalar(1e4));
    }
    return result;
}

/// The same body for the plain loops.
template <int Dim, class Scalar>
[[nodiscard]] plain::Body<Dim, Scalar> plain_body(const springfit::SpringNetwork<Dim, Scalar>& network) {
    plain::Body<Dim, Scalar> body;
    const auto copy = [](auto& target, const auto& source) {
        target.assign(source.data(), source.data() + source.size());
    };
    copy(body.x, network.rest_positions);
    body.v.assign(body.x.size(), 0);
    body.f.assign(body.x.size(), 0);
    copy(body.mass, network.mass);
    copy(body.ends, network.springs);
    copy(body.k, network.stiffness);
    copy(body.rest_length, network.rest_length);
    copy(body.damping, network.damping);
    body.fixed.assign(body.mass.size(), 0);
    copy(body.corners, network.cells);
    copy(body.rest_volume, network.rest_volume);
    copy(body.volume_stiffness, network.volume_stiffness);
    return body;
}

/// Adds the counter `ns_per_spring`: time per iteration, per spring.
inline void count(benchmark::State& state, springfit::Index springs) {
    state.counters["ns_per_spring"] =
        benchmark::Counter(static_cast<double>(springs) * 1e-9,
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.counters["springs"] = static_cast<double>(springs);
}

} // namespace bench
