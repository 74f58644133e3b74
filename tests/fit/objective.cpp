// SPDX-License-Identifier: BSD-3-Clause
#include "fit_data.hpp"
#include "threads.hpp"

#include <numeric>

#include <springfit/fit/acceleration/dominant_term.hpp>

using namespace springfit;
using test::Random;

namespace {

/// The rows of the residual A theta - y, each with its weight, one after another, for checking.
struct Rows {
    DenseMatrix<double> a;
    Values<double> y;
};

template <int Dim, class Scalar>
void append_rows(const SpringNetwork<Dim, Scalar>& network, const Motion<Dim, Scalar>& motion,
                 const Parameters& parameters, const Values<double>& node_weights, double weight, Rows& rows) {
    Index row = rows.y.size();
    const Index total = row + Dim * motion.n_frames() * (network.n_nodes() - Index(motion.clamped.size()));
    rows.a.conservativeResize(total, parameters.n_unknowns());
    rows.y.conservativeResize(total);
    for (std::size_t t = 0; t < motion.times.size(); ++t) {
        const Points<Dim, double> x = motion.positions[t].template cast<double>();
        const Points<Dim, double> v = motion.velocities[t].template cast<double>();
        for (int i = 0; i < network.n_nodes(); ++i) {
            if (std::find(motion.clamped.begin(), motion.clamped.end(), i) != motion.clamped.end()) {
                continue;
            }
            const double m = double(network.mass(i));
            const double root = std::sqrt(weight * node_weights(i));
            DenseMatrix<double> a = DenseMatrix<double>::Zero(Dim, parameters.n_unknowns());
            Values<double> y = motion.accelerations[t].col(i).template cast<double>() -
                               motion.external_forces[t].col(i).template cast<double>() / m;
            for (int e = 0; e < network.n_springs(); ++e) {
                for (int side = 0; side < 2; ++side) {
                    if (network.springs(side, e) != i) {
                        continue;
                    }
                    const int j = network.springs(1 - side, e);
                    const double length = (x.col(j) - x.col(i)).norm();
                    const Vector<Dim, double> n = (x.col(j) - x.col(i)) / length;
                    const auto put = [&](ParameterKind kind, double factor, double known) {
                        const int u = parameters.unknown(kind, e);
                        if (u >= 0) {
                            a.col(u) += factor / m * n;
                        } else {
                            y -= known * factor / m * n;
                        }
                    };
                    put(ParameterKind::stiffness, length - double(network.rest_length(e)),
                        double(network.stiffness(e)));
                    put(ParameterKind::damping, (v.col(j) - v.col(i)).dot(n), double(network.damping(e)));
                    put(ParameterKind::preload, -1, 0);
                }
            }
            rows.a.middleRows(row, Dim) = root * a;
            rows.y.segment(row, Dim) = root * y;
            row += Dim;
        }
    }
}

template <int Dim, class Scalar>
void check_against_rows(const AccelerationProblem& problem, const Rows& rows, Random& random) {
    const auto& objective = problem.objective;
    Values<double> theta(problem.n_unknowns());
    for (double& value : theta) {
        value = random(-3, 3);
    }
    const double tolerance = 1e-12;
    const double value = (rows.a * theta - rows.y).squaredNorm();
    CHECK(test::relative(objective.value(theta), value, value) < tolerance);
    const Values<double> gradient = 2 * rows.a.transpose() * (rows.a * theta - rows.y);
    CHECK(test::relative_difference(objective.gradient(theta), gradient) < tolerance);
    const DenseMatrix<double> hessian = 2 * rows.a.transpose() * rows.a;
    CHECK(test::relative_difference(objective.product(theta), hessian * theta) < tolerance);
    CHECK(test::relative_difference(objective.curvature(), hessian.diagonal()) < tolerance);
    const DenseMatrix<double> lower = objective.hessian();
    CHECK(test::relative_difference(lower, DenseMatrix<double>(hessian.triangularView<Eigen::Lower>())) < tolerance);
}

} // namespace

