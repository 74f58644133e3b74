// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <benchmark/benchmark.h>

namespace bench {

/// Runs what is registered, with the compiler and its flags written into the head of the output.
inline int run(int argc, char** argv) {
#ifdef SPRINGFIT_BENCH_FLAGS
    benchmark::AddCustomContext("compiler", SPRINGFIT_BENCH_COMPILER);
    benchmark::AddCustomContext("flags", SPRINGFIT_BENCH_FLAGS);
#endif
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
        return 1;
    }
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}

} // namespace bench
