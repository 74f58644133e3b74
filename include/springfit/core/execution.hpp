// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <functional>
#include <utility>

#include <springfit/core/types.hpp>

namespace springfit {

/// Runs independent chunks of work, one after another by default; `parallel/tbb.hpp` supplies one that uses threads.
///
/// Chunk bounds depend on the amount of work alone, never on the number of threads, so an algorithm that keeps one
/// partial result per chunk and adds them in chunk order gives the same bits on any number of threads.
class Execution {
public:
    using Chunk = std::function<void(Index chunk)>;
    using Runner = std::function<void(Index n_chunks, const Chunk& body)>;

    /// One chunk after another on the calling thread.
    Execution() = default;

    /// `runner(n, body)` must call `body(c)` once for each c in [0, n), in any order, and return when all are done.
    explicit Execution(Runner runner) : m_runner(std::move(runner)) {}

    [[nodiscard]] static Index n_chunks(Index n, Index chunk_size) { return (n + chunk_size - 1) / chunk_size; }

    /// Calls `body(chunk, begin, end)` for consecutive ranges of at most `chunk_size` items that cover [0, n).
    template <class Body>
    void for_chunks(Index n, Index chunk_size, const Body& body) const {
        const Index chunks = n_chunks(n, chunk_size);
        const auto run_chunk = [&](Index chunk) {
            const Index begin = chunk * chunk_size;
            body(chunk, begin, std::min(n, begin + chunk_size));
        };
        if (m_runner && chunks > 1) {
            m_runner(chunks, run_chunk);
        } else {
            for (Index chunk = 0; chunk < chunks; ++chunk) {
                run_chunk(chunk);
            }
        }
    }

private:
    Runner m_runner;
};

} // namespace springfit