TEST_CASE_TEMPLATE("the streamed objective is that of the rows", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    Random random(21);
    for (auto body : test::bodies<dim, Scalar>()) {
        CAPTURE(body.name);
        auto& network = body.network;
        test::randomise(network, true, random);
        // Two motions under different clamps, one with more frames than a batch holds.
        const auto first = test::random_motion<dim, Scalar>(network, body.clamped, 3, random);
        const auto second = test::random_motion<dim, Scalar>(network, {2}, 37, random);
        for (int variant = 0; variant < 4; ++variant) {
            CAPTURE(variant);
            AccelerationOptions<Scalar> options;
            options.parameters.damping.fit = variant >= 1;
            options.parameters.preload.fit = variant >= 2;
            options.weighting = std::array{NodeWeighting::acceleration, NodeWeighting::force, NodeWeighting::mass,
                                           NodeWeighting::acceleration}[static_cast<std::size_t>(variant)];
            Values<double> weights = Values<double>::Ones(network.n_nodes());
            if (variant == 3) { // ties and the user's own weights
                for (int e = 0; e < network.n_springs(); ++e) {
                    options.parameters.stiffness.ties.push_back(7 * (e % 5));
                    options.parameters.damping.ties.push_back(-(e % 2));
                }
                for (double& w : weights) {
                    w = random(0, 2);
                }
                options.node_weights = weights;
            }
            AccelerationObjective<dim, Scalar> objective(network, options);
            objective.add(first, 0.5);
            objective.add(second);
            const AccelerationProblem problem = objective.problem();
            const Values<double> m = network.mass.template cast<double>();
            if (options.weighting == NodeWeighting::mass) {
                weights = weights.cwiseProduct(m);
            } else if (options.weighting == NodeWeighting::force) {
                weights = weights.cwiseProduct(m.cwiseAbs2());
            }
            Rows rows;
            append_rows(network, first, problem.parameters, weights, 0.5, rows);
            append_rows(network, second, problem.parameters, weights, 1, rows);
            check_against_rows<dim, Scalar>(problem, rows, random);
        }
    }
}

TEST_CASE_TEMPLATE("frame by frame is the same as a motion, on any number of threads", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    Random random(22);
    auto body = test::bodies<dim, Scalar>().front();
    test::randomise(body.network, true, random);
    const auto motion = test::random_motion<dim, Scalar>(body.network, body.clamped, 40, random);
    AccelerationOptions<Scalar> options;
    options.parameters.damping.fit = true;
    // An execution that runs the chunks in the opposite order, as threads might.
    AccelerationObjective<dim, Scalar> whole(body.network, options);
    AccelerationObjective<dim, Scalar> frames(body.network, options, test::backwards_on_threads());
    whole.add(motion);
    for (std::size_t t = 0; t < motion.times.size(); ++t) {
        frames.add_frame(motion.positions[t], motion.velocities[t], motion.accelerations[t], motion.external_forces[t],
                         motion.clamped);
    }
    const AccelerationProblem a = whole.problem();
    const AccelerationProblem b = frames.problem();
    CHECK(a.objective.linear() == b.objective.linear());
    CHECK((a.objective.hessian() - b.objective.hessian()).norm() == 0);
    CHECK(one_pass(a).theta == one_pass(b, {.execution = test::backwards_on_threads()}).theta);
    // More frames may follow.
    whole.add(motion);
    CHECK(test::relative_difference(whole.problem().objective.linear(), 2 * a.objective.linear()) < 1e-13);
}

