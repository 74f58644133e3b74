// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <limits>

#include <springfit/core/error.hpp>
#include <springfit/core/maximum.hpp>
#include <springfit/core/status.hpp>

using namespace springfit;

TEST_CASE("an error names the thing, what was expected and what was found") {
    const InvalidArgument error("poisson", "a value in (-1, 0.5)", "0.5");
    CHECK(std::string(error.what()) == "poisson: expected a value in (-1, 0.5), found 0.5");
    CHECK(error.argument() == "poisson");
    CHECK(std::string(FileError("a.off", 12, "three coordinates expected").what()) ==
          "a.off:12: three coordinates expected");
}

TEST_CASE("a condition in accept form refuses NaN") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(require(nan > 0, "young", "a positive value", nan), InvalidArgument);
    CHECK_NOTHROW(require(1.0 > 0, "young", "a positive value", 1.0));
}

TEST_CASE("a largest value keeps NaN, wherever it is") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(maximum(1., 2.) == 2);
    CHECK(maximum(2., 1.) == 2);
    CHECK(std::isnan(maximum(1., nan)));
    CHECK(std::isnan(maximum(nan, 1.)));
    CHECK(max_norm(Values<double>()) == 0);
    for (Index n = 1; n < 20; ++n) { // longer and shorter than the vectors of any processor
        Values<double> values = -Values<double>::LinSpaced(n, 1, 2);
        CHECK(max_norm(values) == -values.minCoeff());
        for (Index i = 0; i < n; ++i) {
            Values<double> with = values;
            with(i) = nan;
            CHECK(std::isnan(max_norm(with)));
            CHECK(std::isnan(max_norm(with.cast<float>())));
        }
    }
}

TEST_CASE("only diverged and failed results are unusable") {
    for (Status status : {Status::converged, Status::iteration_limit, Status::stalled, Status::interrupted}) {
        CHECK(usable(status));
    }
    CHECK_FALSE(usable(Status::diverged));
    CHECK_FALSE(usable(Status::failed));
}
