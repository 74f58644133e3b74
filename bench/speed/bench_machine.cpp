// SPDX-License-Identifier: BSD-3-Clause
// What one core of the machine can do: bytes per second by the size of the arrays, operations per second.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "run.hpp"

namespace {

/// Each number of one array, times a constant, to another; both together have this many MiB. Counts what the loop reads
/// and writes, not that a cache fetches a line before it is written.
void copy_bandwidth(benchmark::State& state, double mebibytes) {
    const auto n = static_cast<std::size_t>(mebibytes * 1024 * 1024 / (2 * sizeof(double)));
    std::vector<double> from(n, 1.5);
    std::vector<double> to(n, 0);
    for (auto _ : state) {
        for (std::size_t i = 0; i < n; ++i) {
            to[i] = 1.25 * from[i]; // not a plain copy, for which there are special instructions
        }
        benchmark::DoNotOptimize(to.data());
        benchmark::ClobberMemory();
    }
    const auto moved = static_cast<double>(state.iterations()) * 2 * static_cast<double>(n * sizeof(double));
    state.counters["bytes_per_second"] = benchmark::Counter(moved, benchmark::Counter::kIsRate);
}

/// Products and sums of numbers in registers, in chains enough to keep every unit busy.
template <class Scalar>
void multiply_add_peak(benchmark::State& state) {
    constexpr std::size_t bytes = 64 * 12; // twelve of the widest registers
    constexpr std::size_t n = bytes / sizeof(Scalar);
    constexpr int rounds = 1000;
    std::array<Scalar, n> values{};
    Scalar factor = Scalar(0.5);
    Scalar term = Scalar(0.25);
    benchmark::DoNotOptimize(factor);
    benchmark::DoNotOptimize(term);
    for (auto _ : state) {
        auto local = values;
        for (int round = 0; round < rounds; ++round) {
            for (Scalar& value : local) {
                value = value * factor + term;
            }
        }
        benchmark::DoNotOptimize(local.data());
        values = local;
    }
    state.counters["operations_per_second"] = benchmark::Counter(
        static_cast<double>(state.iterations()) * 2 * rounds * static_cast<double>(n), benchmark::Counter::kIsRate);
}

} // namespace

int main(int argc, char** argv) {
    for (const char* mebibytes : {"0.03125", "0.5", "2", "8", "64", "512"}) {
        benchmark::RegisterBenchmark((std::string("copy_bandwidth/") + mebibytes).c_str(), copy_bandwidth,
                                     std::stod(mebibytes));
    }
    benchmark::RegisterBenchmark("multiply_add_peak/float", multiply_add_peak<float>);
    benchmark::RegisterBenchmark("multiply_add_peak/double", multiply_add_peak<double>);
    return bench::run(argc, argv);
}
