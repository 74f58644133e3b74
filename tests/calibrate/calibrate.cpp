// SPDX-License-Identifier: BSD-3-Clause
#include "cases/specimens.hpp"
#include "threads.hpp"
#include "tolerance.hpp"

#include <springfit/springfit.hpp>

using namespace springfit;

using test::even;

namespace {

/// A network that others are fitted to, with stiffness that varies from spring to spring.
template <int Dim>
SpringNetwork<Dim, double> hidden() {
    auto network = test::hidden_network<Dim>();
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
    CHECK(is_usable(result.verdict));
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
    CHECK(is_usable(fine.verdict));
}

TEST_CASE("where springs along edges are not good, cells and the second ring are tried, and what they buy is judged") {
    BodyOptions<2> body{.density = 1000, .clamped = test::small_specimen<2>().clamps.front().nodes};
    body.record = few<2>();
    body.how.matching_iterations = 4;
    const fem::NeoHookean rubber{.young = 1e4, .poisson = 0.48};
    const auto result = calibrate(test::small_box<2>(), rubber, body);
    const auto n_with = [&](const Calibration<2>& all, const char* parts) {
        return std::count_if(all.candidates.begin(), all.candidates.end(),
                             [&](const auto& one) { return one.name.find(parts) != std::string::npos; });
    };
    CHECK(n_with(result, "trajectory") >= 2);
    CHECK(n_with(result, "(cells)") > 0);
    for (const auto& candidate : result.candidates) {
        const bool has_cells = candidate.name.find("(cells") != std::string::npos;
        CHECK((candidate.network.n_cells() > 0) == has_cells);
        CHECK(candidate.held_out.is_scored());
        CHECK(result.best().held_out.error <= 1.2 * candidate.held_out.error);
    }
    body.parts = Parts::given;
    const auto edges = calibrate(test::small_box<2>(), rubber, body);
    CHECK(n_with(edges, "(cells") == 0);
    CHECK(edges.best().network.n_cells() == 0);
    body.volume = true; // asked for: nothing else
    body.parts = Parts::automatic;
    const auto cells = calibrate(test::small_box<2>(), rubber, body);
    CHECK(n_with(cells, "(cells") == 0);
    CHECK(cells.best().network.n_cells() > 0);
    CHECK_THROWS_AS((void)calibrate(std::vector<NetworkVariant<2>>{}, result.cases), InvalidArgument);
}

TEST_CASE(
    "a recording without the forces that moved it teaches nothing, and its damping is found where there is some") {
    auto network = hidden<2>();
    const auto clamped = test::small_specimen<2>().clamps.front().nodes;
    const double omega = lowest_frequency(network, clamped).omega;
    const double beta = 2 * 0.05 / omega; // 5 % of critical
    network.damping = stiffness_proportional_damping(network, beta);
    Scenario<2, double> scenario;
    scenario.clamps = {{clamped, {}}};
    scenario.gravity.push_back({Vector<2, double>(0.3, -1), {}});
    const double period = 2 * std::numbers::pi / omega;
    auto motion = record(network, scenario, {.dt = period / 40, .frames = 80}).motion;
    CalibrateOptions options;
    options.method = Method::trajectory;
    options.matching_iterations = 15;
    const auto found = calibrate(even(hidden<2>()), split_motions<2, double>({motion}), options);
    CHECK(is_usable(found.verdict));
    CHECK(test::relative(found.cases.stiffness_damping, beta, beta) < 0.2);
    for (auto& forces : motion.external_forces) {
        forces.setZero();
    }
    const auto nothing = calibrate(even(hidden<2>()), split_motions<2, double>({motion}), options);
    CHECK(nothing.verdict == Verdict::unusable);
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

TEST_CASE("every fit starts from the network that is named") {
    const auto truth = hidden<2>();
    const auto cases = cases_of(truth);
    auto far = even(truth);
    far.stiffness *= 3;
    const std::vector<NamedNetwork<2>> given{{"far", far}, {"near", even(truth)}};
    CalibrateOptions options;
    options.matching_iterations = 0;
    const auto stiffness_of = [&](const std::string& name) {
        for (const auto& candidate : make_candidates(given, cases, options).all) {
            if (candidate.name == name) {
                return candidate.network.stiffness;
            }
        }
        return Values<double>();
    };
    CHECK(stiffness_of("trajectory") == even(truth).stiffness); // the nearest
    options.start = 0;
    CHECK(stiffness_of("trajectory") == far.stiffness);
    // What no motion excites keeps its prior: springs between clamped nodes.
    const auto clamped = test::small_specimen<2>().clamps.front().nodes;
    for (const std::size_t start : {0, 1}) {
        options.start = start;
        const auto found = stiffness_of("exact");
        for (Index e = 0; e < truth.n_springs(); ++e) {
            if (std::binary_search(clamped.begin(), clamped.end(), truth.springs(0, e)) &&
                std::binary_search(clamped.begin(), clamped.end(), truth.springs(1, e))) {
                CHECK(found(e) == given[start].network.stiffness(e));
            }
        }
    }
    options.start = 2;
    CHECK_THROWS_WITH_AS((void)make_candidates(given, cases, options), doctest::Contains("start"), InvalidArgument);
}

TEST_CASE("fits learn from the cases that there are, or from all") {
    const auto truth = hidden<2>();
    auto cases = cases_of(truth);
    CalibrateOptions options;
    options.one_pass = true;
    options.matching_iterations = 3;
    std::vector<std::size_t> statics;
    std::vector<std::size_t> in_time;
    for (std::size_t c = 0; c < cases.training.size(); ++c) {
        (cases.training.is_static(c) ? statics : in_time).push_back(c);
    }
    const auto misfit = [&](const auto& made) { return made.all[1].trajectory->misfit_start; };
    const auto apart = make_candidates(std::vector<NamedNetwork<2>>{{"given", even(truth)}}, cases, options);
    REQUIRE(apart.all.size() == 5);
    CHECK(apart.all[2].name == "one_pass");
    options.learn_from_all = true;
    options.horizon = 0;
    options.steps_per_frame = 2;
    const auto together = make_candidates(std::vector<NamedNetwork<2>>{{"given", even(truth)}}, cases, options);
    CHECK(misfit(together) != misfit(apart));
    CHECK(together.all.back().acceleration->objective_start != apart.all.back().acceleration->objective_start);
    // Equilibria alone tell acceleration fits where forces balance.
    options.learn_from_all = false;
    cases.training = cases.training.subset(statics);
    const auto balanced = calibrate(even(truth), cases, options);
    CHECK(balanced.candidates.back().name == "exact");
    CHECK(balanced.candidates.back().held_out.error < 0.1 * balanced.candidates.front().held_out.error);
    // A loose tolerance ends matching sooner.
    options.method = Method::trajectory;
    options.matching_iterations = 40;
    const auto iterations = [&](double tolerance) {
        options.matching_tolerance = tolerance;
        return calibrate(even(truth), cases, options).best().trajectory->iterations;
    };
    CHECK(iterations(0.5) < iterations(1e-9));
}

TEST_CASE("errors by role, and of all cases where one fails") {
    const auto truth = hidden<2>();
    const auto cases = cases_of(truth);
    CalibrateOptions options;
    options.scored_training_cases = 0;
    std::vector<Candidate<2>> candidates{{.name = "even", .network = even(truth)}};
    CHECK(score(candidates, cases, options));
    const auto& even_one = candidates.front();
    CHECK(even_one.training.cases.empty());
    CHECK(std::isinf(even_one.training.error));
    const auto error_of = [&](CaseRole role) {
        std::vector<std::size_t> numbers;
        for (std::size_t c = 0; c < cases.held_out.size(); ++c) {
            if (cases.held_out.cases[c].role == role) {
                numbers.push_back(c);
            }
        }
        const auto part = cases.held_out.subset(numbers);
        return motion_error(even_one.network, part.scenarios(), part.motions).error;
    };
    for (const CaseRole role : {CaseRole::unseen_load, CaseRole::unseen_kind}) {
        const double expected = error_of(role);
        CHECK(test::relative(error_with(role, even_one.held_out, cases.held_out), expected, expected) < 1e-12);
    }
    CHECK(std::isnan(error_with(CaseRole::unseen_clamp, even_one.held_out, cases.held_out)));

    // A load that no network bears counts as 1, and all other cases are scored all the same.
    auto torn = cases;
    std::size_t broken = 0;
    while (torn.held_out.cases[broken].role != CaseRole::unseen_kind) {
        ++broken;
    }
    scale_loads(torn.held_out.cases[broken].scenario, 1e300);
    candidates.front().held_out = {};
    CHECK(score(candidates, torn, options));
    const CaseScores& scores = candidates.front().held_out;
    CHECK(scores.n_failed() == 1);
    CHECK(scores.errors[broken] == 1);
    CHECK(scores.error < 1);
    CHECK(scores.statuses.back() == Status::converged);
    CHECK(verdict_on(scores) != Verdict::good);
    // A good network is scored on all equilibria that it learnt from, though one of these cases fails.
    auto strained = cases;
    std::size_t n_equilibria = 0;
    for (std::size_t c = 0; c < strained.training.size(); ++c) {
        if (strained.training.is_static(c) && n_equilibria++ == 0) {
            scale_loads(strained.training.cases[c].scenario, 1e300);
        }
    }
    REQUIRE(n_equilibria > 0);
    options.scored_training_cases = static_cast<int>(cases.training.size());
    std::vector<Candidate<2>> good{{.name = "even", .network = truth}};
    CHECK(score(good, strained, options));
    CHECK(good.front().held_out.error < 0.1);
    CHECK(good.front().training.n_failed() == 1);
    CHECK(good.front().training.n_tried() == n_equilibria);
    const double others = error_of(CaseRole::unseen_load);
    CHECK(test::relative(error_with(CaseRole::unseen_load, candidates.front().held_out, torn.held_out), others,
                         others) < 1e-12);
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
    options.scored_training_cases = -1;
    CHECK_THROWS_AS((void)calibrate(truth, cases, options), InvalidArgument);
    options = {};
    options.steps_per_frame = -1;
    options.learn_from_all = true;
    CHECK_THROWS_AS((void)calibrate(truth, cases, options), InvalidArgument);
    options = {};
    options.matching_tolerance = 0;
    CHECK_THROWS_AS((void)calibrate(truth, cases, options), InvalidArgument);
}
