// SPDX-License-Identifier: BSD-3-Clause
// Milliseconds of what the matching of motion spends its time on: sparse factors of a network's stiffness and their
// solves for sixteen cases, CHOLMOD's beside Eigen's, and whole iterations of Gauss-Newton. One thread.

#include <map>
#include <memory>

#include <springfit/fit/trajectory/gauss_newton.hpp>
#include <springfit/simulate/equilibrium.hpp>
#include <springfit/solve/sparse_cholesky.hpp>
#ifdef SPRINGFIT_BENCH_CHOLMOD
#include <springfit/cholmod/supernodal_factor.hpp>
#endif

#include "bodies.hpp"
#include "run.hpp"

namespace {

using namespace springfit;

constexpr int n_cases = 16;

std::vector<int> held_face(const SpringNetwork<3, double>& network) {
    std::vector<int> nodes;
    for (int i = 0; i < network.n_nodes(); ++i) {
        if (network.rest_positions(0, i) < 1e-9) {
            nodes.push_back(i);
        }
    }
    return nodes;
}

/// Its stiffness at rest, one face held, with a little on the diagonal.
SparseMatrix<double> stiffness(const SpringNetwork<3, double>& network) {
    const FreeNodes free(network.n_nodes(), held_face(network));
    auto matrix = network_matrix(network, free);
    add_stiffness<3, double>(network, network.rest_positions, HessianForm::exact, matrix);
    const double small = 1e-6 * matrix.matrix().diagonal().maxCoeff();
    for (Index f = 0; f < free.n_free(); ++f) {
        matrix.add_diagonal(f, small);
    }
    return matrix.matrix();
}

void factor(benchmark::State& state, Index springs, MakeSparseFactor make) {
    const auto network = bench::network<3, double>(springs);
    const SparseMatrix<double> lower = stiffness(network);
    SparseCholesky cholesky(make());
    cholesky.analyse(lower, 3);
    for (auto _ : state) {
        if (!cholesky.factorise(lower, 1e-12, 3)) {
            state.SkipWithError("not positive definite");
            return;
        }
    }
    bench::count(state, network.n_springs());
    state.counters["entries_per_spring"] = cholesky.n_entries() / static_cast<double>(network.n_springs());
}

void solves(benchmark::State& state, Index springs, MakeSparseFactor make) {
    const auto network = bench::network<3, double>(springs);
    const SparseMatrix<double> lower = stiffness(network);
    SparseCholesky cholesky(make());
    if (!cholesky.factorise(lower, 1e-12, 3)) {
        state.SkipWithError("not positive definite");
        return;
    }
    SparseCholesky::Rows<n_cases> rows(lower.cols(), n_cases);
    rows.setRandom();
    for (auto _ : state) {
        cholesky.substitute<n_cases>(rows);
        rows *= 1 / rows.cwiseAbs().maxCoeff(); // stays in the range of numbers
    }
    bench::count(state, network.n_springs());
}

/// Static cases of a network under its own weight in different directions, strains of some percent.
std::vector<Motion<3, double>> static_cases(const SpringNetwork<3, double>& network) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    std::vector<Motion<3, double>> motions;
    for (int c = 0; c < n_cases; ++c) {
        const Vector<3, double> direction =
            Vector<3, double>(normal(random), normal(random), normal(random)).normalized();
        Motion<3, double> motion;
        motion.name = "case " + std::to_string(c);
        motion.rest_positions = network.rest_positions;
        motion.clamped = held_face(network);
        Scenario<3, double> scenario;
        scenario.clamps.push_back({motion.clamped, {}});
        NodalLoad<3, double> load;
        load.forces = 0.3 * direction * network.mass.transpose();
        for (int i = 0; i < network.n_nodes(); ++i) {
            load.nodes.push_back(i);
        }
        scenario.loads.push_back(load);
        motion.times = {0};
        motion.positions = {equilibrium(network, scenario).positions};
        motion.velocities = {Points<3, double>::Zero(3, network.n_nodes())};
        motion.accelerations = motion.velocities;
        motion.external_forces = {load.forces};
        motions.push_back(std::move(motion));
    }
    return motions;
}

/// Three iterations from equal stiffness on.
void match(benchmark::State& state, Index springs) {
    auto network = bench::network<3, double>(springs);
    const auto motions = static_cases(network);
    network.stiffness = network.rest_length * (network.stiffness.sum() / network.rest_length.sum());
    const TrajectoryProblem<3> problem(network, motions);
    TrajectoryReport report;
    for (auto _ : state) {
        report = gauss_newton(problem, {.max_iterations = 3});
    }
    bench::count(state, network.n_springs());
    state.counters["misfit_start"] = report.misfit_start;
    state.counters["misfit"] = report.misfit;
}

} // namespace

int main(int argc, char** argv) {
#ifdef SPRINGFIT_BENCH_CHOLMOD
    cholmod::use_supernodal_factors();
#endif
    const auto add_one = [](const char* what, auto function, Index springs, auto... how) {
        benchmark::RegisterBenchmark(bench::name<3, double>(what, springs).c_str(), function, springs, how...)
            ->Unit(benchmark::kMillisecond);
    };
    for (Index springs : {1000, 10000, 100000}) {
#ifdef SPRINGFIT_BENCH_CHOLMOD
        add_one("supernodal_factor", factor, springs, cholmod::supernodal_factor);
        add_one("supernodal_solves", solves, springs, cholmod::supernodal_factor);
#endif
        if (springs <= 10000) { // a minute beyond
            add_one("simplicial_factor", factor, springs, simplicial_factor<double>);
            add_one("simplicial_solves", solves, springs, simplicial_factor<double>);
            add_one("match", match, springs);
        }
    }
    return bench::run(argc, argv);
}
