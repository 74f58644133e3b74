// SPDX-License-Identifier: BSD-3-Clause
#include "specimens.hpp"
#include "threads.hpp"
#include "tolerance.hpp"

#include <springfit/springfit.hpp>

using namespace springfit;

namespace {

template <int Dim>
RecordCasesOptions<Dim, double> few() {
    RecordCasesOptions<Dim, double> options;
    options.training_motions = 3;
    options.held_out_motions = 3;
    options.frames = 8;
    options.training_equilibria = 7;
    options.held_out_loads = 2;
    options.held_out_kinds = 2;
    options.strain = 0.05;
    return options;
}

const fem::LinearElastic linear{.young = 1e4, .poisson = 0.3};

} // namespace

TEST_CASE_TEMPLATE("cases have their roles, kinds, clamps and strains", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto body = test::small_specimen<dim>();
    const auto reference = fem_recorder(test::small_box<dim>(), linear, 1000.);
    const auto cases = record_cases(reference, body, few<dim>());
    CHECK(!cases.interrupted);
    CHECK(cases.warnings.empty());
    CHECK(cases.training.size() == 3 + 7);
    CHECK(cases.held_out.size() == 3 + 4);
    std::size_t n_small = 0;
    for (const auto* set : {&cases.training, &cases.held_out}) {
        for (std::size_t c = 0; c < set->size(); ++c) {
            const auto& [scenario, kind, clamp_set, role, strain] = set->cases[c];
            const auto& motion = set->motions[c];
            CHECK((role == CaseRole::training) == (set == &cases.training));
            REQUIRE(kind.has_value());
            const bool is_trained =
                std::find(training_kinds.begin(), training_kinds.end(), *kind) != training_kinds.end();
            CHECK(is_trained == (role != CaseRole::unseen_kind));
            CHECK(motion.clamped == clamped_nodes(scenario, body.n_nodes()));
            CHECK((motion.clamped == body.clamps.front().nodes) == (clamp_set == 0));
            CHECK(set->is_static(c) == (strain > 0));
            if (set->is_static(c)) {
                // For a linear material the strain is what was asked for.
                const auto found =
                    linear_edge_strain(body.edges, body.rest_positions, motion.positions.front() - body.rest_positions);
                CHECK(test::relative(std::max(found.percentile_95, found.max / 4), strain, strain) < 1e-6);
                n_small += strain < 0.01 ? 1 : 0;
            } else {
                CHECK(motion.n_frames() == 8);
                CHECK(test::relative(motion.times.back(), 1.25 * cases.period, cases.period) < 1e-12);
            }
        }
    }
    CHECK(n_small == 3); // every second one to learn from
}

TEST_CASE("recorders answer as their references do") {
    const auto mesh = test::small_box<2>();
    const auto body = test::small_specimen<2>();
    const fem::Model model{mesh, linear, 1000.};
    const auto by_model = record_cases(model, body, few<2>()); // any reference
    const auto by_recorder = record_cases(fem_recorder(mesh, linear, 1000.), body, few<2>());
    auto many = few<2>();
    many.execution = test::backwards_on_threads();
    const auto by_threads = record_cases(model, body, many);
    REQUIRE(by_model.training.size() == by_recorder.training.size());
    for (std::size_t c = 0; c < by_model.training.size(); ++c) {
        CHECK(by_model.training.motions[c].positions == by_recorder.training.motions[c].positions);
        CHECK(by_model.training.motions[c].positions == by_threads.training.motions[c].positions);
    }

    // Nodes on edges: their clamps are those of the edge's ends, and a recording has the vertices alone.
    const auto fine = quadratic(mesh);
    const fem::Model fine_model{fine, linear, 1000.};
    Scenario<2, double> pulled;
    pulled.clamps = body.clamps;
    pulled.loads.push_back({{0}, Points<2, double>::Zero(2, 1), {}});
    pulled.loads.back().nodes = {static_cast<int>(mesh.n_nodes()) - 1};
    pulled.loads.back().forces << 0.3, -0.2;
    auto all_held = pulled;
    const auto [at_corners, at_nodes] = corner_interpolations(fine);
    all_held.clamps.front().nodes = targets_of(at_nodes, pulled.clamps.front().nodes);
    CHECK(all_held.clamps.front().nodes.size() == 2 * pulled.clamps.front().nodes.size() - 1);
    const auto recorded = fem_recorder(fine, linear, 1000.).record_statics({pulled}, {}).front().motion;
    const auto expected = record_static(fine_model, all_held).motion;
    CHECK(recorded.n_nodes() == mesh.n_nodes());
    CHECK(recorded.positions.front() == expected.positions.front().leftCols(mesh.n_nodes()));
    CHECK(recorded.external_forces.front() == expected.external_forces.front().leftCols(mesh.n_nodes()));
}

