// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/body/spring_body.hpp>
#include <springfit/simulate/stable_step.hpp>

#include "bodies.hpp"

/// Explicit steps that more than one program measures.
namespace bench {

using namespace springfit;

/// Steps of half the stable one from a stretched state. Besides the time: what the step kernel keeps per spring.
template <int Dim, class Scalar>
void step_body(benchmark::State& state, const SpringNetwork<Dim, Scalar>& network, const Execution& execution = {}) {
    const Scalar h = stable_step(network) / 2;
    SpringBody<Dim, Scalar> body(network, execution);
    body.write(Scalar(1.01) * network.rest_positions, Points<Dim, Scalar>::Zero(Dim, network.n_nodes()));
    for (auto _ : state) {
        body.step(h);
        benchmark::ClobberMemory();
    }
    count(state, network.n_springs());
    state.counters["bytes_per_spring"] = static_cast<double>(body.bytes()) / static_cast<double>(network.n_springs());
}

template <int Dim, class Scalar>
void explicit_step(benchmark::State& state, Index springs) {
    step_body(state, bench::network<Dim, Scalar>(springs));
}

/// Bytes that a step of the plain loop moves if each array is read once and each array that changes written once.
template <int Dim, class Scalar>
double bytes_of_a_plain_step(const plain::Body<Dim, Scalar>& body) {
    const auto bytes = [](const auto& array) { return static_cast<double>(array.size() * sizeof(array[0])); };
    return 2 * (bytes(body.x) + bytes(body.v) + bytes(body.f)) + bytes(body.mass) + bytes(body.fixed) +
           bytes(body.ends) + bytes(body.k) + bytes(body.rest_length) + bytes(body.damping);
}

template <int Dim, class Scalar>
void step_plainly(benchmark::State& state, const SpringNetwork<Dim, Scalar>& network) {
    auto body = plain_body(network);
    for (Scalar& x : body.x) {
        x *= Scalar(1.01);
    }
    const Scalar h = stable_step(network) / 2;
    for (auto _ : state) {
        plain::step(body, h);
        benchmark::DoNotOptimize(body.x.data());
        benchmark::ClobberMemory();
    }
    count(state, network.n_springs());
    const auto n_springs = static_cast<double>(network.n_springs());
    state.counters["bytes_per_spring"] = bytes_of_a_plain_step(body) / n_springs;
    if (Dim == 3) {
        // per spring 31 sums and products, a root and two quotients, each counted as one; per node 15
        state.counters["operations_per_spring"] = 34 + 15 * static_cast<double>(network.n_nodes()) / n_springs;
    }
}

template <int Dim, class Scalar>
void plain_loop(benchmark::State& state, Index springs) {
    step_plainly(state, bench::network<Dim, Scalar>(springs));
}

} // namespace bench
