// SPDX-License-Identifier: BSD-3-Clause
// Nanoseconds per spring of one time step: explicit and implicit, each beside a plain hand-written loop.

#include <springfit/step/implicit_euler.hpp>
#include <springfit/step/symplectic_euler.hpp>

#include "bodies.hpp"

namespace {

using namespace springfit;

template <int Dim, class Scalar>
void explicit_step(benchmark::State& state, Index springs) {
    const auto network = bench::network<Dim, Scalar>(springs);
    const Scalar h = stable_step(network) / 2;
    const Values<Scalar> inverse_masses = network.mass.cwiseInverse();
    const Points<Dim, Scalar> external = Points<Dim, Scalar>::Zero(Dim, network.n_nodes());
    Points<Dim, Scalar> positions = Scalar(1.01) * network.rest_positions;
    Points<Dim, Scalar> velocities = external;
    Points<Dim, Scalar> forces = external;
    for (auto _ : state) {
        symplectic_euler_step<Dim, Scalar>(network, inverse_masses, external, h, positions, velocities, forces);
        benchmark::DoNotOptimize(positions.data());
        benchmark::ClobberMemory();
    }
    bench::count(state, network.n_springs());
}

template <int Dim, class Scalar>
void plain_loop(benchmark::State& state, Index springs) {
    const auto network = bench::network<Dim, Scalar>(springs);
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
}

/// One implicit Euler step of 30 times the stable step, from a stretched state.
template <int Dim, class Scalar>
void implicit_step(benchmark::State& state, Index springs) {
    const auto network = bench::network<Dim, Scalar>(springs);
    const Scalar h = 30 * stable_step(network);
    ImplicitEuler<Dim, Scalar> stepper(network);
    Scenario<Dim, Scalar> scenario;
    scenario.initial_positions = Scalar(1.01) * network.rest_positions;
    auto body = stepper.start(scenario);
    for (auto _ : state) {
        if (stepper.advance(body, scenario, h) != Status::converged) {
            state.SkipWithError("the implicit step did not converge");
            break;
        }
        benchmark::DoNotOptimize(body.positions.data());
    }
    bench::count(state, network.n_springs());
}

template <int Dim, class Scalar>
void add() {
    for (Index springs : {1000, 10000, 100000}) {
        const auto add_one = [&](const char* what, auto function) {
            return benchmark::RegisterBenchmark(bench::name<Dim, Scalar>(what, springs).c_str(), function, springs);
        };
        add_one("explicit_step", explicit_step<Dim, Scalar>);
        add_one("plain_loop", plain_loop<Dim, Scalar>);
        if (springs <= 10000) {
            add_one("implicit_step", implicit_step<Dim, Scalar>)->Unit(benchmark::kMillisecond);
        }
    }
}

} // namespace

int main(int argc, char** argv) {
    add<2, float>();
    add<2, double>();
    add<3, float>();
    add<3, double>();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
        return 1;
    }
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
}
