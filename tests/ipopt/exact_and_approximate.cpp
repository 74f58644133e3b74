// SPDX-License-Identifier: BSD-3-Clause
#include "../fit/fit_data.hpp"

#include <springfit/fit/acceleration/dominant_term.hpp>
#include <springfit/ipopt/exact.hpp>
#include <springfit/motion/record.hpp>
#include <springfit/simulate/symplectic_euler.hpp>

using namespace springfit;
using test::Random;

namespace {

struct Solver {
    std::string name;
    std::function<AccelerationReport(const AccelerationProblem&)> solve;
};

const std::vector<Solver>& solvers() {
    static const std::vector<Solver> all{
        {"exact", [](const AccelerationProblem& p) { return ipopt::exact(p); }},
        {"one pass", [](const AccelerationProblem& p) { return one_pass(p); }},
        {"sweeps from one pass", [](const AccelerationProblem& p) { return dominant_term(p); }},
        {"sweeps from the prior",
         [](const AccelerationProblem& p) {
             return dominant_term(p, {.max_sweeps = 3000, .tolerance = 1e-13, .start = SweepStart::given});
         }},
    };
    return all;
}

/// A plane mesh as displacement frames, exactly affine ones or one node moving at a time.
std::vector<Points<2, double>> affine_frames(const Points<2, double>& nodes, double size) {
    std::vector<Points<2, double>> frames;
    for (int entry = 0; entry < 4; ++entry) {
        Eigen::Matrix2d gradient = Eigen::Matrix2d::Zero();
        gradient(entry / 2, entry % 2) = size;
        frames.push_back(gradient * nodes);
    }
    return frames;
}

std::vector<Points<2, double>> single_node_frames(const Points<2, double>& nodes, double size) {
    std::vector<Points<2, double>> frames;
    for (Index coordinate = 0; coordinate < nodes.size(); ++coordinate) {
        frames.push_back(Points<2, double>::Zero(2, nodes.cols()));
        frames.back()(coordinate % 2, coordinate / 2) = size;
    }
    return frames;
}

/// Bilinear square of side 1, plane stress, by 2 x 2 Gauss points; corners in the order of `quad_grid`.
DenseMatrix<double> square_stiffness(double young, double poisson) {
    const double mu = young / (2 * (1 + poisson));
    const double lambda = young * poisson / (1 - poisson * poisson);
    DenseMatrix<double> k = DenseMatrix<double>::Zero(8, 8);
    for (int point = 0; point < 4; ++point) {
        const double x = 0.5 + (point % 2 == 0 ? -0.5 : 0.5) / std::sqrt(3.);
        const double y = 0.5 + (point / 2 == 0 ? -0.5 : 0.5) / std::sqrt(3.);
        Eigen::Matrix<double, 4, 2> g;
        g << y - 1, x - 1, 1 - y, -x, -y, 1 - x, y, x; // nodes (0,0), (1,0), (0,1), (1,1)
        for (int a = 0; a < 4; ++a) {
            for (int b = 0; b < 4; ++b) {
                const Eigen::Vector2d ga = g.row(a);
                const Eigen::Vector2d gb = g.row(b);
                k.block<2, 2>(2 * a, 2 * b) += 0.25 * (lambda * ga * gb.transpose() + mu * gb * ga.transpose() +
                                                       mu * ga.dot(gb) * Eigen::Matrix2d::Identity());
            }
        }
    }
    return k;
}

} // namespace