TEST_CASE_TEMPLATE("cells act as the network gives them: its springs are found, without the cells they are not", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    Random random(24);
    auto body = test::bodies<dim, Scalar>().front();
    auto& network = body.network;
    test::randomise(network, true, random);
    if constexpr (dim == 2) {
        auto mesh = triangle_grid<Scalar>({5, 4}, {Scalar(1.25), Scalar(1)});
        jitter(mesh, Scalar(0.3), 11u);
        add_volume_cells(network, mesh);
    } else {
        auto mesh = tetrahedron_grid<Scalar>({2, 2, 2}, {Scalar(0.5), Scalar(0.5), Scalar(0.5)});
        jitter(mesh, Scalar(0.2), 13u);
        add_volume_cells(network, mesh);
    }
    for (Scalar& kappa : network.volume_stiffness) {
        kappa = static_cast<Scalar>(random(-1000, 3000));
    }
    const auto motion = test::random_motion<dim, Scalar>(network, body.clamped, 40, random);
    const auto error_with = [&](const SpringNetwork<dim, Scalar>& known) {
        const AccelerationProblem problem = acceleration_problem<dim, Scalar>(known, {motion});
        const DenseMatrix<double> lower = problem.objective.hessian();
        const Values<double> theta =
            DenseMatrix<double>(lower.selfadjointView<Eigen::Lower>())
                .ldlt()
                .solve(-problem.objective.gradient(Values<double>::Zero(problem.n_unknowns())));
        auto found = network;
        apply(problem, theta, found);
        return test::relative_error(problem.parameters, ParameterKind::stiffness, found.stiffness, network.stiffness);
    };
    CHECK(error_with(network) < (std::same_as<Scalar, float> ? 1e-4 : 1e-9));
    auto unknown = network;
    unknown.volume_stiffness.setZero();
    CHECK(error_with(unknown) > 0.1);
}

TEST_CASE_TEMPLATE("what cannot be fitted is refused", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    using Objective = AccelerationObjective<dim, Scalar>;
    Random random(23);
    auto body = test::bodies<dim, Scalar>().front();
    auto& network = body.network;
    const auto motion = test::random_motion<dim, Scalar>(network, body.clamped, 2, random);
    Objective objective(network);
    const auto refused = [&](auto change) {
        auto bad = motion;
        change(bad);
        CHECK_THROWS_AS(objective.add(bad), InvalidArgument);
    };
    refused([](auto& m) { m.positions[1](0, 0) = std::numeric_limits<Scalar>::quiet_NaN(); });
    refused([](auto& m) { m.accelerations[0](1, 2) = std::numeric_limits<Scalar>::infinity(); });
    refused([](auto& m) { m.velocities.pop_back(); });
    refused([](auto& m) { m.clamped = {int(m.n_nodes())}; });
    refused([](auto& m) {
        m.rest_positions.conservativeResize(Eigen::NoChange, m.n_nodes() - 1);
        for (auto* frames : {&m.positions, &m.velocities, &m.accelerations, &m.external_forces}) {
            for (auto& frame : *frames) {
                frame.conservativeResize(Eigen::NoChange, frame.cols() - 1);
            }
        }
    });
    CHECK_THROWS_AS(objective.add(motion, -1), InvalidArgument);
    CHECK_THROWS_AS(objective.add(motion, std::nan("")), InvalidArgument);
    CHECK_THROWS_WITH_AS(objective.add_frame(motion.positions[0], motion.velocities[0], motion.accelerations[0],
                                             Points<dim, Scalar>::Zero(dim, 3), {}),
                         doctest::Contains("nodes"), InvalidArgument);

    const auto refused_options = [&](auto change) {
        AccelerationOptions<Scalar> options;
        change(options);
        CHECK_THROWS_AS(Objective(network, options), InvalidArgument);
    };
    refused_options([](auto& o) { o.parameters.stiffness.lower = 2, o.parameters.stiffness.upper = 1; });
    refused_options([](auto& o) { o.parameters.stiffness.lower = std::nan(""); });
    refused_options([](auto& o) { o.parameters.stiffness.ties = {1, 2}; });
    refused_options([](auto& o) { o.parameters.stiffness.prior = Values<double>::Ones(3); });
    refused_options(
        [&](auto& o) { o.parameters.stiffness.prior = Values<double>::Constant(network.n_springs(), std::nan("")); });
    refused_options([](auto& o) { o.parameters.ridge = -1; });
    refused_options([](auto& o) { o.parameters.stiffness.fit = false; });
    refused_options([](auto& o) { o.identified = 0; });
    refused_options([](auto& o) { o.node_weights = Values<double>::Ones(2); });
    refused_options([&](auto& o) { o.node_weights = Values<double>::Constant(network.n_nodes(), -1); });
}

