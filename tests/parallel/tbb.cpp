// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <atomic>

#include <springfit/body/spring_batch.hpp>
#include <springfit/body/spring_body.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/network/builders.hpp>
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
    CHECK_THROWS_AS(parallel::tbb(2).for_chunks(
                        10, 1, [](Index chunk, Index, Index) { require(chunk != 7, "chunk", "any but 7", chunk); }),
                    InvalidArgument);
}

TEST_CASE("a negative number of threads is refused") {
    CHECK_THROWS_AS((void)parallel::tbb(-1), InvalidArgument);
}

TEST_CASE("bodies step with the same bits on any number of threads") {
    const auto mesh = tetrahedron_grid<double>({32, 32, 32}, {1., 1., 1.}); // two domains
    const auto network = [&] {
        auto springs = springs_along_edges(mesh);
        springs.stiffness.setConstant(100);
        springs.damping.setConstant(0.01);
        return springs;
    }();
    const Points<3, double> zero = Points<3, double>::Zero(3, network.n_nodes());
    const auto stepped = [&](const Execution& execution) {
        SpringBody<3, double> body(network, execution);
        body.write(1.02 * network.rest_positions, zero);
        for (int s = 0; s < 3; ++s) {
            body.step(1e-4);
        }
        Points<3, double> positions, velocities;
        body.read(positions, velocities);
        return positions;
    };
    const auto batched = [&](const Execution& execution) {
        SpringBatch<3, double> batch(network, 9, execution);
        batch.write(8, 1.02 * network.rest_positions, zero);
        for (int s = 0; s < 3; ++s) {
            batch.step(1e-4);
        }
        Points<3, double> positions, velocities;
        batch.read(8, positions, velocities);
        return positions;
    };
    const Points<3, double> alone = stepped({});
    const Points<3, double> one_by_one = batched({});
    for (int threads : {1, 2, 3}) {
        CHECK(stepped(parallel::tbb(threads)) == alone);
        CHECK(batched(parallel::tbb(threads)) == one_by_one);
    }
}
