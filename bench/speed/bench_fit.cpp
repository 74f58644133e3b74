// SPDX-License-Identifier: BSD-3-Clause
// Nanoseconds per spring of the acceleration fit over 200 frames: assembly, one pass, a sweep, and the exact solution,
// each beside a plain hand-written baseline, the exact one also beside Ipopt. One thread.

#include <map>
#include <memory>
#include <numbers>

#include <springfit/fit/acceleration_objective.hpp>
#include <springfit/fit/dominant_term.hpp>
#include <springfit/fit/exact.hpp>
#include <springfit/network/forces.hpp>
#ifdef SPRINGFIT_BENCH_IPOPT
#include <springfit/ipopt/exact.hpp>
#endif

#include "bodies.hpp"
#include "plain_fit.hpp"

namespace {

using namespace springfit;

/// What the springs are fitted to.
enum class Excitation {
    rich, ///< twelve waves of about the body's size, and accelerations with three times their size in noise: 13 % of
          ///< the springs end on their bound
    poor ///< two longer waves, and a tenth in noise: hardly anything tells one spring from the next
};

/// 200 frames of smooth motion with the network's own accelerations and noise.
template <int Dim, class Scalar>
Motion<Dim, Scalar> smooth_motion(const SpringNetwork<Dim, Scalar>& network, Excitation excitation) {
    const bool rich = excitation == Excitation::rich;
    std::mt19937 random(3);
    std::normal_distribution<Scalar> normal;
    const auto vector = [&] {
        Vector<Dim, Scalar> v;
        for (int d = 0; d < Dim; ++d) {
            v(d) = normal(random);
        }
        return v;
    };
    struct Wave {
        Vector<Dim, Scalar> direction, wave_vector;
        Scalar frequency, phase;
    };
    std::vector<Wave> waves;
    for (int w = 0; w < (rich ? 12 : 2); ++w) {
        waves.push_back({Scalar(0.02) * vector(), Scalar(rich ? 4 : 1) * vector(), 1 + normal(random), normal(random)});
    }
    Motion<Dim, Scalar> motion;
    motion.rest_positions = network.rest_positions;
    const Points<Dim, Scalar> zero = Points<Dim, Scalar>::Zero(Dim, network.n_nodes());
    for (int t = 0; t < 200; ++t) {
        const Scalar time = Scalar(0.05) * static_cast<Scalar>(t);
        Points<Dim, Scalar> x = network.rest_positions;
        Points<Dim, Scalar> v = zero;
        for (const Wave& wave : waves) {
            for (Index i = 0; i < x.cols(); ++i) {
                const Scalar angle =
                    wave.wave_vector.dot(network.rest_positions.col(i)) + wave.frequency * time + wave.phase;
                x.col(i) += std::sin(angle) * wave.direction;
                v.col(i) += wave.frequency * std::cos(angle) * wave.direction;
            }
        }
        Points<Dim, Scalar> a;
        compute_accelerations<Dim, Scalar>(network, x, v, zero, a);
        const Scalar noise = Scalar(rich ? 3 : 0.1) * a.norm() / std::sqrt(static_cast<Scalar>(a.size()));
        for (Index i = 0; i < a.cols(); ++i) {
            a.col(i) += noise * vector();
        }
        motion.times.push_back(time);
        motion.positions.push_back(x);
        motion.velocities.push_back(v);
        motion.accelerations.push_back(a);
        motion.external_forces.push_back(zero);
    }
    return motion;
}

template <int Dim, class Scalar>
struct Data {
    SpringNetwork<Dim, Scalar> network;
    Motion<Dim, Scalar> motion;
    FitProblem problem;
    SparseMatrix<double> hessian; // both triangles
};

/// The data of one size, made once and kept while that size is measured.
template <int Dim, class Scalar>
const Data<Dim, Scalar>& data(Index springs, Excitation excitation = Excitation::rich) {
    static std::map<std::pair<Index, Excitation>, std::unique_ptr<Data<Dim, Scalar>>> kept;
    const std::pair key(springs, excitation);
    if (!kept.contains(key)) {
        kept.clear();
        auto made = std::make_unique<Data<Dim, Scalar>>();
        made->network = bench::network<Dim, Scalar>(springs);
        made->motion = smooth_motion(made->network, excitation);
        auto start = made->network;
        start.stiffness.setConstant(1000);
        made->problem = acceleration_problem<Dim, Scalar>(start, {made->motion});
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

template <int Dim, class Scalar, Excitation excitation>
void exact(benchmark::State& state, Index springs) {
    const auto& d = data<Dim, Scalar>(springs, excitation);
    FitReport report;
    for (auto _ : state) {
        report = springfit::exact(d.problem);
    }
    bench::count(state, d.network.n_springs());
    state.counters["kkt"] = report.kkt_residual;
    state.counters["products"] = report.products;
    state.counters["factorisations"] = report.factorisations;
}

#ifdef SPRINGFIT_BENCH_IPOPT
template <int Dim, class Scalar, Excitation excitation>
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
        add_one("exact", exact<Dim, Scalar, Excitation::rich>);
        add_one("plain_exact", plain_exact<Dim, Scalar>);
#ifdef SPRINGFIT_BENCH_IPOPT
        if (springs <= 10000) { // minutes beyond
            add_one("ipopt", by_ipopt<Dim, Scalar, Excitation::rich>);
        }
#endif
        add_one("exact_poor", exact<Dim, Scalar, Excitation::poor>);
#ifdef SPRINGFIT_BENCH_IPOPT
        if (springs <= 10000) {
            add_one("ipopt_poor", by_ipopt<Dim, Scalar, Excitation::poor>);
        }
#endif
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