TEST_CASE_TEMPLATE("load cases of one's own are recorded by their roles", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto body = test::small_specimen<dim>();
    const auto reference = fem_recorder(test::small_box<dim>(), linear, 1000.);
    const auto loads = random_load_cases(
        body, {.training = 4, .clamps = 2, .held_out_loads = 2, .held_out_kinds = 3, .held_out_clamp = 1});
    const auto statics = record_equilibria(reference, body, loads, {.strain = 0.01});
    CHECK(statics.training.size() == 4);
    REQUIRE(statics.held_out.size() == 6);
    CHECK(statics.held_out.cases.back().role == CaseRole::unseen_clamp);
    for (std::size_t c = 0; c < 6; ++c) {
        const auto& motion = statics.held_out.motions[c];
        const auto found =
            linear_edge_strain(body.edges, body.rest_positions, motion.positions.front() - body.rest_positions);
        CHECK(test::relative(std::max(found.percentile_95, found.max / 4), 0.01, 0.01) < 1e-6);
        CHECK(motion.name == "static " + statics.held_out.cases[c].scenario.name);
    }

    // In time, as the scenarios are: let go of at those equilibria.
    auto releases = statics.held_out.cases;
    for (std::size_t c = 0; c < releases.size(); ++c) {
        releases[c].scenario.loads.clear();
        releases[c].scenario.initial_positions = statics.held_out.motions[c].positions.front();
    }
    const auto swings = record_motions(reference, releases, 1e-4, {.dt = 1e-3, .frames = 5});
    CHECK(swings.stiffness_damping == 1e-4);
    CHECK(swings.training.empty());
    REQUIRE(swings.held_out.size() == 6);
    CHECK(swings.held_out.motions.front().n_frames() == 5);
    CHECK(swings.held_out.motions.front().positions.front() == statics.held_out.motions.front().positions.front());
    CHECK(swings.held_out.cases.back().role == CaseRole::unseen_clamp);

    auto both = statics;
    both.add(swings);
    CHECK(both.held_out.size() == 12);

    auto bare = body;
    bare.edges.resize(2, 0);
    CHECK_THROWS_WITH_AS((void)record_equilibria(reference, bare, loads), doctest::Contains("edges"), InvalidArgument);
    CHECK_THROWS_AS((void)record_equilibria(reference, body, loads, {.strain = 0}), InvalidArgument);
}

TEST_CASE("what has no equilibrium is left out with a warning, even if nothing is left") {
    const auto body = test::small_specimen<2>();
    auto network = springs_along_edges(test::small_box<2>(), {.density = 1000.});
    network.stiffness.setConstant(1e3);
    const ReferenceRecorder reference(network);
    auto loads =
        random_load_cases(body, {.training = 2, .held_out_loads = 1, .held_out_kinds = 0, .held_out_clamp = 0});
    for (auto& load : loads) {
        scale_loads(load.scenario, 1e200);
    }
    const auto none = record_equilibria<2, double>(reference, body, loads, {.responses = [](const auto& scenarios) {
                                                       return std::vector<Points<2, double>>(scenarios.size());
                                                   }});
    CHECK(none.training.empty());
    CHECK(none.held_out.empty());
    REQUIRE(none.warnings.size() == 3);
    CHECK(none.warnings.front().code == WarningCode::no_equilibrium);
    const auto stopped = record_equilibria<2, double>(
        reference, body, random_load_cases(body), {.strain = 0.01, .progress = [](const Progress&) { return false; }});
    CHECK(stopped.interrupted);
}

