// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <springfit/core/execution.hpp>

using namespace springfit;

TEST_CASE("chunks cover every item once, in whatever order they run") {
    const Execution backwards([](Index n, const Execution::Chunk& body) {
        for (Index c = n - 1; c >= 0; --c) {
            body(c);
        }
    });
    for (const Execution& execution : {Execution(), backwards}) {
        for (Index n : {0, 1, 7, 8, 9, 64}) {
            std::vector<int> visits(static_cast<std::size_t>(n), 0);
            std::vector<int> chunks(static_cast<std::size_t>(Execution::n_chunks(n, 8)), 0);
            execution.for_chunks(n, 8, [&](Index chunk, Index begin, Index end) {
                ++chunks[static_cast<std::size_t>(chunk)];
                CHECK(end - begin <= 8);
                for (Index i = begin; i < end; ++i) {
                    ++visits[static_cast<std::size_t>(i)];
                }
            });
            for (int v : visits) {
                CHECK(v == 1);
            }
            for (int c : chunks) {
                CHECK(c == 1);
            }
        }
    }
}
