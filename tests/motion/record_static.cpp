// SPDX-License-Identifier: BSD-3-Clause
#include "threads.hpp"
#include "tolerance.hpp"

#include <springfit/fem/statics.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/motion/record_static.hpp>
#include <springfit/network/builders.hpp>
#include <springfit/simulate/static_solver.hpp>

using namespace springfit;

namespace {

/// Node 0 held by one spring along each axis, from clamped nodes 1 ... Dim; stiffness 2, 3, ... N/m.
template <int Dim, class Scalar>
SpringNetwork<Dim, Scalar> corner() {
    SpringNetwork<Dim, Scalar> network;
    network.rest_positions.setZero(Dim, Dim + 1);
    network.rest_positions.template rightCols<Dim>().setIdentity();
    network.springs.setZero(2, Dim);
    for (int d = 0; d < Dim; ++d) {
        network.springs(1, d) = d + 1;
    }
    network.stiffness.setLinSpaced(Dim, 2, Dim + 1);
    network.rest_length.setOnes(Dim);
    network.damping.setZero(Dim);
    network.mass.setOnes(Dim + 1);
    return network;
}

template <int Dim, class Scalar>
Scenario<Dim, Scalar> push(std::vector<int> clamped, int node, const Vector<Dim, Scalar>& force) {
    Scenario<Dim, Scalar> scenario;
    scenario.name = text("push ", node);
    scenario.clamps = {{std::move(clamped), {}}};
    scenario.loads = {{{node}, force, {}}};
    return scenario;
}

/// A block of rubber or of a linear material.
template <int Dim, class Mat>
auto block(const Mat& material) {
    if constexpr (Dim == 2) {
        return fem::Model{triangle_grid<double>({4, 2}, {2., 1.}), material, 1000.};
    } else {
        return fem::Model{
            tetrahedron_grid<double>({4, 2, 2}, {2., 1., 1.}), material, 1000., {.dilatation = fem::Dilatation::mean}};
    }
}

/// Pushes on the nodes of a block with its left or its right end clamped in turn, the last case without a load.
template <int Dim>
std::vector<Scenario<Dim, double>> pushes(const Points<Dim, double>& rest, double force) {
    std::vector<int> ends[2];
    for (Index i = 0; i < rest.cols(); ++i) {
        if (rest(0, i) < 1e-9 || rest(0, i) > 2 - 1e-9) {
            ends[rest(0, i) > 1].push_back(static_cast<int>(i));
        }
    }
    std::vector<Scenario<Dim, double>> cases;
    for (int c = 0; c < 7; ++c) {
        Vector<Dim, double> direction = Vector<Dim, double>::Constant(0.3);
        direction(c % Dim) = c < 6 ? 1 : 0;
        cases.push_back(push<Dim, double>(ends[c % 2], 2, (c < 6 ? force : 0) * direction));
    }
    return cases;
}

/// A program of one's own that finds these equilibria and answers.
struct Given {
    static constexpr int dimension = 2;
    using Scalar = double;

    Points<2, double> rest, found;
    Values<double> node_masses;

    [[nodiscard]] const Points<2, double>& rest_positions() const { return rest; }
    [[nodiscard]] const Values<double>& masses() const { return node_masses; }
    Status solve_equilibrium(const Scenario<2, double>&, double, Points<2, double>& positions) const {
        positions = found;
        return Status::converged;
    }
    Status linear_response(const Scenario<2, double>&, double, Points<2, double>& displacement) const {
        displacement = found;
        return Status::converged;
    }
};

Given make_static_solver(const Given& given) {
    return given;
}

} // namespace