TEST_CASE("damping is told where it can be") {
    const auto recorder = fem_recorder(test::small_box<2>(), linear, 1000.);
    auto options = few<2>();
    options.training_equilibria = 0;
    options.damping_ratio = 0.1;
    const auto damped = record_cases(recorder, test::small_specimen<2>(), options);
    CHECK(test::relative(damped.stiffness_damping, 0.2 * damped.period / (2 * std::numbers::pi), 1e-3) < 1e-12);
    const fem::Model model{test::small_box<2>(), linear, 1000., {.stiffness_damping = 2e-4}};
    CHECK(record_cases(model, test::small_specimen<2>(), options).stiffness_damping == 2e-4); // its own
}

TEST_CASE("a program that moves in time alone is scaled by the responses of a network") {
    const auto network = test::small_network<2>();
    SymplecticEuler<2, double> stepper(network);
    const UserReference<2, double> reference{
        network.rest_positions, network.mass, [stepper](auto& state, const auto& scenario, double dt) mutable {
            auto inner = stepper;
            const Status status = inner.advance(state, scenario, dt);
            state.time -= status == Status::converged ? dt : 0; // the reference counts time itself
            return status;
        }};
    auto options = few<2>();
    CHECK_THROWS_WITH_AS((void)record_cases(reference, test::small_specimen<2>(), options),
                         doctest::Contains("responses"), InvalidArgument);
    options.responses = [&](const auto& scenarios) { return linear_responses(network, scenarios); };
    const auto cases = record_cases(reference, test::small_specimen<2>(), options);
    CHECK(cases.training.size() == 3); // no equilibria
    CHECK(cases.held_out.size() == 3);
    double largest = 0;
    for (const auto& positions : cases.training.motions.front().positions) {
        largest = std::max(largest, (positions - network.rest_positions).colwise().norm().maxCoeff());
    }
    const double size = std::hypot(0.3, 0.5);
    CHECK(largest > 0.02 * size);
    CHECK(largest < 0.1 * size);
}

TEST_CASE("a reference that fails is left out with a warning, and one that always fails is refused") {
    const auto mesh = test::small_box<2>();
    const auto body = test::small_specimen<2>();
    auto options = few<2>();
    auto network = springs_along_edges(mesh, {.density = 1000.});
    network.stiffness.setConstant(1e3);
    options.responses = [&](const auto& scenarios) { return linear_responses(network, scenarios); };
    const UserReference<2, double> broken{mesh.nodes, body.masses,
                                          [](auto&, const auto&, double) { return Status::diverged; }};
    CHECK_THROWS_WITH_AS((void)record_cases(broken, body, options), doctest::Contains("none that converged"),
                         InvalidArgument);
    const UserReference<2, double> half{mesh.nodes, body.masses, [](auto& state, const auto&, double dt) {
                                            return state.time > 5.5 * dt ? Status::diverged : Status::converged;
                                        }};
    const auto cases = record_cases(half, body, options);
    CHECK(cases.warnings.size() == 6);
    for (const auto& warning : cases.warnings) {
        CHECK(warning.code == WarningCode::reference_ended_early);
        CHECK(!warning.advice.empty());
    }
}

TEST_CASE("clamps and options are checked") {
    const auto recorder = fem_recorder(test::small_box<2>(), linear, 1000.);
    auto loose = test::small_specimen<2>();
    loose.clamps = {{{0}, {}}};
    CHECK_THROWS_WITH_AS((void)record_cases(recorder, loose, few<2>()), doctest::Contains("clamps"), InvalidArgument);
    const auto refused = [&](const auto& change) {
        auto options = few<2>();
        change(options);
        CHECK_THROWS_AS((void)record_cases(recorder, test::small_specimen<2>(), options), InvalidArgument);
    };
    refused([](auto& o) { o.training_motions = 0; });
    refused([](auto& o) { o.held_out_motions = 0; });
    refused([](auto& o) { o.frames = 3; });
    refused([](auto& o) { o.deformation = 1; });
    refused([](auto& o) { o.damping_ratio = 1; });
    refused([](auto& o) { o.stiffness_damping = -1; });
    refused([](auto& o) { o.training_equilibria = -1; });
    refused([](auto& o) { o.clamp_sets = 0; });
    refused([](auto& o) { o.strain = std::nan(""); });
    refused([](auto& o) { o.small_strain = 0; });
    auto options = few<2>();
    options.holds = [](const std::vector<int>&) { return false; };
    const auto cases = record_cases(recorder, test::small_specimen<2>(), options);
    CHECK(cases.training.size() == 3);
    REQUIRE(cases.warnings.size() == 1);
    CHECK(cases.warnings.front().code == WarningCode::clamps_left_out);
}