TEST_CASE_TEMPLATE("a spring model is recovered by every solver", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    constexpr bool in_double = std::same_as<Scalar, double>;
    Random random(51);
    for (auto body : test::bodies<dim, Scalar>()) {
        for (int variant = 0; variant < 4; ++variant) {
            const bool damped = variant % 2 == 1;
            const bool rest_lengths = variant >= 2;
            CAPTURE(body.name);
            CAPTURE(damped);
            CAPTURE(rest_lengths);
            auto truth = body.network;
            test::randomise(truth, damped, random);
            auto network = truth;
            network.stiffness.setConstant(1);
            network.damping.setZero();
            if (rest_lengths) {
                for (Scalar& l : truth.rest_length) {
                    l *= static_cast<Scalar>(random(0.8, 1.2));
                }
            }
            const auto motion = test::random_motion<dim, Scalar>(truth, body.clamped, 80, random);
            AccelerationOptions<Scalar> options;
            options.parameters.damping.fit = damped;
            options.parameters.preload.fit = rest_lengths;
            const AccelerationProblem problem = acceleration_problem<dim, Scalar>(network, {motion}, options);
            for (const Solver& solver : solvers()) {
                CAPTURE(solver.name);
                const AccelerationReport report = solver.solve(problem);
                CHECK(usable(report.status));
                auto fitted = network;
                apply(problem, report, fitted);
                CHECK(test::relative_error(problem.parameters, ParameterKind::stiffness, fitted.stiffness,
                                           truth.stiffness) < (in_double ? 1e-6 : 1e-3));
                if (damped) {
                    CHECK(test::relative_error(problem.parameters, ParameterKind::damping, fitted.damping,
                                               truth.damping) < (in_double ? 1e-6 : 1e-2));
                }
                if (rest_lengths) {
                    CHECK(test::relative_error(problem.parameters, ParameterKind::preload, fitted.rest_length,
                                               truth.rest_length) < (in_double ? 1e-6 : 1e-3));
                }
            }
        }
    }
}

TEST_CASE_TEMPLATE("a simulated spring model, let go far from equilibrium, is recovered by every solver", T,
                   test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    Random random(52);
    for (const bool damped : {false, true}) {
        for (auto body : test::bodies<dim, double>()) {
            CAPTURE(body.name);
            CAPTURE(damped);
            auto truth = body.network;
            test::randomise(truth, damped, random);
            truth.mass.setConstant(1);
            std::vector<Motion<dim, double>> motions;
            for (int start = 0; start < 3; ++start) {
                Scenario<dim, double> scenario;
                scenario.name = "let go";
                scenario.clamps.push_back({body.clamped, {}});
                scenario.initial_positions = truth.rest_positions + random.points<dim, double>(truth.n_nodes(), 0.06);
                scenario.initial_velocities = random.points<dim, double>(truth.n_nodes(), 1);
                SymplecticEuler<dim, double> stepper(truth);
                const auto recording = record_stepper(stepper, scenario, {.dt = 0.01, .frames = 60});
                REQUIRE(recording.status == Status::converged);
                motions.push_back(recording.motion);
            }
            auto network = truth;
            network.stiffness.setConstant(1);
            network.damping.setZero();
            AccelerationOptions<double> options;
            options.parameters.damping.fit = damped;
            const AccelerationProblem problem = acceleration_problem<dim, double>(network, motions, options);
            for (const Solver& solver : solvers()) {
                CAPTURE(solver.name);
                auto fitted = network;
                apply(problem, solver.solve(problem), fitted);
                CHECK(test::relative_error(problem.parameters, ParameterKind::stiffness, fitted.stiffness,
                                           truth.stiffness) < 1e-6);
                if (damped) {
                    CHECK(test::relative_error(problem.parameters, ParameterKind::damping, fitted.damping,
                                               truth.damping) < 1e-6);
                }
            }
        }
    }
}

TEST_CASE("equilateral triangles at nu = 1/3: sqrt(3)/4 E h from each triangle at the edge") {
    const double young = 2000;
    const auto mesh = equilateral_triangles<double>(5, 4, 0.5);
    auto network = test::network_at_rest<2, double>(mesh.nodes, edges(mesh));
    std::vector<int> triangles(std::size_t(network.n_springs()), 0);
    for (Index e = 0; e < network.n_springs(); ++e) {
        for (Index c = 0; c < mesh.n_cells(); ++c) {
            const auto has = [&](int node) { return (mesh.cells.col(c).array() == node).any(); };
            triangles[std::size_t(e)] += has(network.springs(0, e)) && has(network.springs(1, e)) ? 1 : 0;
        }
    }
    const auto stiffness = test::simplex_stiffness(mesh, young, 1. / 3);
    Random random(53);
    std::vector<Points<2, double>> displacements;
    for (int frame = 0; frame < 60; ++frame) {
        displacements.push_back(random.points<2, double>(mesh.n_nodes(), 1e-8));
    }
    const auto motion = test::linear_motion<2>(network, stiffness, displacements);
    const AccelerationProblem problem = acceleration_problem<2, double>(network, {motion});
    for (const Solver& solver : solvers()) {
        CAPTURE(solver.name);
        apply(problem, solver.solve(problem), network);
        for (Index e = 0; e < network.n_springs(); ++e) {
            const double expected = triangles[std::size_t(e)] * std::sqrt(3.) / 4 * young;
            CHECK(test::relative(network.stiffness(e), expected, expected) < 1e-5);
        }
    }
}

