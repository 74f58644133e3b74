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
    CHECK(chosen({0.1, 0.2}, Method::exact) == 0); // no fit came about
    CHECK(chosen({0.2, 0.1}, Method::closed_form) == 1);
    CHECK(choose(candidates({0.1})).rule == ChoiceRule::least_held_out_error);
    CHECK_THROWS_AS((void)choose(candidates({})), InvalidArgument);
}

TEST_CASE("among near equals the one with fewer springs and cells is chosen") {
    auto all = candidates({0.10, 0.11, 0.105, 0.125});
    const auto set_springs = [&](std::size_t c, Index n) { all[c].network.springs.resize(2, n); };
    set_springs(0, 30);
    set_springs(1, 20);
    set_springs(2, 20);
    set_springs(3, 10); // too far from the best
    CHECK(choose(all).candidate == 2);
    CalibrateOptions options;
    options.near_equal = 1;
    CHECK(choose(all, options).candidate == 0);
    options.near_equal = 1.3;
    CHECK(choose(all, options).candidate == 3);
    all[3].network.cells.resize(3, 25); // cells cost, too
    CHECK(choose(all, options).candidate == 2);
    options.near_equal = 0.9;
    CHECK_THROWS_AS((void)choose(all, options), InvalidArgument);
}

TEST_CASE("where a method is named, the best of its fits is chosen, whatever the closed forms do") {
    auto all = candidates({0.1, 0.5, 0.05, 0.3});
    all[1].trajectory.emplace();
    all[3].trajectory.emplace();
    CalibrateOptions options;
    options.method = Method::trajectory;
    const Choice choice = choose(all, options);
    CHECK(choice.candidate == 3);
    CHECK(choice.rule == ChoiceRule::asked_for);
}

TEST_CASE("the verdict goes by the held-out error, and no network that fails is good") {
    const auto verdict = [](double error, std::size_t failures = 0) {
        CaseScores scores;
        scores.error = error;
        scores.statuses.assign(3, Status::converged);
        std::fill_n(scores.statuses.begin(), failures, Status::diverged);
        CHECK(scores.n_failed() == failures);
        return verdict_on(scores);
    };
    CHECK(verdict(0) == Verdict::good);
    CHECK(verdict(0.0999) == Verdict::good);
    CHECK(verdict(0.1) == Verdict::fair);
    CHECK(verdict(0.05, 1) == Verdict::fair);
    CHECK(verdict(0.2499) == Verdict::fair);
    CHECK(verdict(0.25) == Verdict::poor);
    CHECK(verdict(0.3, 1) == Verdict::poor);
    CHECK(verdict(0.6) == Verdict::unusable);
    CHECK(verdict(infinity) == Verdict::unusable);
    CHECK(verdict(std::nan("")) == Verdict::unusable);
    CHECK(is_usable(Verdict::fair));
    CHECK_FALSE(is_usable(Verdict::poor));
    CHECK_FALSE(is_usable(Verdict::unfinished));
}

TEST_CASE("warnings are data") {
    auto all = candidates({0.1, 0.1});
    CHECK(warnings_on(all[0]).empty());
    all[0].n_clamped = 3;
    all[1].acceleration.emplace();
    all[1].acceleration->not_identified.resize(2);
    all[1].relative_stiffness = 0.5;
    auto warnings = warnings_on(all[0]);
    REQUIRE(warnings.size() == 1);
    const auto others = warnings_on(all[1]);
    REQUIRE(others.size() == 2);
    warnings.insert(warnings.end(), others.begin(), others.end());
    CHECK(warnings[0].code == WarningCode::negative_set_to_zero);
    CHECK(warnings[0].values == std::vector<std::pair<std::string, double>>{{"springs", 3.}});
    CHECK(warnings[1].code == WarningCode::softer_than_closed_form);
    CHECK(warnings[2].code == WarningCode::not_excited);
    for (const auto& warning : warnings) {
        CHECK(to_string(warning).find(warning.message) == 0);
        CHECK(warning.about == "candidate");
    }
}
