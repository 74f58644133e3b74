// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <set>

#include <springfit/cases/load_cases.hpp>

#include "bodies.hpp"

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
    const auto split = random_load_cases(
        body, {.training = 18, .clamps = 3, .held_out_loads = 4, .held_out_kinds = 7, .held_out_clamp = 5, .seed = 3});
    CHECK(split.training.size() == 18);
    CHECK(split.held_out_loads.size() == 4);
    CHECK(split.held_out_kinds.size() == 7);
    CHECK(split.held_out_clamp.size() == 5);

    const auto held = [&](const Scenario<dim, double>& scenario) { return clamped_nodes(scenario, body.n_nodes()); };
    const auto kind = [](const Scenario<dim, double>& scenario) {
        return scenario.name.substr(0, scenario.name.find_first_of("0123456789"));
    };
    std::set<std::pair<std::string, std::vector<int>>> seen;
    std::set<std::vector<int>> clamps;
    std::set<std::string> kinds;
    std::set<std::string> names;
    for (const auto& scenario : split.training) {
        seen.insert({kind(scenario), held(scenario)});
        clamps.insert(held(scenario));
        kinds.insert(kind(scenario));
    }
    CHECK(clamps.size() == 3);
    CHECK(clamps.count(body.clamps[0].nodes) == 1);
    CHECK(kinds == std::set<std::string>{"body force ", "patch ", "pull "});
    CHECK(seen.size() == 9); // every kind under every clamp
    for (const auto& scenario : split.held_out_loads) {
        CHECK(seen.count({kind(scenario), held(scenario)}) == 1);
    }
    for (const auto& scenario : split.held_out_kinds) {
        CHECK(kinds.count(kind(scenario)) == 0);
        CHECK(clamps.count(held(scenario)) == 1);
    }
    for (std::size_t c = 0; c < 5; ++c) {
        CHECK(held(split.held_out_kinds[c]) == body.clamps[0].nodes);
        CHECK(held(split.held_out_clamp[c]) == held(split.held_out_clamp[0]));
        CHECK(kinds.count(kind(split.held_out_clamp[c])) == 1);
        CHECK(clamps.count(held(split.held_out_clamp[c])) == 0);
    }
    // No two cases are the same, another seed gives others, the same seed the same.
    const auto again = random_load_cases(body, {.seed = 3});
    const auto other = random_load_cases(body, {.seed = 4});
    std::vector<Points<dim, double>> forces;
    for (const auto* set : {&split.training, &split.held_out_loads, &split.held_out_kinds, &split.held_out_clamp}) {
        for (const auto& scenario : *set) {
            names.insert(scenario.name);
            forces.push_back(forces_of<dim, double>(scenario, body));
            for (std::size_t c = 0; c + 1 < forces.size(); ++c) {
                CHECK(forces[c] != forces.back());
            }
        }
    }
    CHECK(names.size() == forces.size());
    for (std::size_t c = 0; c < 18; ++c) {
        CHECK(forces_of<dim, double>(again.training[c], body) == forces[c]);
        CHECK(forces_of<dim, double>(other.training[c], body) != forces[c]);
    }
}

TEST_CASE("a split may be plain, and its numbers are checked") {
    auto body = clamped_box<2, double>();
    body.clamps[0].position = [](const Vector<2, double>& rest, double) { return rest; };
    const auto plain = random_load_cases(
        body, {.training = 2, .clamps = 1, .held_out_loads = 0, .held_out_kinds = 0, .held_out_clamp = 0});
    CHECK(plain.training.size() == 2);
    CHECK(plain.training[1].clamps[0].position); // moves as the body's own clamp does
    CHECK(plain.held_out_clamp.empty());
    body.clamps.clear(); // a body that nothing holds yet
    CHECK(holds_rigidly(body.rest_positions, clamped_nodes(random_load_cases(body).training[0], body.n_nodes())));
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
