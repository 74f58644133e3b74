// SPDX-License-Identifier: BSD-3-Clause
// Nanoseconds per spring of the acceleration fit over 200 frames: assembly, one pass, a sweep, and the exact solution,
// each beside a plain hand-written baseline, the exact one also beside Ipopt. One thread.

#include <sys/resource.h>

#include <map>
#include <memory>

#include <springfit/fit/acceleration/dominant_term.hpp>
#include <springfit/fit/acceleration/exact.hpp>
#include <springfit/fit/acceleration/objective.hpp>
#ifdef SPRINGFIT_BENCH_CHOLMOD
#include <springfit/cholmod/supernodal_factor.hpp>
#endif
#ifdef SPRINGFIT_BENCH_IPOPT
#include <springfit/ipopt/exact.hpp>
#endif

#include "bodies.hpp"
#include "motions.hpp"
#include "plain_fit.hpp"
#include "run.hpp"

namespace {

using namespace springfit;

template <int Dim, class Scalar>
struct Data {
    SpringNetwork<Dim, Scalar> network;
    Motion<Dim, Scalar> motion;
    AccelerationProblem problem;
    SparseMatrix<double> hessian; // both triangles
};

/// The data of one size, made once and kept while that size is measured.
template <int Dim, class Scalar>
const Data<Dim, Scalar>& data(Index springs, bench::Excitation excitation = bench::Excitation::rich) {
    static std::map<std::pair<Index, bench::Excitation>, std::unique_ptr<Data<Dim, Scalar>>> kept;
    const std::pair key(springs, excitation);
    if (!kept.contains(key)) {
        kept.clear();
        auto made = std::make_unique<Data<Dim, Scalar>>();
        made->network = bench::network<Dim, Scalar>(springs);
        made->motion = bench::smooth_motion(made->network, excitation);
        made->problem = bench::fit_problem(made->network, made->motion);
        made->hessian = made->problem.objective.hessian().template selfadjointView<Eigen::Lower>();
        kept[key] = std::move(made);
    }
    return *kept[key];
}

template <int Dim, class Scalar>
void assembly(benchmark::State& state, Index springs) {
    const auto& d = data<Dim, Scalar>(springs);
    for (auto _ : state) {
        benchmark::DoNotOptimize(acceleration_problem<Dim, Scalar>(d.network, {d.motion}).n_unknowns());
    }
    bench::count(state, d.network.n_springs());
}

template <int Dim, class Scalar>
void plain_assembly(benchmark::State& state, Index springs) {
    const auto& d = data<Dim, Scalar>(springs);
    for (auto _ : state) {
        const plain::NormalEquations<Dim, Scalar> equations(d.network, d.motion);
        benchmark::DoNotOptimize(equations.gradient.data());
    }
    bench::count(state, d.network.n_springs());
}

template <int Dim, class Scalar>
void one_pass(benchmark::State& state, Index springs) {
    const auto& d = data<Dim, Scalar>(springs);
    for (auto _ : state) {
        benchmark::DoNotOptimize(springfit::one_pass(d.problem).objective);
    }
    bench::count(state, d.network.n_springs());
}

template <int Dim, class Scalar>
void plain_one_pass(benchmark::State& state, Index springs) {
    const auto& d = data<Dim, Scalar>(springs);
    for (auto _ : state) {
        benchmark::DoNotOptimize(plain::one_pass(d.problem).data());
    }
    bench::count(state, d.network.n_springs());
}

template <int Dim, class Scalar>
void sweep(benchmark::State& state, Index springs) {
    const auto& d = data<Dim, Scalar>(springs);
    for (auto _ : state) {
        benchmark::DoNotOptimize(dominant_term(d.problem, {.max_sweeps = 1, .start = SweepStart::given}).objective);
    }
    bench::count(state, d.network.n_springs());
}

template <int Dim, class Scalar>
void plain_sweep(benchmark::State& state, Index springs) {
    const auto& d = data<Dim, Scalar>(springs);
    const Values<double> linear = d.problem.objective.linear();
    for (auto _ : state) {
        Values<double> theta = d.problem.prior;
        plain::gauss_seidel(d.hessian, linear, theta, 1);
        benchmark::DoNotOptimize(theta.data());
    }
    bench::count(state, d.network.n_springs());
}

template <int Dim, class Scalar, bench::Excitation excitation>
void exact(benchmark::State& state, Index springs) {
    const auto& d = data<Dim, Scalar>(springs, excitation);
    AccelerationReport report;
    for (auto _ : state) {
        report = springfit::exact(d.problem);
    }
    bench::count(state, d.network.n_springs());
    state.counters["kkt"] = report.kkt_residual;
    state.counters["products"] = report.products;
    state.counters["factorisations"] = report.factorisations;
}

#ifdef SPRINGFIT_BENCH_IPOPT
template <int Dim, class Scalar, bench::Excitation excitation>
void by_ipopt(benchmark::State& state, Index springs) {
    const auto& d = data<Dim, Scalar>(springs, excitation);
    double residual = 0;
    for (auto _ : state) {
        residual = ipopt::exact(d.problem).kkt_residual;
    }
    bench::count(state, d.network.n_springs());
    state.counters["kkt"] = residual;
}
#endif

/// Projected Gauss-Seidel until the KKT residual is 1e-9 or 2000 sweeps are spent.
template <int Dim, class Scalar>
void plain_exact(benchmark::State& state, Index springs) {
    const auto& d = data<Dim, Scalar>(springs);
    const Values<double> linear = d.problem.objective.linear();
    double residual = 0;
    for (auto _ : state) {
        Values<double> theta = d.problem.prior;
        for (int block = 0; block < 200; ++block) {
            plain::gauss_seidel(d.hessian, linear, theta, 10);
            residual = kkt_residual(d.problem, theta);
            if (residual <= 1e-9) {
                break;
            }
        }
    }
    bench::count(state, d.network.n_springs());
    state.counters["kkt"] = residual;
}

/// Assembly and exact fit of 200 rich frames that are made, taken in and forgotten one by one. Making them is not
/// timed.
template <int Dim, class Scalar>
void streamed_fit(benchmark::State& state, Index springs) {
    using Frame = Points<Dim, Scalar>;
    const auto network = bench::network<Dim, Scalar>(springs);
    auto start = network;
    start.stiffness.setConstant(Scalar(bench::start_stiffness));
    AccelerationReport report;
    for (auto _ : state) {
        bench::Waves<Dim, Scalar> waves(network, bench::Excitation::rich);
        AccelerationObjective<Dim, Scalar> objective(start);
        for (int t = 0; t < waves.n_frames; ++t) {
            state.PauseTiming();
            waves.next(t, [&](const Frame& x, const Frame& v, const Frame& a, const Frame& f) {
                state.ResumeTiming();
                objective.add_frame(x, v, a, f, {});
                state.PauseTiming();
            });
            state.ResumeTiming();
        }
        report = springfit::exact(std::move(objective).problem());
    }
    bench::count(state, network.n_springs());
    state.counters["kkt"] = report.kkt_residual;
    state.counters["products"] = report.products;
    state.counters["exact_seconds"] = report.seconds;
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    state.counters["peak_MiB"] = static_cast<double>(used.ru_maxrss) / 1024; // of the process so far
}

template <int Dim, class Scalar>
void add() {
    for (Index springs : {1000, 10000, 100000}) {
        const auto add_one = [&](const char* what, auto function) {
            benchmark::RegisterBenchmark(bench::name<Dim, Scalar>(what, springs).c_str(), function, springs)
                ->Unit(benchmark::kMillisecond);
        };
        add_one("assembly", assembly<Dim, Scalar>);
        add_one("plain_assembly", plain_assembly<Dim, Scalar>);
        add_one("one_pass", one_pass<Dim, Scalar>);
        add_one("plain_one_pass", plain_one_pass<Dim, Scalar>);
        add_one("sweep", sweep<Dim, Scalar>);
        add_one("plain_sweep", plain_sweep<Dim, Scalar>);
        add_one("exact", exact<Dim, Scalar, bench::Excitation::rich>);
        add_one("plain_exact", plain_exact<Dim, Scalar>);
#ifdef SPRINGFIT_BENCH_IPOPT
        if (springs <= 10000) { // minutes beyond
            add_one("ipopt", by_ipopt<Dim, Scalar, bench::Excitation::rich>);
        }
#endif
        add_one("exact_poor", exact<Dim, Scalar, bench::Excitation::poor>);
#ifdef SPRINGFIT_BENCH_IPOPT
        if (springs <= 10000) {
            add_one("ipopt_poor", by_ipopt<Dim, Scalar, bench::Excitation::poor>);
        }
#endif
    }
}

} // namespace

int main(int argc, char** argv) {
#ifdef SPRINGFIT_BENCH_CHOLMOD
    cholmod::use_supernodal_factors();
#endif
    add<2, double>();
    add<3, float>();
    add<3, double>();
    for (Index springs : {10000, 100000, 1000000}) {
        benchmark::RegisterBenchmark(bench::name<3, double>("streamed_fit", springs).c_str(), streamed_fit<3, double>,
                                     springs)
            ->Unit(benchmark::kMillisecond)
            ->Iterations(1);
    }
    return bench::run(argc, argv);
}
