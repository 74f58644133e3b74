// SPDX-License-Identifier: BSD-3-Clause
// One time step of springfit, of a plain loop and of other programs that are installed, on the same bodies in one run.
// All of one size follow one another, so that their ratios do not suffer from a machine that changes its speed.

#include <springfit/body/implicit_body.hpp>

#include "peers/peers.hpp"
#include "run.hpp"
#include "steps.hpp"

namespace {

using namespace springfit;

/// One linearised implicit step of 30 times the stable step, always from the same stretched state.
template <class Scalar>
void implicit_step(benchmark::State& state, Index springs) {
    const auto network = bench::network<3, Scalar>(springs);
    const Scalar h = 30 * stable_step(network);
    const Points<3, Scalar> stretched = Scalar(1.01) * network.rest_positions;
    const Points<3, Scalar> still = Points<3, Scalar>::Zero(3, network.n_nodes());
    ImplicitBody<3, Scalar> body(network);
    for (auto _ : state) {
        state.PauseTiming();
        body.write(stretched, still);
        state.ResumeTiming();
        benchmark::DoNotOptimize(body.step(h));
    }
    bench::count(state, network.n_springs());
}

template <class Scalar>
void add_own(Index springs) {
    const auto add = [&](const char* what, auto function) {
        benchmark::RegisterBenchmark(bench::name<3, Scalar>(what, springs).c_str(), function, springs);
    };
    add("plain_loop", bench::plain_loop<3, Scalar>);
    add("explicit_step", bench::explicit_step<3, Scalar>);
    add("implicit_step", implicit_step<Scalar>);
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
