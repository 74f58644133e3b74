// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <atomic>

#include <springfit/parallel/tbb.hpp>

using namespace springfit;

TEST_CASE("a sum by chunks has the same bits on any number of threads") {
    const auto sum = [](const Execution& execution) {
        const Index n = 100000;
        std::vector<double> partial(static_cast<std::size_t>(Execution::n_chunks(n, 1000)), 0.0);
        execution.for_chunks(n, 1000, [&](Index chunk, Index begin, Index end) {
            for (Index i = begin; i < end; ++i) {
                partial[static_cast<std::size_t>(chunk)] += 1.0 / static_cast<double>(i + 1);
            }
        });
        double total = 0;
        for (double p : partial) {
            total += p;
        }
        return total;
    };
    const double serial = sum(Execution());
    for (int threads : {0, 1, 2, 3}) {
        CHECK(sum(parallel::tbb(threads)) == serial);
    }
}

TEST_CASE("an exception thrown in a chunk reaches the caller") {
    CHECK_THROWS_AS(parallel::tbb(2).for_chunks(10, 1,
                                                [](Index chunk, Index, Index) {
                                                    require(chunk != 7, "chunk", "any but 7", chunk);
                                                }),
                    InvalidArgument);
}

TEST_CASE("a negative number of threads is refused") { CHECK_THROWS_AS((void)parallel::tbb(-1), InvalidArgument); }