TEST_CASE("recorded motions are split") {
    Motion<2, double> motion;
    motion.name = "swing";
    motion.rest_positions = Points<2, double>::Random(2, 4);
    motion.clamped = {0};
    for (int t = 0; t < 9; ++t) {
        motion.times.push_back(0.1 * t);
        motion.positions.push_back(motion.rest_positions);
        motion.positions.back().rightCols(2).array() += 0.01 * t;
        motion.velocities.push_back(Points<2, double>::Zero(2, 4));
        motion.accelerations.push_back(Points<2, double>::Zero(2, 4));
        motion.external_forces.push_back(Points<2, double>::Zero(2, 4));
    }
    CHECK(still_nodes(motion) == std::vector<int>{0, 1});
    const auto one = split_motions<2, double>({motion});
    CHECK(one.training.motions.front().n_frames() == 6);
    CHECK(one.held_out.motions.front().n_frames() == 3);
    CHECK(one.held_out.motions.front().positions.front() == motion.positions[6]);
    const auto five = split_motions<2, double>({motion, motion, motion, motion, motion});
    CHECK(five.training.size() == 4);
    CHECK(five.held_out.size() == 1);
    CHECK(five.held_out.cases.front().role == CaseRole::unseen_load);
    CHECK(!five.held_out.cases.front().kind);
    CHECK_THROWS_AS((void)(split_motions<2, double>({})), InvalidArgument);
    CHECK_THROWS_AS((void)(split_motions<2, double>({excerpt(motion, 0, 3)})), InvalidArgument);
    CHECK_THROWS_AS(validate(one, 5), InvalidArgument);
    validate(one, 4);

    // Frames that are off by little are even; others are resampled.
    auto digits = motion;
    digits.times[3] += 2e-5;
    CHECK(split_motions<2, double>({digits}).warnings.empty());
    auto dropped = motion;
    for (auto* frames : {&dropped.positions, &dropped.velocities, &dropped.accelerations, &dropped.external_forces}) {
        frames->erase(frames->begin() + 4);
    }
    dropped.times.erase(dropped.times.begin() + 4);
    const auto resampled = split_motions<2, double>({dropped, motion});
    REQUIRE(resampled.warnings.size() == 1);
    CHECK(resampled.warnings.front().code == WarningCode::resampled);
    CHECK(has_even_frames(resampled.training.motions.front()));
}

TEST_CASE("recorded equilibria are split, alone and beside motions, and repeated ones are one") {
    Motion<2, double> rest;
    rest.rest_positions = Points<2, double>::Random(2, 4);
    rest.clamped = {0};
    const auto bent = [&](double by, int frames) {
        Motion<2, double> motion = rest;
        for (int t = 0; t < frames; ++t) {
            motion.times.push_back(1. + t);
            motion.positions.push_back(motion.rest_positions);
            motion.positions.back().rightCols(2).array() += by;
            for (auto* columns : {&motion.velocities, &motion.accelerations, &motion.external_forces}) {
                columns->push_back(Points<2, double>::Zero(2, 4));
            }
        }
        return motion;
    };
    const auto some =
        split_motions<2, double>({bent(0.1, 1), bent(0.2, 1), bent(0.3, 4), bent(0.4, 1), bent(0.2, 1), bent(0.5, 1)});
    CHECK(some.training.size() == 4);
    REQUIRE(some.held_out.size() == 1);
    CHECK(some.held_out.is_static(0));
    CHECK(some.training.is_static(2)); // four equal frames are one equilibrium
    REQUIRE(some.warnings.size() == 1);
    CHECK(some.warnings.front().code == WarningCode::repeated_case);
    CHECK_THROWS_WITH_AS((void)(split_motions<2, double>({bent(0.1, 4), bent(0.1, 1)})),
                         doctest::Contains("two equilibria"), InvalidArgument);
    auto moving = bent(0.1, 8);
    for (std::size_t t = 0; t < 8; ++t) {
        moving.positions[t].rightCols(1).array() += 0.01 * static_cast<double>(t);
    }
    const auto both = split_motions<2, double>({moving, bent(0.2, 1), bent(0.3, 1)});
    CHECK(both.training.size() == 2); // the motion, and an equilibrium
    CHECK(both.held_out.size() == 1);
    const auto one_each = split_motions<2, double>({moving, bent(0.2, 1)});
    CHECK(one_each.training.size() == 2);
    CHECK(one_each.held_out.size() == 1);
    CHECK_FALSE(one_each.held_out.is_static(0));
}

