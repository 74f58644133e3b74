// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <thread>
#include <vector>

#include <springfit/core/execution.hpp>

namespace springfit::test {

/// Threads that share the chunks of a loop out among themselves, the last one first. What they do to each other's data
/// a thread sanitizer sees, unlike within a library that is not built with it.
[[nodiscard]] inline Execution backwards_on_threads(int threads = 3) {
    return Execution([threads](Index n_chunks, const Execution::Chunk& body) {
        std::atomic<Index> left{n_chunks};
        const auto work = [&] {
            for (Index chunk = --left; chunk >= 0; chunk = --left) {
                body(chunk);
            }
        };
        std::vector<std::thread> others;
        for (int t = 1; t < threads; ++t) {
            others.emplace_back(work);
        }
        work();
        for (std::thread& other : others) {
            other.join();
        }
    });
}

} // namespace springfit::test
