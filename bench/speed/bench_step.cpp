// SPDX-License-Identifier: BSD-3-Clause
// Nanoseconds per spring of one time step: explicit and implicit, each beside a plain hand-written loop.

#include <numeric>

#ifdef SPRINGFIT_BENCH_PARALLEL
#include <springfit/parallel/tbb.hpp>
#endif
#include <springfit/step/implicit_euler.hpp>
#include <springfit/step/spring_batch.hpp>

#include "run.hpp"
#include "steps.hpp"

namespace {

using namespace springfit;

/// Nodes and springs in random order, as a mesh from elsewhere may have them.
template <int Dim, class Scalar>
SpringNetwork<Dim, Scalar> shuffled(const SpringNetwork<Dim, Scalar>& network) {
    std::mt19937 random(5);
    std::vector<int> number(static_cast<std::size_t>(network.n_nodes()));
    std::vector<int> spring(static_cast<std::size_t>(network.n_springs()));
    std::iota(number.begin(), number.end(), 0);
    std::iota(spring.begin(), spring.end(), 0);
    std::shuffle(number.begin(), number.end(), random);
    std::shuffle(spring.begin(), spring.end(), random);
    SpringNetwork<Dim, Scalar> result = network;
    for (Index i = 0; i < network.n_nodes(); ++i) {
        result.rest_positions.col(number[static_cast<std::size_t>(i)]) = network.rest_positions.col(i);
        result.mass(number[static_cast<std::size_t>(i)]) = network.mass(i);
    }
    for (Index e = 0; e < network.n_springs(); ++e) {
        const int from = spring[static_cast<std::size_t>(e)];
        for (int end : {0, 1}) {
            result.springs(end, e) = number[static_cast<std::size_t>(network.springs(end, from))];
        }
        result.stiffness(e) = network.stiffness(from);
        result.rest_length(e) = network.rest_length(from);
        result.damping(e) = network.damping(from);
    }
    return result;
}

template <int Dim, class Scalar>
void explicit_step_random_order(benchmark::State& state, Index springs) {
    bench::step_body(state, shuffled(bench::network<Dim, Scalar>(springs)));
}

/// 64 bodies of a network; per spring of each.
template <int Dim, class Scalar>
void batch_step(benchmark::State& state, Index springs) {
    constexpr Index n_bodies = 64;
    const auto network = bench::network<Dim, Scalar>(springs);
    const Scalar h = stable_step(network) / 2;
    SpringBatch<Dim, Scalar> batch(network, n_bodies);
    for (Index b = 0; b < n_bodies; ++b) {
        batch.write(b, Scalar(1.01) * network.rest_positions, Points<Dim, Scalar>::Zero(Dim, network.n_nodes()));
    }
    for (auto _ : state) {
        batch.step(h);
        benchmark::ClobberMemory();
    }
    bench::count(state, n_bodies * network.n_springs());
}

#ifdef SPRINGFIT_BENCH_PARALLEL
template <int Dim, class Scalar>
void explicit_step_two_threads(benchmark::State& state, Index springs) {
    bench::step_body(state, bench::network<Dim, Scalar>(springs), parallel::tbb(2));
}
#endif

template <int Dim, class Scalar>
void plain_loop_random_order(benchmark::State& state, Index springs) {
    bench::step_plainly(state, shuffled(bench::network<Dim, Scalar>(springs)));
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
    for (Index springs : {1000, 10000, 100000, 1000000}) {
        const auto add_one = [&](const char* what, auto function) {
            return benchmark::RegisterBenchmark(bench::name<Dim, Scalar>(what, springs).c_str(), function, springs);
        };
        add_one("plain_loop", bench::plain_loop<Dim, Scalar>);
        add_one("explicit_step", bench::explicit_step<Dim, Scalar>);
        if (springs <= 10000) {
            add_one("batch_step", batch_step<Dim, Scalar>);
        }
        if (springs >= 100000) {
            add_one("plain_loop_random_order", plain_loop_random_order<Dim, Scalar>);
            add_one("explicit_step_random_order", explicit_step_random_order<Dim, Scalar>);
#ifdef SPRINGFIT_BENCH_PARALLEL
            add_one("explicit_step_two_threads", explicit_step_two_threads<Dim, Scalar>)->UseRealTime();
#endif
        }
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
    return bench::run(argc, argv);
}