TEST_CASE("a linear reference is loaded little unless it is told otherwise, motions in time by strain as well") {
    const auto body = test::small_specimen<2>();
    auto options = few<2>();
    options.strain.reset();
    const auto by_linear = record_cases(fem_recorder(test::small_box<2>(), linear, 1000.), body, options);
    CHECK(by_linear.strain == 0.001);
    REQUIRE(!by_linear.warnings.empty());
    CHECK(by_linear.warnings.front().code == WarningCode::small_strain);
    const auto recorder = fem_recorder(test::small_box<2>(), fem::NeoHookean{.young = 1e4, .poisson = 0.3}, 1000.);
    const auto strain_of = [&](const RecordCasesOptions<2, double>& how) {
        const auto cases = record_cases(recorder, body, how);
        double largest = 0;
        for (std::size_t c = 0; c < cases.training.size(); ++c) {
            if (!cases.training.is_static(c)) {
                for (const auto& positions : cases.training.motions[c].positions) {
                    largest = std::max(largest, edge_strain(body.edges, body.rest_positions, positions).percentile_95);
                }
            }
        }
        CHECK(cases.strain == how.strain.value_or(0.05));
        return largest;
    };
    options.training_equilibria = 0;
    options.strain = 0.01;
    const double small = strain_of(options);
    CHECK(small > 0.005);
    CHECK(small < 0.025);      // a ramp overshoots its static response
    options.deformation = 0.2; // asked for: whatever the strain
    CHECK(strain_of(options) > 2 * small);
}

TEST_CASE("no equilibrium goes far, and none is one that the reference buckles or topples into") {
    const auto check = [](double height, const Vector<2, double>& gravity, double strain_below) {
        const auto strip = triangle_grid<double>({30, 4}, {2., height});
        auto body = specimen_of(strip, 1000.);
        body.clamps = {{side_nodes(body.rest_positions, {.axis = 0}), {}}};
        const auto reference = fem_recorder(strip, fem::NeoHookean{.young = 1e4, .poisson = 0.3}, 1000.);
        LoadCase<2, double> load_case;
        load_case.scenario.clamps = body.clamps;
        load_case.scenario.gravity = {{gravity, {}}};
        const auto found = record_equilibria(reference, body, {load_case}, {.strain = 0.05});
        REQUIRE(found.training.size() == 1);
        const auto& motion = found.training.motions.front();
        const double far = (motion.positions.front() - motion.rest_positions).colwise().norm().maxCoeff();
        const auto expected = reference.linear_responses(found.training.scenarios(), {});
        const double linear_one = expected.front().colwise().norm().maxCoeff();
        CHECK(linear_one < 0.2501 * body.size());
        CHECK(far < 1.5 * linear_one);
        CHECK(found.training.cases.front().strain > 0);
        CHECK(found.training.cases.front().strain < strain_below);
    };
    check(0.4, {0., 1.}, 0.0501);    // bent to that strain
    check(0.05, {0., 1.}, 0.02);     // a quarter of its length comes first
    check(0.4, {-1., 0.01}, 0.0251); // pressed, and a little aside: buckles under its own weight at a strain of 0.026
}
