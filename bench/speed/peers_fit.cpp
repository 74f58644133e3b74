// SPDX-License-Identifier: BSD-3-Clause
// The bounded quadratic of the acceleration fit, assembled from 200 frames so noisy that an eighth of the springs end
// on their bound, solved by springfit, by a plain solver and by other programs that are installed. Each begins at the
// prior and is to reach a residual of 1e-9; `kkt` is what it reached.

#include <map>
#include <memory>
#include <stdexcept>

#include <springfit/fit/acceleration/exact.hpp>
#ifdef SPRINGFIT_BENCH_IPOPT
#include <springfit/ipopt/exact.hpp>
#endif

#include "bodies.hpp"
#include "motions.hpp"
#include "peers/peers.hpp"
#include "plain_fit.hpp"
#include "run.hpp"

namespace {

using namespace springfit;

constexpr double residual = 1e-9;

struct Data {
    AccelerationProblem problem;
    SparseMatrix<double> hessian; ///< both triangles
    bench::peers::ScaledProblem scaled;

    explicit Data(AccelerationProblem made)
        : problem(std::move(made)), hessian(problem.objective.hessian().selfadjointView<Eigen::Lower>()),
          scaled(problem, residual) {}
};

/// The data of one size, made once and kept while that size is measured.
const Data& data(Index springs) {
    static std::map<Index, std::unique_ptr<Data>> kept;
    auto& entry = kept[springs];
    if (!entry) {
        kept.clear();
        const auto network = bench::network<3, double>(springs);
        auto made =
            std::make_unique<Data>(bench::fit_problem(network, bench::smooth_motion(network, bench::Excitation::rich)));
        return *(kept[springs] = std::move(made));
    }
    return *entry;
}

/// Registers a solver: `solve(data)` returns a `Solution`; where that has `seconds`, they are what counts.
template <class Solve>
auto* add(const char* what, Index springs, Solve solve) {
    return benchmark::RegisterBenchmark(
               bench::name<3, double>(what, springs).c_str(),
               [solve](benchmark::State& state, Index n) {
                   const Data& d = data(n);
                   bench::peers::Solution solution;
                   for (auto _ : state) {
                       try {
                           solution = solve(d);
                       } catch (const std::exception& error) {
                           state.SkipWithError(error.what());
                           return;
                       }
                       state.SetIterationTime(solution.seconds);
                   }
                   bench::count(state, d.problem.n_unknowns());
                   state.counters["kkt"] = kkt_residual(d.problem, solution.theta);
                   const auto active = solution.theta.array() <= d.problem.lower.array() ||
                                       solution.theta.array() >= d.problem.upper.array();
                   state.counters["active"] = static_cast<double>(active.count()) / static_cast<double>(active.size());
               },
               springs)
        ->Unit(benchmark::kMillisecond);
}

/// Projected Gauss-Seidel in theta itself until the residual is small.
bench::peers::Solution plain_exact(const Data& d) {
    const Values<double> linear = d.problem.objective.linear();
    bench::peers::Solution solution{d.problem.prior};
    for (int block = 0; block < 200; ++block) {
        plain::gauss_seidel(d.hessian, linear, solution.theta, 10);
        if (kkt_residual(d.problem, solution.theta) <= residual) {
            break;
        }
    }
    return solution;
}

void add_size(Index springs) {
    add("exact", springs, [](const Data& d) {
        return bench::peers::Solution{springfit::exact(d.problem, {.tolerance = residual}).theta};
    });
    add("plain_exact", springs, plain_exact);
#ifdef SPRINGFIT_BENCH_IPOPT
    if (springs <= 10000) {
        add("ipopt", springs, [](const Data& d) { return bench::peers::Solution{ipopt::exact(d.problem).theta}; });
    }
#endif
#ifdef SPRINGFIT_BENCH_PETSC
    for (const char* method : {"bnls", "bntr", "gpcg"}) {
        add((std::string("tao_") + method).c_str(), springs,
            [method](const Data& d) { return bench::peers::tao(d.scaled, method); });
    }
#endif
#ifdef SPRINGFIT_BENCH_SCIPY
    add("scipy_lbfgsb", springs, [](const Data& d) { return bench::peers::scipy(d.scaled); })
        ->UseManualTime()
        ->Iterations(1);
#endif
}

} // namespace

int main(int argc, char** argv) {
#ifdef SPRINGFIT_BENCH_PETSC
    const bench::peers::Petsc petsc;
#endif
    for (Index springs : {10000, 100000}) {
        add_size(springs);
    }
    return bench::run(argc, argv);
}