TEST_CASE_TEMPLATE("springs that never move freely have no unknown; ties give them their group's value", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    Random random(24);
    auto body = test::bodies<dim, Scalar>().front();
    auto& network = body.network;
    const auto motion = test::random_motion<dim, Scalar>(network, body.clamped, 4, random);
    const int between = 0; // edges ascend, so the first joins the clamped nodes 0 and 1
    REQUIRE(network.springs(0, between) == 0);
    REQUIRE(network.springs(1, between) == 1);
    network.stiffness(between) = 42;

    AccelerationProblem problem = acceleration_problem<dim, Scalar>(network, {motion});
    CHECK(problem.n_unknowns() == network.n_springs() - 1);
    CHECK(problem.parameters.without_unknown() == std::vector<SpringParameter>{{ParameterKind::stiffness, between}});
    const AccelerationReport report = one_pass(problem);
    CHECK(report.without_unknown.size() == 1);
    apply(problem, report, network);
    CHECK(network.stiffness(between) == 42);
    auto smaller = network;
    smaller.springs.conservativeResize(2, network.n_springs() - 1);
    CHECK_THROWS_WITH_AS(
        apply(problem, report, smaller),
        text("network: expected ", network.n_springs(), " springs, found ", smaller.n_springs()).c_str(),
        InvalidArgument);

    // One clamp that leaves both free gives the spring its unknown.
    auto other = motion;
    other.clamped = {3};
    CHECK(acceleration_problem<dim, Scalar>(network, {motion, other}).parameters.without_unknown().empty());

    AccelerationOptions<Scalar> tied;
    tied.parameters.stiffness.ties.assign(static_cast<std::size_t>(network.n_springs()), 3);
    problem = acceleration_problem<dim, Scalar>(network, {motion}, tied);
    CHECK(problem.n_unknowns() == 1);
    CHECK(problem.parameters.per_spring(ParameterKind::stiffness, Values<double>::Constant(1, 5.))(between) == 5);

    // All clamped: nothing to fit, everything kept.
    auto still = motion;
    still.clamped.resize(static_cast<std::size_t>(network.n_nodes()));
    std::iota(still.clamped.begin(), still.clamped.end(), 0);
    problem = acceleration_problem<dim, Scalar>(network, {still});
    CHECK(problem.n_unknowns() == 0);
    for (const AccelerationReport& r : {one_pass(problem), dominant_term(problem)}) {
        CHECK(r.status == Status::converged);
        const auto before = network.stiffness;
        apply(problem, r, network);
        CHECK(network.stiffness == before);
        CHECK(Index(r.without_unknown.size()) == network.n_springs());
    }
}

TEST_CASE("a ridge pulls to the prior, the more the less the data says") {
    Random random(25);
    auto body = test::bodies<2, double>().front();
    test::randomise(body.network, false, random);
    const auto motion = test::random_motion<2, double>(body.network, body.clamped, 10, random);
    AccelerationOptions<double> options;
    options.parameters.stiffness.prior = Values<double>::Constant(body.network.n_springs(), 7.);
    options.parameters.ridge = 1e6;
    const AccelerationProblem strong = acceleration_problem<2, double>(body.network, {motion}, options);
    const AccelerationReport report = dominant_term(strong);
    CHECK(report.status == Status::converged);
    CHECK((report.theta.array() - 7).abs().maxCoeff() < 1e-2);
    CHECK(test::relative(strong.objective.value(strong.prior),
                         acceleration_problem<2, double>(body.network, {motion}).objective.value(strong.prior),
                         strong.objective.value(strong.prior)) < 1e-12);
    // Gradient by differences, with the ridge in it.
    Values<double> theta = Values<double>::LinSpaced(strong.n_unknowns(), 1, 9);
    const Values<double> gradient = strong.objective.gradient(theta);
    for (Index u : {Index(0), Index(5), strong.n_unknowns() - 1}) {
        theta(u) += 1e-3;
        const double above = strong.objective.value(theta);
        theta(u) -= 2e-3;
        const double below = strong.objective.value(theta);
        theta(u) += 1e-3;
        CHECK(test::relative((above - below) / 2e-3, gradient(u), gradient.cwiseAbs().maxCoeff()) < 1e-5);
    }
}
