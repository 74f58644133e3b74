// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <set>

#include <springfit/cases/load_cases.hpp>

#include "specimens.hpp"

using namespace springfit;

namespace {

constexpr LoadKind all_kinds[] = {LoadKind::body_force, LoadKind::patch, LoadKind::pull,  LoadKind::gravity,
                                  LoadKind::stretch,    LoadKind::bend,  LoadKind::twist, LoadKind::press};

/// A box clamped at its left end.
template <int Dim, class Scalar>
Specimen<Dim, Scalar> clamped_box() {
    auto body = test::box_body<Dim, Scalar>();
    body.clamps = {{side_nodes(body.rest_positions, {0, false}), {}}};
    return body;
}

template <int Dim, class Scalar>
Points<Dim, Scalar> forces_of(const Scenario<Dim, Scalar>& scenario, const Specimen<Dim, Scalar>& body) {
    return external_forces<Dim, Scalar>(scenario, body.masses, Scalar(0));
}

/// Moment about the origin; in the plane its one component.
template <int Dim, class Scalar>
Vector<3, Scalar> moment(const Points<Dim, Scalar>& x, const Points<Dim, Scalar>& forces) {
    Vector<3, Scalar> result = Vector<3, Scalar>::Zero();
    for (Index i = 0; i < x.cols(); ++i) {
        Vector<3, Scalar> arm = Vector<3, Scalar>::Zero();
        Vector<3, Scalar> force = Vector<3, Scalar>::Zero();
        arm.template head<Dim>() = x.col(i);
        force.template head<Dim>() = forces.col(i);
        result += arm.cross(force);
    }
    return result;
}

} // namespace

TEST_CASE_TEMPLATE("every kind pushes free nodes alone, is fixed by its seed and goes by positions", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto body = clamped_box<dim, Scalar>();
    const auto permuted = test::renumbered(body, 11);
    for (const LoadKind kind : all_kinds) {
        CAPTURE(to_string(kind));
        for (const unsigned seed : {1u, 7u}) {
            const auto load = random_load(kind, body, seed);
            CHECK_NOTHROW(validate(load, body.n_nodes()));
            const auto forces = forces_of<dim, Scalar>(load, body);
            CHECK(forces.norm() > 0);
            CHECK(forces(Eigen::all, body.clamps[0].nodes).norm() == 0);
            CHECK(forces == forces_of<dim, Scalar>(random_load(kind, body, seed), body));
            CHECK((forces - forces_of<dim, Scalar>(random_load(kind, body, seed + 1), body)).norm() >
                  Scalar(0.01) * forces.norm());
            const auto there = forces_of<dim, Scalar>(random_load(kind, permuted.body, seed), permuted.body);
            CHECK((there - forces(Eigen::all, permuted.old)).norm() < test::rounding<Scalar>(1000) * forces.norm());
        }
    }
}

TEST_CASE_TEMPLATE("kinds are what they are called", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto body = clamped_box<dim, Scalar>();
    const auto& x = body.rest_positions;
    const auto fields_of = [&](LoadKind kind, unsigned seed) { // force per mass
        Points<dim, Scalar> field = forces_of<dim, Scalar>(random_load(kind, body, seed), body);
        return Points<dim, Scalar>(field * body.masses.cwiseInverse().asDiagonal());
    };
    const std::vector<int> far = side_nodes(x, {0, true});
    for (unsigned seed = 0; seed < 20; ++seed) {
        const auto pull = forces_of<dim, Scalar>(random_load(LoadKind::pull, body, seed), body);
        const Scalar strength = pull.colwise().norm().sum();
        CHECK(pull.rowwise().sum().norm() < test::rounding<Scalar>() * strength);
        CHECK(moment<dim, Scalar>(x, pull).norm() < test::rounding<Scalar>() * 3 * strength);
        CHECK(pull.cwiseProduct(x).sum() > Scalar(0.1) * strength); // apart, not together

        const auto gravity = fields_of(LoadKind::gravity, seed);
        CHECK(test::relative(gravity.col(far[0]).norm(), Scalar(1), Scalar(1)) < test::rounding<Scalar>());
        CHECK((gravity.col(far[0]) - gravity.col(far[1])).norm() < test::rounding<Scalar>());

        // The clamp is on the left: forces on the right are the largest, away from it or across.
        const auto stretch = fields_of(LoadKind::stretch, seed);
        const auto bend = fields_of(LoadKind::bend, seed);
        CHECK(stretch.col(far[0])(0) > Scalar(0.9) * stretch.colwise().norm().maxCoeff());
        CHECK(bend.row(0).norm() < Scalar(0.1) * bend.norm());
        CHECK(bend.col(far[0]).norm() > Scalar(0.9) * bend.colwise().norm().maxCoeff());
        const auto twist = fields_of(LoadKind::twist, seed);
        CHECK(moment<dim, Scalar>(x, twist).norm() > Scalar(0.05) * twist.colwise().norm().sum());

        const auto press = fields_of(LoadKind::press, seed);
        const Points<dim, Scalar> arms = x.colwise() - (x.rowwise().maxCoeff() / 2).eval();
        CHECK(press.cwiseProduct(arms).sum() < 0);
    }
}