TEST_CASE("a square at nu = 1/3: 3/8 and 3/8 from affine motion, 17/56 and 23/56 from nodal noise") {
    const double young = 10;
    auto cell = quad_grid<double>({1, 1}, {1, 1});
    const auto network = test::network_at_rest<2, double>(cell.nodes, test::join(edges(cell), diagonals(cell)));
    const auto stiffness = square_stiffness(young, 1. / 3);
    AccelerationOptions<double> options;
    options.parameters.stiffness.ties = {0, 0, 0, 0, 1, 1};
    struct Answer {
        std::vector<Points<2, double>> frames;
        double edge, diagonal;
    };
    const double size = 1e-7;
    for (const Answer& answer : {Answer{affine_frames(cell.nodes, size), 3. / 8, 3. / 8},
                                 Answer{single_node_frames(cell.nodes, size), 17. / 56, 23. / 56}}) {
        CAPTURE(answer.edge);
        const auto motion = test::linear_motion<2>(network, stiffness, answer.frames);
        const AccelerationProblem problem = acceleration_problem<2, double>(network, {motion}, options);
        for (const AccelerationReport& report : {ipopt::exact(problem), dominant_term(problem)}) {
            CHECK(report.status == Status::converged);
            CHECK(test::relative(report.theta(0), answer.edge * young, young) < 1e-5);
            CHECK(test::relative(report.theta(1), answer.diagonal * young, young) < 1e-5);
        }
    }
}

TEST_CASE_TEMPLATE("where springs cannot represent the material, fifty sweeps come within 1 % of exact", T,
                   test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto mesh = [] {
        if constexpr (dim == 2) {
            auto triangles = triangle_grid<double>({10, 8}, {1.25, 1});
            jitter(triangles, 0.3, 6u);
            return triangles;
        } else {
            auto tets = tetrahedron_grid<double>({4, 3, 3}, {1, 0.75, 0.75});
            jitter(tets, 0.2, 6u);
            return tets;
        }
    }();
    auto network = test::network_at_rest<dim, double>(mesh.nodes, edges(mesh));
    Random random(54);
    for (double& m : network.mass) {
        m = random(0.5, 2);
    }
    network.stiffness.setConstant(100);
    for (const double poisson : {0.25, 0.45}) {
        const auto stiffness = test::simplex_stiffness(mesh, 1000., poisson);
        std::vector<Points<dim, double>> noise;
        for (int frame = 0; frame < 40; ++frame) {
            noise.push_back(random.points<dim, double>(mesh.n_nodes(), 1e-4));
        }
        const auto smooth = test::smooth_fields<dim>(mesh.nodes, 40, 1e-3, 0.3, random);
        struct Data {
            std::string name;
            Motion<dim, double> motion;
        };
        for (const Data& data : {Data{"noise", test::linear_motion<dim>(network, stiffness, noise)},
                                 Data{"smooth", test::linear_motion<dim>(network, stiffness, smooth)},
                                 Data{"vibration", test::vibration<dim>(network, stiffness, 100, 1e-3, random)}}) {
            CAPTURE(poisson);
            CAPTURE(data.name);
            const AccelerationProblem problem = acceleration_problem<dim, double>(network, {data.motion});
            const AccelerationReport exact = ipopt::exact(problem);
            CHECK(exact.status == Status::converged);
            CHECK(exact.objective > 0);
            CHECK(one_pass(problem).objective > exact.objective);
            for (const SweepStart start : {SweepStart::one_pass, SweepStart::given}) {
                const AccelerationReport sweeps = dominant_term(problem, {.max_sweeps = 50, .start = start});
                double before = sweeps.objective_start;
                for (double value : sweeps.history) {
                    CHECK(value <= before);
                    before = value;
                }
                CHECK(sweeps.objective >= exact.objective * (1 - 1e-9));
                CHECK(sweeps.objective <= 1.01 * exact.objective);
            }
        }
    }
}
