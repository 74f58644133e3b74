// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <springfit/core/error.hpp>
#include <springfit/core/execution.hpp>

namespace springfit::parallel {

/// Execution on `threads` threads of oneTBB; 0 means as many as the machine has.
/// Throws InvalidArgument where `threads` is negative.
[[nodiscard]] inline Execution tbb(int threads = 0) {
    require(threads >= 0, "threads", "0 (all) or a positive number", threads);
    constexpr int all = oneapi::tbb::task_arena::automatic;
    auto arena = std::make_shared<oneapi::tbb::task_arena>(threads == 0 ? all : threads);
    return Execution([arena](Index n_chunks, const Execution::Chunk& body) {
        arena->execute([&] { oneapi::tbb::parallel_for(Index{0}, n_chunks, body); });
    });
}

} // namespace springfit::parallel
