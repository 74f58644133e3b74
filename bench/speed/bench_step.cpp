// SPDX-License-Identifier: BSD-3-Clause
// Nanoseconds per spring of one time step: explicit and implicit, each beside a plain hand-written loop.

#include <map>
#include <numeric>

#ifdef SPRINGFIT_BENCH_PARALLEL
#include <springfit/parallel/tbb.hpp>
#endif
#include <springfit/body/implicit_body.hpp>
#include <springfit/body/projective_body.hpp>
#include <springfit/body/spring_batch.hpp>

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

/// With a cell for each simplex of the grid; per spring.
template <int Dim, class Scalar>
void explicit_step_volume(benchmark::State& state, Index springs) {
    bench::step_body(state, bench::network<Dim, Scalar>(springs, true));
}

template <int Dim, class Scalar>
void plain_loop_volume(benchmark::State& state, Index springs) {
    bench::step_plainly(state, bench::network<Dim, Scalar>(springs, true));
}

/// 64 bodies of a network; per spring of each.
template <int Dim, class Scalar>
void step_batch(benchmark::State& state, const SpringNetwork<Dim, Scalar>& network) {
    constexpr Index n_bodies = 64;
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

template <int Dim, class Scalar>
void batch_step(benchmark::State& state, Index springs) {
    step_batch(state, bench::network<Dim, Scalar>(springs));
}

template <int Dim, class Scalar>
void batch_step_volume(benchmark::State& state, Index springs) {
    step_batch(state, bench::network<Dim, Scalar>(springs, true));
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

/// A body that swings under gravity, held at one end, some steps of `factor` times the stable step after its start; and
/// where the next step leads.
template <int Dim, class Scalar>
struct Swing {
    SpringNetwork<Dim, Scalar> network;
    std::vector<int> clamped;
    Points<Dim, Scalar> external, x, v, next;
    Scalar h;

    Swing(Index springs, Scalar factor)
        : network(bench::network<Dim, Scalar>(springs)), h(factor * stable_step(network)) {
        for (int i = 0; i < network.n_nodes(); ++i) {
            if (network.rest_positions(0, i) < Scalar(1e-6)) {
                clamped.push_back(i);
            }
        }
        external = Points<Dim, Scalar>::Zero(Dim, network.n_nodes());
        external.row(1) = -2 * network.mass.transpose();
        ImplicitBody<Dim, Scalar, Scalar> exact(network, {.max_iterations = 20, .tolerance = Scalar(1e-7)});
        exact.set_clamped(clamped);
        exact.set_external_forces(external);
        for (int s = 0; s < 4; ++s) {
            (void)exact.step(h);
        }
        exact.read(x, v);
        (void)exact.step(h);
        next = positions(exact);
    }

    template <class Body>
    void set_up(Body& body) const {
        body.write(x, v);
        body.set_clamped(clamped);
        body.set_external_forces(external);
    }

    template <class Body>
    [[nodiscard]] static Points<Dim, Scalar> positions(const Body& body) {
        Points<Dim, Scalar> positions, velocities;
        body.read(positions, velocities);
        return positions;
    }

    /// Relative to the movement of the step.
    [[nodiscard]] double error(const Points<Dim, Scalar>& found) const {
        return static_cast<double>((found - next).norm() / (next - x).norm());
    }

    [[nodiscard]] static const Swing& of(Index springs, Scalar factor) {
        static std::map<std::pair<Index, Scalar>, Swing> known;
        return known.try_emplace({springs, factor}, springs, factor).first->second;
    }
};

/// Steps `body` from the same state again and again.
template <int Dim, class Scalar, class Body>
void step_swing(benchmark::State& state, const Swing<Dim, Scalar>& swing, Body& body) {
    swing.set_up(body);
    const auto report = body.step(swing.h);
    state.counters["error"] = swing.error(Swing<Dim, Scalar>::positions(body));
    state.counters["iterations"] = report.iterations;
    state.counters["linear_iterations"] = report.linear_iterations;
    for (auto _ : state) {
        state.PauseTiming();
        body.write(swing.x, swing.v);
        state.ResumeTiming();
        benchmark::DoNotOptimize(body.step(swing.h));
    }
    bench::count(state, swing.network.n_springs());
}

/// One linearised step by `ImplicitBody` as it is by default.
template <int Dim, class Scalar>
void implicit_step(benchmark::State& state, Index springs, int factor) {
    const auto& swing = Swing<Dim, Scalar>::of(springs, static_cast<Scalar>(factor));
    ImplicitBody<Dim, Scalar> body(swing.network);
    step_swing(state, swing, body);
}

/// The same, its linear system solved further.
template <int Dim, class Scalar>
void implicit_step_tight(benchmark::State& state, Index springs, int factor) {
    const auto& swing = Swing<Dim, Scalar>::of(springs, static_cast<Scalar>(factor));
    ImplicitBody<Dim, Scalar> body(swing.network, {.linear_tolerance = Scalar(2e-3)});
    step_swing(state, swing, body);
}

template <int Dim, class Scalar>
void projective_step(benchmark::State& state, Index springs, int factor) {
    const auto& swing = Swing<Dim, Scalar>::of(springs, static_cast<Scalar>(factor));
    ProjectiveBody<Dim, Scalar> body(swing.network);
    step_swing(state, swing, body);
    state.counters["factor_per_node"] =
        static_cast<double>(body.n_factor_entries()) / static_cast<double>(swing.network.n_nodes());
}

/// One linearised step by hand, to a residual of 1e-4.
template <int Dim, class Scalar>
void plain_implicit_step(benchmark::State& state, Index springs, int factor) {
    const auto& swing = Swing<Dim, Scalar>::of(springs, static_cast<Scalar>(factor));
    auto body = bench::plain_body(swing.network);
    for (int node : swing.clamped) {
        body.fixed[static_cast<std::size_t>(node)] = 1;
    }
    const std::vector<Scalar> external(swing.external.data(), swing.external.data() + swing.external.size());
    const auto reset = [&] {
        std::copy(swing.x.data(), swing.x.data() + swing.x.size(), body.x.begin());
        std::copy(swing.v.data(), swing.v.data() + swing.v.size(), body.v.begin());
    };
    plain::Implicit<Dim, Scalar> implicit;
    reset();
    implicit.step(body, external, swing.h, Scalar(1e-4));
    state.counters["error"] =
        swing.error(Eigen::Map<const Points<Dim, Scalar>>(body.x.data(), Dim, swing.network.n_nodes()));
    state.counters["linear_iterations"] = implicit.iterations;
    for (auto _ : state) {
        state.PauseTiming();
        reset();
        state.ResumeTiming();
        implicit.step(body, external, swing.h, Scalar(1e-4));
        benchmark::DoNotOptimize(body.x.data());
        benchmark::ClobberMemory();
    }
    bench::count(state, swing.network.n_springs());
}

template <int Dim, class Scalar>
void add() {
    for (Index springs : {1000, 10000, 100000, 1000000}) {
        const auto add_one = [&](const char* what, auto function) {
            return benchmark::RegisterBenchmark(bench::name<Dim, Scalar>(what, springs).c_str(), function, springs);
        };
        add_one("plain_loop", bench::plain_loop<Dim, Scalar>);
        add_one("explicit_step", bench::explicit_step<Dim, Scalar>);
        add_one("plain_loop_volume", plain_loop_volume<Dim, Scalar>);
        add_one("explicit_step_volume", explicit_step_volume<Dim, Scalar>);
        if (springs <= 10000) {
            add_one("batch_step", batch_step<Dim, Scalar>);
            add_one("batch_step_volume", batch_step_volume<Dim, Scalar>);
        }
        if (springs >= 100000) {
            add_one("plain_loop_random_order", plain_loop_random_order<Dim, Scalar>);
            add_one("explicit_step_random_order", explicit_step_random_order<Dim, Scalar>);
#ifdef SPRINGFIT_BENCH_PARALLEL
            add_one("explicit_step_two_threads", explicit_step_two_threads<Dim, Scalar>)->UseRealTime();
#endif
        }
        if constexpr (std::same_as<Scalar, double>) { // an error needs a reference that is much better
            for (int factor : {30, 100}) {
                const auto add_implicit = [&](const std::string& what, auto function) {
                    const auto name = bench::name<Dim, Scalar>(what + "_" + std::to_string(factor), springs);
                    benchmark::RegisterBenchmark(name.c_str(), function, springs, factor)
                        ->Unit(benchmark::kMillisecond);
                };
                if (springs >= 10000 && (springs <= 100000 || factor == 30)) {
                    add_implicit("plain_implicit_step", plain_implicit_step<Dim, Scalar>);
                    add_implicit("implicit_step", implicit_step<Dim, Scalar>);
                    add_implicit("implicit_step_tight", implicit_step_tight<Dim, Scalar>);
                }
                if (springs >= 10000 && springs <= 100000) {
                    add_implicit("projective_step", projective_step<Dim, Scalar>);
                }
            }
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
