// SPDX-License-Identifier: BSD-3-Clause
#include "cases/specimens.hpp"
#include "threads.hpp"
#include "tolerance.hpp"

#include <springfit/springfit.hpp>

using namespace springfit;

namespace {

/// A network that others are fitted to, with stiffness that varies from spring to spring.
template <int Dim>
SpringNetwork<Dim, double> hidden() {
    auto network = test::small_network<Dim>();
    for (Index e = 0; e < network.n_springs(); ++e) {
        network.stiffness(e) *= 1 + 0.5 * std::sin(static_cast<double>(e));
    }
    network.damping = stiffness_proportional_damping(network, 0.3 * stable_step(network));
    return network;
}

/// Few and small cases, so that a test takes a moment.
template <int Dim>
RecordCasesOptions<Dim, double> few() {
    RecordCasesOptions<Dim, double> options;
    options.training_motions = 3;
    options.held_out_motions = 2;
    options.frames = 16;
    options.training_equilibria = 12;
    options.strain = 0.02;
    return options;
}

/// The network with the same stiffness everywhere.
template <int Dim>
SpringNetwork<Dim, double> even(SpringNetwork<Dim, double> network) {
    network.stiffness.setConstant(network.stiffness.mean());
    return network;
}

template <int Dim>
RecordedCases<Dim, double> cases_of(const SpringNetwork<Dim, double>& network) {
    auto cases = record_cases(network, test::small_specimen<Dim>(), few<Dim>());
    cases.stiffness_damping = 0.3 * stable_step([&] {
                                  auto undamped = network;
                                  undamped.damping.setZero();
                                  return undamped;
                              }());
    return cases;
}

} // namespace

TEST_CASE_TEMPLATE("a network that springs can represent is found again", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto truth = hidden<dim>();
    const auto result = calibrate(even(truth), cases_of(truth));
    CHECK(result.verdict == Verdict::good);
    CHECK(usable(result.status));
    CHECK(result.choice.rule == ChoiceRule::least_held_out_error);
    REQUIRE(result.candidates.size() == 4);
    const char* names[]{"given", "trajectory", "dominant_term", "exact"};
    for (std::size_t c = 0; c < 4; ++c) {
        CHECK(result.candidates[c].name == names[c]);
        CHECK(result.candidates[c].held_out.error >= result.best().held_out.error);
    }
    CHECK(result.best().held_out.error < 3e-3 * result.candidates[0].held_out.error);
    // Springs that some motion in time moves are found to the accuracy of the solver.
    const auto clamped = test::small_specimen<dim>().clamps.front().nodes;
    const auto is_clamped = [&](int node) { return std::binary_search(clamped.begin(), clamped.end(), node); };
    for (Index e = 0; e < truth.n_springs(); ++e) {
        if (!is_clamped(truth.springs(0, e)) || !is_clamped(truth.springs(1, e))) {
            CHECK(test::relative(result.candidates[3].network.stiffness(e), truth.stiffness(e), truth.stiffness(e)) <
                  1e-3);
        }
    }
    CHECK(result.stable_step == stable_step(result.best().network, result.cases.held_out.motions.front().clamped));
    // Errors case by case, which make up those of the parts and of the whole.
    const auto& scores = result.candidates[0].held_out;
    CHECK(scores.cases.size() == result.cases.held_out.size());
    for (std::size_t s = 0; s < scores.cases.size(); ++s) {
        CHECK(scores.statuses[s] == Status::converged);
        CHECK(scores.errors[s] > 0);
    }
    CHECK(held_out_parts(result.candidates[0], result.cases.held_out).size() == 3);
}

TEST_CASE("the same bits on any number of threads") {
    const auto truth = hidden<2>();
    auto cases = cases_of(truth);
    CalibrateOptions options;
    const auto one = calibrate(even(truth), cases, options);
    options.execution = test::backwards_on_threads();
    const auto three = calibrate(even(truth), cases, options);
    for (std::size_t c = 0; c < one.candidates.size(); ++c) {
        CHECK(one.candidates[c].network.stiffness == three.candidates[c].network.stiffness);
        CHECK(one.candidates[c].held_out.error == three.candidates[c].held_out.error);
    }
}