TEST_CASE("loads on a flat sheet in space stay within its plane") {
    auto sheet = test::sheet_body<double>();
    sheet.clamps = {{side_nodes(sheet.rest_positions, {0, false}), {}}};
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vector<3, double>(1, 2, -1).normalized()).toRotationMatrix();
    auto turned = sheet;
    turned.rest_positions = turn * sheet.rest_positions;
    const Vector<3, double> normal = turn.col(2);
    for (const LoadKind kind : all_kinds) {
        CAPTURE(to_string(kind));
        const auto forces = forces_of<3, double>(random_load(kind, turned, 3), turned);
        CHECK(forces.norm() > 0);
        CHECK((normal.transpose() * forces).norm() < 1e-12 * forces.norm());
    }
}

TEST_CASE("loads need something to act on") {
    auto body = test::box_body<2, double>();
    body.surface.clear();
    CHECK_NOTHROW((void)random_load(LoadKind::gravity, body, 1));
    for (const LoadKind kind : {LoadKind::patch, LoadKind::pull, LoadKind::press}) {
        CHECK_THROWS_WITH_AS((void)random_load(kind, body, 1), "body: expected free surface nodes, found none",
                             InvalidArgument);
    }
    body.surface = {3};
    CHECK_NOTHROW((void)random_load(LoadKind::patch, body, 1));
    CHECK_THROWS_AS((void)random_load(LoadKind::pull, body, 1), InvalidArgument);
    CHECK_THROWS_AS((void)random_load(LoadKind::press, body, 1), InvalidArgument);
    body.clamps = {{{}, {}}};
    for (int i = 0; i < body.n_nodes(); ++i) {
        body.clamps[0].nodes.push_back(i);
    }
    CHECK_THROWS_WITH_AS((void)random_load(LoadKind::gravity, body, 1), "body: expected nodes left to move, found none",
                         InvalidArgument);
    body.surface = {99};
    CHECK_THROWS_AS((void)random_load(LoadKind::gravity, body, 1), InvalidArgument);
}

TEST_CASE_TEMPLATE("a split keeps loads, kinds and a clamp from training", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto body = clamped_box<dim, double>();
    const auto all = random_load_cases(
        body, {.training = 18, .clamps = 3, .held_out_loads = 4, .held_out_kinds = 7, .held_out_clamp = 5, .seed = 3});
    const auto count = [&](CaseRole role) { return scenarios_with(all, role).size(); };
    CHECK(count(CaseRole::training) == 18);
    CHECK(count(CaseRole::unseen_load) == 4);
    CHECK(count(CaseRole::unseen_kind) == 7);
    CHECK(count(CaseRole::unseen_clamp) == 5);

    const auto held = [&](const auto& load_case) { return clamped_nodes(load_case.scenario, body.n_nodes()); };
    std::set<std::pair<LoadKind, std::vector<int>>> seen;
    std::set<std::vector<int>> clamps;
    std::set<LoadKind> kinds;
    std::set<std::string> names;
    for (const auto& load_case : all) {
        REQUIRE(load_case.kind.has_value());
        CHECK(load_case.strain == 0);
        CHECK(load_case.scenario.name.starts_with(to_string(*load_case.kind)));
        if (load_case.role == CaseRole::training) {
            seen.insert({*load_case.kind, held(load_case)});
            clamps.insert(held(load_case));
            kinds.insert(*load_case.kind);
        }
    }
    CHECK(clamps.size() == 3);
    CHECK(clamps.count(body.clamps[0].nodes) == 1);
    CHECK(kinds == std::set<LoadKind>(training_kinds.begin(), training_kinds.end()));
    CHECK(seen.size() == 9); // every kind under every clamp
    int n_unseen_kinds = 0;
    std::set<std::vector<int>> unseen_clamps;
    for (const auto& load_case : all) {
        const auto& [scenario, kind, clamp_set, role, strain] = load_case;
        CHECK((held(load_case) == body.clamps[0].nodes) == (clamp_set == 0));
        if (role == CaseRole::unseen_load) {
            CHECK(seen.count({*kind, held(load_case)}) == 1);
        } else if (role == CaseRole::unseen_kind) {
            CHECK(kinds.count(*kind) == 0);
            CHECK(clamps.count(held(load_case)) == 1);
            CHECK((n_unseen_kinds++ >= 5 || clamp_set == 0)); // the first five are under the body's own clamps
        } else if (role == CaseRole::unseen_clamp) {
            CHECK(kinds.count(*kind) == 1);
            CHECK(clamps.count(held(load_case)) == 0);
            unseen_clamps.insert(held(load_case));
        }
    }
    CHECK(unseen_clamps.size() == 1);
    // No two cases are the same, another seed gives others, the same seed the same.
    std::vector<Points<dim, double>> forces;
    for (const auto& load_case : all) {
        names.insert(load_case.scenario.name);
        forces.push_back(forces_of<dim, double>(load_case.scenario, body));
        for (std::size_t c = 0; c + 1 < forces.size(); ++c) {
            CHECK(forces[c] != forces.back());
        }
    }
    CHECK(names.size() == forces.size());
    const auto again = scenarios_with(random_load_cases(body, {.seed = 3}), CaseRole::training);
    const auto other = scenarios_with(random_load_cases(body, {.seed = 4}), CaseRole::training);
    for (std::size_t c = 0; c < 18; ++c) {
        CHECK(forces_of<dim, double>(again[c], body) == forces[c]);
        CHECK(forces_of<dim, double>(other[c], body) != forces[c]);
    }
}

