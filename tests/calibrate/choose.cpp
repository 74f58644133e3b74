// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/calibrate/choose.hpp>

using namespace springfit;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<Candidate<2>> candidates(const std::vector<double>& errors) {
    std::vector<Candidate<2>> all;
    for (double error : errors) {
        all.push_back({.name = "candidate", .network = {}});
        all.back().held_out.error = error;
    }
    return all;
}

std::size_t chosen(const std::vector<double>& errors, Method method = Method::automatic) {
    CalibrateOptions options;
    options.method = method;
    return choose(candidates(errors), options).candidate;
}

} // namespace

TEST_CASE("the least held-out error is chosen, the first of equals, never one that is not a number") {
    CHECK(chosen({0.3, 0.1, 0.2}) == 1);
    CHECK(chosen({0.3, 0.3, infinity}) == 0);
    CHECK(chosen({infinity, 0.9}) == 1);
    CHECK(chosen({0.5, std::nan(""), 0.4}) == 2);
    CHECK(chosen({infinity, infinity}) == 0);
    CHECK(chosen({0.1, 0.2}, Method::exact) == 1);
    CHECK(chosen({0.2, 0.1}, Method::closed_form) == 1);
    CHECK(choose(candidates({0.1})).rule == ChoiceRule::least_held_out_error);
    CHECK_THROWS_AS((void)choose(candidates({})), InvalidArgument);
}

TEST_CASE("the verdict goes by the held-out error") {
    CHECK(verdict_on(0) == Verdict::good);
    CHECK(verdict_on(0.2499) == Verdict::good);
    CHECK(verdict_on(0.25) == Verdict::poor);
    CHECK(verdict_on(1e9) == Verdict::poor);
    CHECK(verdict_on(infinity) == Verdict::unusable);
    CHECK(verdict_on(std::nan("")) == Verdict::unusable);
}

TEST_CASE("warnings are data") {
    auto all = candidates({0.1, 0.1});
    CHECK(warnings_on(all).empty());
    all[0].n_clamped = 3;
    all[1].acceleration.emplace();
    all[1].acceleration->not_identified.resize(2);
    all[1].relative_stiffness = 0.5;
    const auto warnings = warnings_on(all);
    REQUIRE(warnings.size() == 3);
    CHECK(warnings[0].code == WarningCode::negative_set_to_zero);
    CHECK(warnings[0].values == std::vector<std::pair<std::string, double>>{{"springs", 3.}});
    CHECK(warnings[1].code == WarningCode::softer_than_closed_form);
    CHECK(warnings[2].code == WarningCode::not_excited);
    for (const auto& warning : warnings) {
        CHECK(to_string(warning).find(warning.message) == 0);
        CHECK(warning.about == "candidate");
    }
}