TEST_CASE("a mesh and a material are enough") {
    BodyOptions<2> body{.density = 1000, .clamped = test::small_specimen<2>().clamps.front().nodes};
    body.record = few<2>();
    body.how.matching_iterations = 5;
    const auto result = calibrate(test::small_box<2>(), fem::NeoHookean{.young = 1e4, .poisson = 0.3}, body);
    CHECK(result.verdict == Verdict::good);
    CHECK(result.candidates.front().name == "van_gelder");
    CHECK(result.best().held_out.error < result.candidates.front().held_out.error);
    CHECK(result.cases.stiffness_damping == light_damping(result.candidates.front().network));
    std::vector<std::string> stages;
    for (const auto& [name, seconds] : result.seconds) {
        stages.push_back(name);
        CHECK(seconds >= 0);
    }
    CHECK(stages == std::vector<std::string>{"reference", "fit", "score"});
    // A quadratic mesh is a reference of the network on its corners.
    body.how.method = Method::closed_form;
    const auto fine =
        calibrate(quadratic(test::small_box<2>()), fem::LinearElastic{.young = 1e4, .poisson = 0.3}, body);
    CHECK(fine.best().network.n_nodes() == test::small_box<2>().n_nodes());
    CHECK(fine.verdict == Verdict::good);
}

TEST_CASE("methods that are asked for are returned") {
    const auto truth = hidden<2>();
    const auto cases = cases_of(truth);
    CalibrateOptions options;
    int asked = 0;
    for (const auto& [method, name] :
         {std::pair{Method::closed_form, "given"}, std::pair{Method::trajectory, "trajectory"},
          std::pair{Method::dominant_term, "dominant_term"}, std::pair{Method::exact, "exact"}}) {
        options.method = method;
        options.exact_solver = [&](const AccelerationProblem& problem, const ExactOptions& how) {
            ++asked;
            return exact(problem, how);
        };
        const auto result = calibrate(even(truth), cases, options);
        CHECK(result.best().name == name);
        CHECK((result.choice.rule == ChoiceRule::asked_for) == (method != Method::closed_form));
    }
    CHECK(asked == 1);
}

TEST_CASE("an interruption leaves what is done, and says so") {
    const auto truth = hidden<2>();
    const auto cases = cases_of(truth);
    for (const char* stage : {"fit trajectory", "fit dominant_term", "fit exact", "score on motion"}) {
        CAPTURE(stage);
        CalibrateOptions options;
        std::vector<std::string> seen;
        options.progress = [&](const Progress& progress) {
            if (seen.empty() || seen.back() != progress.stage) {
                seen.emplace_back(progress.stage);
            }
            return progress.stage != stage;
        };
        const auto result = calibrate(even(truth), cases, options);
        CHECK(result.verdict == Verdict::unfinished);
        CHECK(result.status == Status::interrupted);
        CHECK(seen.back() == "score on motion"); // what is there is judged, all the same
        CHECK(!result.candidates.empty());
    }
    auto options = few<2>();
    options.progress = [](const Progress&) { return false; };
    const auto cut_short = record_cases(truth, test::small_specimen<2>(), options);
    CHECK(cut_short.interrupted);
    CHECK(cut_short.training.size() + cut_short.held_out.size() < 5);
}

TEST_CASE("what cannot be used is refused") {
    const auto truth = hidden<2>();
    const auto cases = cases_of(truth);
    auto without = truth;
    without.stiffness.setZero();
    CHECK_THROWS_WITH_AS((void)calibrate(without, cases), doctest::Contains("stiffness to start from"),
                         InvalidArgument);
    CHECK_THROWS_AS((void)calibrate(std::vector<NamedNetwork<2>>{}, cases), InvalidArgument);
    CHECK_THROWS_AS((void)(calibrate(truth, RecordedCases<2, double>{})), InvalidArgument);
    const auto other = springs_along_edges(triangle_grid<double>({2, 2}, {1., 1.}));
    CHECK_THROWS_AS((void)calibrate(other, cases), InvalidArgument);
    CalibrateOptions options;
    options.matching_seconds = 0;
    CHECK_THROWS_AS((void)calibrate(truth, cases, options), InvalidArgument);
    options = {};
    options.zeta = -1;
    CHECK_THROWS_AS((void)calibrate(truth, cases, options), InvalidArgument);
    options = {};
    options.scored_training_cases = 0;
    CHECK_THROWS_AS((void)calibrate(truth, cases, options), InvalidArgument);
}
