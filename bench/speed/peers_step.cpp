// SPDX-License-Identifier: BSD-3-Clause
// One time step of springfit, of a plain loop and of other programs that are installed, on the same bodies in one run.
// All of one size follow one another, so that their ratios do not suffer from a machine that changes its speed.

#include <springfit/step/implicit_euler.hpp>
#include <springfit/step/symplectic_euler.hpp>

#include "bodies.hpp"
#include "peers/peers.hpp"
#include "run.hpp"

namespace {

using namespace springfit;

template <class Scalar>
void explicit_step(benchmark::State& state, Index springs) {
    const auto network = bench::network<3, Scalar>(springs);
    const Scalar h = stable_step(network) / 2;
    const Values<Scalar> inverse_masses = network.mass.cwiseInverse();
    const Points<3, Scalar> external = Points<3, Scalar>::Zero(3, network.n_nodes());
    Points<3, Scalar> positions = Scalar(1.01) * network.rest_positions;
    Points<3, Scalar> velocities = external;
    Points<3, Scalar> forces = external;
    for (auto _ : state) {
        symplectic_euler_step<3, Scalar>(network, inverse_masses, external, h, positions, velocities, forces);
        benchmark::DoNotOptimize(positions.data());
        benchmark::ClobberMemory();
    }
    bench::count(state, network.n_springs());
}

/// Bytes that a step of the plain loop moves if each array is read once and each array that changes written once.
template <class Scalar>
double bytes_of_a_plain_step(const plain::Body<3, Scalar>& body) {
    const auto bytes = [](const auto& array) { return static_cast<double>(array.size() * sizeof(array[0])); };
    return 2 * (bytes(body.x) + bytes(body.v) + bytes(body.f)) + bytes(body.mass) + bytes(body.fixed) +
           bytes(body.ends) + bytes(body.k) + bytes(body.rest_length) + bytes(body.damping);
}

template <class Scalar>
void plain_loop(benchmark::State& state, Index springs) {
    const auto network = bench::network<3, Scalar>(springs);
    auto body = bench::plain_body(network);
    for (Scalar& x : body.x) {
        x *= Scalar(1.01);
    }
    const Scalar h = stable_step(network) / 2;
    for (auto _ : state) {
        plain::step(body, h);
        benchmark::DoNotOptimize(body.x.data());
        benchmark::ClobberMemory();
    }
    bench::count(state, network.n_springs());
    const auto n_springs = static_cast<double>(network.n_springs());
    state.counters["bytes_per_spring"] = bytes_of_a_plain_step(body) / n_springs;
    // per spring 31 sums and products, a root and two quotients, each counted as one; per node 15
    state.counters["operations_per_spring"] = 34 + 15 * static_cast<double>(network.n_nodes()) / n_springs;
}

/// One implicit Euler step of 30 times the stable step, always from the same stretched state.
template <class Scalar>
void implicit_step(benchmark::State& state, Index springs) {
    const auto network = bench::network<3, Scalar>(springs);
    const Scalar h = 30 * stable_step(network);
    ImplicitEuler<3, Scalar> stepper(network);
    Scenario<3, Scalar> scenario;
    scenario.initial_positions = Scalar(1.01) * network.rest_positions;
    const auto stretched = stepper.start(scenario);
    auto body = stretched;
    for (auto _ : state) {
        state.PauseTiming();
        body = stretched;
        state.ResumeTiming();
        if (stepper.advance(body, scenario, h) != Status::converged) {
            state.SkipWithError("the implicit step did not converge");
            break;
        }
        benchmark::DoNotOptimize(body.positions.data());
    }
    bench::count(state, network.n_springs());
}

template <class Scalar>
void add_own(Index springs) {
    const auto add = [&](const char* what, auto function) {
        benchmark::RegisterBenchmark(bench::name<3, Scalar>(what, springs).c_str(), function, springs);
    };
    add("plain_loop", plain_loop<Scalar>);
    add("explicit_step", explicit_step<Scalar>);
    if (springs <= 10000) {
        add("implicit_step", implicit_step<Scalar>);
    }
}

} // namespace

int main(int argc, char** argv) {
    for (Index springs : {1000, 10000, 100000, 1000000}) {
#ifndef BT_USE_DOUBLE_PRECISION
        add_own<float>(springs);
#endif
        add_own<double>(springs);
#ifdef SPRINGFIT_BENCH_BULLET
        bench::peers::add_bullet(springs);
#endif
#ifdef SPRINGFIT_BENCH_MUJOCO
        bench::peers::add_mujoco(springs);
#endif
    }
    return bench::run(argc, argv);
}