TEST_CASE("held-out cases with a seed of their own are the same however many are trained on") {
    const auto body = clamped_box<2, double>();
    LoadCaseOptions options{.training = 6, .seed = 3, .held_out_seed = 5};
    const auto few = random_load_cases(body, options);
    options.training = 18;
    const auto many = random_load_cases(body, options);
    options.held_out_seed = 6;
    const auto others = random_load_cases(body, options);
    for (const CaseRole role : {CaseRole::unseen_load, CaseRole::unseen_kind, CaseRole::unseen_clamp}) {
        const auto forces = [&](const auto& cases, std::size_t c) {
            return forces_of<2, double>(scenarios_with(cases, role)[c], body);
        };
        for (std::size_t c = 0; c < scenarios_with(few, role).size(); ++c) {
            CHECK(forces(few, c) == forces(many, c));
            CHECK(forces(few, c) != forces(others, c));
        }
    }
    const auto forces = forces_of<2, double>(scenarios_with(few, CaseRole::training)[5], body);
    CHECK(forces == forces_of<2, double>(scenarios_with(others, CaseRole::training)[5], body));
    CHECK(forces == forces_of<2, double>(random_load_cases(body, {.training = 6, .seed = 3})[5].scenario, body));
}

TEST_CASE("a split may be plain, and its numbers are checked") {
    auto body = clamped_box<2, double>();
    body.clamps[0].position = [](const Vector<2, double>& rest, double) { return rest; };
    const auto plain = random_load_cases(
        body, {.training = 2, .clamps = 1, .held_out_loads = 0, .held_out_kinds = 0, .held_out_clamp = 0});
    CHECK(plain.size() == 2);
    CHECK(plain[1].role == CaseRole::training);
    CHECK(plain[1].scenario.clamps[0].position); // moves as the body's own clamp does
    body.clamps.clear();                         // a body that nothing holds yet
    CHECK(holds_rigidly(body.rest_positions, clamped_nodes(random_load_cases(body)[0].scenario, body.n_nodes())));
    CHECK_THROWS_AS((void)random_load_cases(body, {.training = 0}), InvalidArgument);
    CHECK_THROWS_AS((void)random_load_cases(body, {.clamps = 0}), InvalidArgument);
    CHECK_THROWS_AS((void)random_load_cases(body, {.held_out_loads = -1}), InvalidArgument);
    CHECK_THROWS_AS((void)random_load_cases(body, {.held_out_kinds = -1}), InvalidArgument);
    CHECK_THROWS_AS((void)random_load_cases(body, {.held_out_clamp = -1}), InvalidArgument);
}

TEST_CASE("loads are scaled and given an amplitude") {
    Scenario<2, double> scenario;
    scenario.gravity = {{{0., -1.}, {}}};
    scenario.loads = {{{1}, Vector<2, double>(2., 0.), {}}};
    scale_loads(scenario, 3.);
    const Values<double> masses = Values<double>::Constant(2, 2.);
    Points<2, double> expected(2, 2);
    expected << 0, 6, -6, -6;
    CHECK(external_forces<2, double>(scenario, masses, 0.) == expected);
    set_amplitude(scenario, ramp_and_release(0.2, 0.5));
    for (const auto& [time, part] :
         {std::pair{0., 0.}, {0.1, 0.5}, {0.2, 1.}, {0.5, 1.}, {0.55, 0.5}, {0.6, 0.}, {9., 0.}}) {
        CHECK((external_forces<2, double>(scenario, masses, time) - part * expected).norm() < 1e-12);
    }
    CHECK_THROWS_AS((void)ramp_and_release(0., 1.), InvalidArgument);
    CHECK_THROWS_AS((void)ramp_and_release(1., 0.5), InvalidArgument);
}