TEST_CASE_TEMPLATE("springs along the axes give way by F / k each", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    static_assert(StaticReference<SpringNetwork<dim, Scalar>>);
    const auto network = corner<dim, Scalar>();
    std::vector<int> held;
    for (int d = 0; d < dim; ++d) {
        held.push_back(d + 1);
    }
    const Vector<dim, Scalar> force = Vector<dim, Scalar>::Constant(Scalar(0.012));
    auto scenario = push<dim, Scalar>(held, 0, force);
    const Vector<dim, Scalar> expected = force.cwiseQuotient(network.stiffness);
    const auto responses = linear_responses(network, {scenario});
    CHECK(test::relative_difference(responses[0].col(0), expected) < test::rounding<Scalar>());
    CHECK(responses[0].template rightCols<dim>().norm() == 0);

    const auto [motion, status] = record_static(network, scenario, Scalar(0.5));
    CHECK(status == Status::converged);
    CHECK_NOTHROW(validate(motion));
    CHECK(motion.name == "push 0");
    CHECK(motion.clamped == held);
    CHECK(motion.times == std::vector<Scalar>{Scalar(0.5)});
    CHECK(motion.velocities[0].norm() == 0);
    CHECK(motion.accelerations[0].norm() == 0);
    CHECK(motion.external_forces[0].col(0) == force);
    CHECK((motion.positions[0].col(0) - expected).norm() < 3 * expected.squaredNorm()); // second order, springs of 1 m
    Points<dim, Scalar> unbalanced = motion.external_forces[0];
    add_elastic_forces<dim, Scalar>(network, motion.positions[0], unbalanced);
    CHECK(unbalanced.col(0).norm() <
          Scalar(1e-8) * force.norm() + test::rounding<Scalar>() * network.stiffness.maxCoeff());

    // Clamps that move carry the node along; a load read at a time has the amplitude of that time.
    scenario.clamps[0].position = [](const Vector<dim, Scalar>& rest, Scalar time) {
        return Vector<dim, Scalar>(rest + time * Vector<dim, Scalar>::Unit(1));
    };
    scenario.loads[0].amplitude = [](Scalar time) { return 3 * time; };
    const auto moved = linear_responses(network, {scenario}, {.time = Scalar(0.125)});
    const Vector<dim, Scalar> carried = Scalar(0.375) * expected + Scalar(0.125) * Vector<dim, Scalar>::Unit(1);
    CHECK(test::relative_difference(moved[0].col(0), carried) < test::rounding<Scalar>());
    // One spring alone leaves the node free to move across it.
    auto loose = network;
    loose.stiffness(0) = 0;
    CHECK(linear_responses(loose, {scenario}, {.time = Scalar(0.125)})[0].cols() == 0);
    CHECK(linear_responses(loose, {scenario})[0].norm() == 0); // no load as yet
}

TEST_CASE_TEMPLATE("a network's linear response is its answer to a small load, cells included", T,
                   test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto model = block<dim>(fem::LinearElastic{1e4, 0.3}); // for its mesh
    auto network = springs_along_edges(model.mesh(), {.volume = true, .density = 10.});
    network.stiffness.setLinSpaced(network.n_springs(), 100, 200);
    network.volume_stiffness.setLinSpaced(network.n_cells(), -20, 300);
    network.rest_length.array() *= 1.001; // springs that push at rest: the response is that to their forces as well
    auto cases = pushes<dim>(network.rest_positions, 0.);
    const auto sprung = linear_responses(network, cases);
    const auto loaded = pushes<dim>(network.rest_positions, 1.);
    const auto responses = linear_responses(network, loaded);
    for (std::size_t c = 0; c + 1 < cases.size(); ++c) {
        CHECK(sprung[c].norm() > 0);
        CHECK(sprung[c] == sprung[c % 2]); // the same clamps
        // Linear in the load, and the derivative of the equilibrium at the rest positions.
        const auto half = pushes<dim>(network.rest_positions, 0.5);
        const auto between = linear_responses(network, {half[c]}).front();
        CHECK(test::relative_difference((responses[c] + sprung[c]) / 2, between) < 1e-9);
    }
    network.rest_length /= 1.001;
    const auto straight = linear_responses(network, loaded);
    for (std::size_t c = 0; c + 1 < cases.size(); ++c) {
        auto small = loaded[c];
        small.loads[0].forces *= 1e-4;
        const Points<dim, double> part = record_static(network, small).motion.positions[0] - network.rest_positions;
        CHECK((1e4 * part - straight[c]).norm() < 1e-3 * straight[c].norm());
    }
}

TEST_CASE_TEMPLATE("many static cases under several clamps are those of one at a time", Mat, fem::LinearElastic,
                   fem::NeoHookean) {
    const auto check = [](const auto& model, double force, double least_strain) {
        constexpr int dim = std::remove_cvref_t<decltype(model)>::dimension;
        const auto& rest = model.rest_positions();
        const auto cases = pushes<dim>(rest, force);
        const auto recordings = record_statics(model, cases);
        const auto again = record_statics(model, cases, {.execution = test::backwards_on_threads()});
        const auto responses = linear_responses(model, cases);
        for (std::size_t c = 0; c < cases.size(); ++c) {
            const auto& [motion, status] = recordings[c];
            CHECK(status == Status::converged);
            CHECK_NOTHROW(validate(motion));
            CHECK(motion.clamped == clamped_nodes(cases[c], rest.cols()));
            CHECK(again[c].motion.positions[0] == motion.positions[0]);
            const FreeNodes free(rest.cols(), motion.clamped);
            const Points<dim, double> unbalanced =
                model.internal_forces(motion.positions[0]) - motion.external_forces[0];
            CHECK(free.template gather<dim, double>(unbalanced).cwiseAbs().maxCoeff() <= 1e-6 * force);
            const auto alone = fem::equilibrium(model, cases[c]);
            CHECK((alone.state.positions - motion.positions[0]).norm() <= 1e-6 * (motion.positions[0] - rest).norm());
            if (c == 6) {
                CHECK(motion.positions[0] == rest);
                CHECK(responses[c].norm() == 0);
                continue;
            }
            CHECK((motion.positions[0] - rest).cwiseAbs().maxCoeff() > least_strain);
            // Linear answers are those of a small part of the load.
            auto small = cases[c];
            small.loads[0].forces *= 1e-5;
            const Points<dim, double> part = record_static(model, small).motion.positions[0] - rest;
            CHECK((1e5 * part - responses[c]).norm() < 1e-3 * responses[c].norm());
        }
    };
    check(block<2>(Mat{1e4, 0.3}), 300., 0.1);
    check(block<3>(Mat{1e4, 0.45}), 300., 0.1);
}

TEST_CASE("static cases may be stopped, and those begun are kept") {
    const auto model = block<2>(fem::NeoHookean{1e4, 0.3});
    const auto cases = pushes<2>(model.rest_positions(), 100.);
    int reports = 0;
    const auto recordings = record_statics(model, cases, {.progress = [&](const Progress& progress) {
                                               CHECK(progress.stage == "record");
                                               return ++reports < 3;
                                           }});
    int recorded = 0;
    for (const auto& [motion, status] : recordings) {
        CHECK(motion.n_frames() == (status == Status::converged ? 1 : 0));
        CHECK((status == Status::converged || status == Status::interrupted));
        recorded += status == Status::converged;
    }
    CHECK(recorded == 3);
    CHECK(reports == 3);
    CHECK(record_statics(model, {}).empty());
}

TEST_CASE("a body that nothing holds has no linear response, and a static case that does not fit is refused") {
    const auto model = block<3>(fem::LinearElastic{1e4, 0.3});
    auto scenario = push<3, double>({}, 3, {1., 0., 0.});
    CHECK(linear_responses(model, {scenario})[0].cols() == 0);
    scenario.clamps[0].nodes = {1000};
    CHECK_THROWS_AS((void)record_static(model, scenario), InvalidArgument);
    CHECK_THROWS_AS((void)record_statics(model, {scenario}, {.time = std::nan("")}), InvalidArgument);
}

TEST_CASE("what a reference finds that is not finite, or of another size, is no equilibrium") {
    const Given good{Points<2, double>::Random(2, 4), Points<2, double>::Random(2, 4), Values<double>::Ones(4)};
    const auto scenario = push<2, double>({0}, 1, {1., 0.});
    CHECK(record_static(good, scenario).status == Status::converged);
    CHECK(linear_responses(good, {scenario})[0] == good.found);
    auto wrong = good;
    wrong.found(1, 3) = std::nan("");
    CHECK(record_static(wrong, scenario).status == Status::diverged);
    CHECK(record_static(wrong, scenario).motion.n_frames() == 0);
    CHECK(linear_responses(wrong, {scenario})[0].cols() == 0);
    auto loads = scenario;
    loads.loads[0].amplitude = [](double) { return std::nan(""); };
    CHECK(record_static(good, loads).status == Status::diverged);
    wrong.found.resize(2, 3);
    wrong.found.setZero();
    CHECK_THROWS_WITH_AS((void)record_static(wrong, scenario), "reference: expected positions [2 x 4], found [2 x 3]",
                         InvalidArgument);
    CHECK_THROWS_WITH_AS((void)linear_responses(wrong, {scenario}),
                         "reference: expected a displacement [2 x 4], found [2 x 3]", InvalidArgument);
    wrong = good;
    wrong.node_masses.resize(2);
    CHECK_THROWS_AS((void)record_static(wrong, scenario), InvalidArgument);
}
