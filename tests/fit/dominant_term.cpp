// SPDX-License-Identifier: BSD-3-Clause
#include "fit_data.hpp"

#include <numeric>

#include <springfit/fit/acceleration/dominant_term.hpp>

using namespace springfit;
using test::Random;

TEST_CASE("the tiny bounded least squares is exact") {
    // Against every choice of active bounds, for small random problems with some near-singular ones among them.
    Random random(31);
    BoundedLeastSquares solver;
    for (int trial = 0; trial < 300; ++trial) {
        CAPTURE(trial);
        const Index n = 1 + trial % 5;
        const DenseMatrix<double> a = random.points<2, double>(n, 1).transpose();
        DenseMatrix<double> h = a * a.transpose();
        h.diagonal().array() += trial % 3 == 0 ? 1e-5 : 0.3;
        const Values<double> g = random.points<3, double>(n, 2).row(0).transpose();
        Values<double> lower = Values<double>::Constant(n, -0.5);
        Values<double> upper = Values<double>::Constant(n, 0.8);
        if (trial % 4 == 0) {
            lower.setConstant(-std::numeric_limits<double>::infinity());
        }
        if (trial % 7 == 0) {
            upper(0) = lower(0) = 0.25; // held
        }
        Values<double> x = Values<double>::Constant(n, 0.25);
        CHECK(solver.solve(h, g, lower, upper, x));
        CHECK((x.array() >= lower.array()).all());
        CHECK((x.array() <= upper.array()).all());
        const auto value = [&](const Values<double>& at) { return at.dot(0.5 * h * at - g); };
        double best = value(x);
        int choices = 1;
        for (Index j = 0; j < n; ++j) {
            choices *= 3;
        }
        for (int choice = 0; choice < choices; ++choice) {
            Values<double> y(n);
            std::vector<Index> free;
            bool finite = true;
            for (Index j = 0, rest = choice; j < n; ++j, rest /= 3) {
                if (rest % 3 == 0) {
                    free.push_back(j);
                }
                y(j) = rest % 3 == 0 ? 0 : rest % 3 == 1 ? lower(j) : upper(j);
                finite = finite && std::isfinite(y(j));
            }
            if (!finite) {
                continue;
            }
            const Values<double> pull = (g - h * y)(free);
            const DenseMatrix<double> block = h(free, free);
            y(free) = Values<double>(block.ldlt().solve(pull));
            if ((y.array() >= lower.array()).all() && (y.array() <= upper.array()).all()) {
                best = std::min(best, value(y));
            }
        }
        CHECK(value(x) - best <= 1e-9 * std::max(1., std::abs(best)));
    }
}

TEST_CASE("the heap hands out items by decreasing key, also when keys change") {
    Random random(32);
    std::vector<double> keys(100);
    for (double& key : keys) {
        key = random(0, 1);
    }
    detail::IndexedHeap heap;
    heap.fill(keys);
    std::vector<bool> out(keys.size(), false);
    for (int step = 0; !heap.empty(); ++step) {
        const auto changed = static_cast<std::size_t>(random(0, 99.99));
        keys[changed] = random(0, 1);
        heap.update(static_cast<int>(changed), keys[changed]);
        const auto top = static_cast<std::size_t>(heap.pop());
        CHECK_FALSE(out[top]);
        out[top] = true;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            CHECK((out[i] || keys[i] <= keys[top]));
        }
    }
    CHECK(std::count(out.begin(), out.end(), true) == 100);
}

TEST_CASE_TEMPLATE("one pass and sweeps recover a spring model", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    constexpr bool in_double = std::same_as<Scalar, double>;
    Random random(33);
    for (auto body : test::bodies<dim, Scalar>()) {
        for (const bool damped : {false, true}) {
            CAPTURE(body.name);
            CAPTURE(damped);
            auto truth = body.network;
            test::randomise(truth, damped, random);
            const auto motion = test::random_motion<dim, Scalar>(truth, body.clamped, 40, random);
            auto network = truth;
            network.stiffness.setConstant(1);
            network.damping.setConstant(0);
            AccelerationOptions<Scalar> options;
            options.parameters.damping.fit = damped;
            const AccelerationProblem problem = acceleration_problem<dim, Scalar>(network, {motion}, options);
            const AccelerationReport pass = one_pass(problem);
            const AccelerationReport from_pass = dominant_term(problem);
            const AccelerationReport from_prior =
                dominant_term(problem, {.max_sweeps = 300, .tolerance = 1e-12, .start = SweepStart::given});
            for (const AccelerationReport* report : {&pass, &from_pass, &from_prior}) {
                CHECK(usable(report->status));
                CHECK(report->kkt_residual < (in_double ? 1e-9 : 1e-5));
                auto fitted = network;
                apply(problem, *report, fitted);
                CHECK(test::relative_error(problem.parameters, ParameterKind::stiffness, fitted.stiffness,
                                           truth.stiffness) < (in_double ? 1e-6 : 1e-4));
                if (damped) {
                    CHECK(test::relative_error(problem.parameters, ParameterKind::damping, fitted.damping,
                                               truth.damping) < (in_double ? 1e-6 : 1e-2));
                }
            }
        }
    }
}

TEST_CASE_TEMPLATE("rest lengths are fitted, and known damping is taken off", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    constexpr bool in_double = std::same_as<Scalar, double>;
    Random random(34);
    for (auto body : test::bodies<dim, Scalar>()) {
        CAPTURE(body.name);
        auto truth = body.network;
        test::randomise(truth, true, random);
        for (Scalar& l : truth.rest_length) {
            l *= static_cast<Scalar>(random(0.8, 1.2));
        }
        const auto motion = test::random_motion<dim, Scalar>(truth, body.clamped, 60, random);
        auto network = body.network; // its rest lengths are those of the shape
        network.mass = truth.mass;
        network.damping = truth.damping;
        AccelerationOptions<Scalar> options;
        options.parameters.preload.fit = true;
        const AccelerationProblem problem = acceleration_problem<dim, Scalar>(network, {motion}, options);
        for (const AccelerationReport& report : {one_pass(problem), dominant_term(problem)}) {
            auto fitted = network;
            apply(problem, report, fitted);
            const double tolerance = in_double ? 1e-6 : 1e-3;
            CHECK(test::relative_error(problem.parameters, ParameterKind::stiffness, fitted.stiffness,
                                       truth.stiffness) < tolerance);
            CHECK(test::relative_error(problem.parameters, ParameterKind::preload, fitted.rest_length,
                                       truth.rest_length) < tolerance);
            CHECK(fitted.damping == truth.damping);
        }
        // The other way round: stiffness known, damping fitted.
        network = truth;
        network.damping.setZero();
        options = {};
        options.parameters.stiffness.fit = false;
        options.parameters.damping.fit = true;
        const AccelerationProblem damping = acceleration_problem<dim, Scalar>(network, {motion}, options);
        apply(damping, one_pass(damping), network);
        CHECK(test::relative_error(damping.parameters, ParameterKind::damping, network.damping, truth.damping) <
              (in_double ? 1e-6 : 1e-2));
    }
}

TEST_CASE_TEMPLATE("damping that follows stiffness needs no unknown of its own", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    Random random(39);
    for (auto body : test::bodies<dim, Scalar>()) {
        CAPTURE(body.name);
        auto truth = body.network;
        test::randomise(truth, false, random);
        truth.damping = Scalar(2e-3) * truth.stiffness;
        const auto motion = test::random_motion<dim, Scalar>(truth, body.clamped, 40, random);
        auto network = truth;
        network.stiffness.setConstant(1);
        network.damping.setConstant(9); // replaced
        AccelerationOptions<Scalar> options;
        options.parameters.damping_per_stiffness = 2e-3;
        const AccelerationProblem problem = acceleration_problem<dim, Scalar>(network, {motion}, options);
        for (const AccelerationReport& report : {one_pass(problem), dominant_term(problem)}) {
            auto fitted = network;
            apply(problem, report, fitted);
            for (ParameterKind kind : {ParameterKind::stiffness, ParameterKind::damping}) {
                const auto& found = kind == ParameterKind::stiffness ? fitted.stiffness : fitted.damping;
                const auto& wanted = kind == ParameterKind::stiffness ? truth.stiffness : truth.damping;
                for (Index e = 0; e < network.n_springs(); ++e) {
                    if (problem.parameters.unknown(ParameterKind::stiffness, e) >= 0) {
                        CHECK(test::relative(found(e), wanted(e), wanted(e)) <
                              (std::same_as<Scalar, double> ? 1e-6 : 1e-3));
                    }
                }
            }
        }
        options.parameters.damping.fit = true;
        CHECK_THROWS_AS((void)(acceleration_problem<dim, Scalar>(network, {motion}, options)), InvalidArgument);
    }
}

TEST_CASE_TEMPLATE("a spring that no motion excites gets its prior and is reported", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    Random random(35);
    auto body = test::bodies<dim, Scalar>().front();
    auto& network = body.network;
    test::randomise(network, false, random);
    const auto truth = network;
    // The last node moves with a neighbour, so the spring between them is never strained.
    const int quiet = static_cast<int>(network.n_springs()) - 1;
    const int i = network.springs(0, quiet);
    const int j = network.springs(1, quiet);
    auto motion = test::random_motion<dim, Scalar>(network, body.clamped, 40, random);
    const Vector<dim, Scalar> offset = network.rest_positions.col(j) - network.rest_positions.col(i);
    for (std::size_t t = 0; t < motion.times.size(); ++t) {
        motion.positions[t].col(j) = motion.positions[t].col(i) + offset;
        motion.velocities[t].col(j) = motion.velocities[t].col(i);
        motion.accelerations[t] = test::accelerations<dim, Scalar>(truth, motion.positions[t], motion.velocities[t],
                                                                   motion.external_forces[t]);
    }
    network.stiffness.setConstant(5);
    network.stiffness(quiet) = 17;
    const AccelerationProblem problem = acceleration_problem<dim, Scalar>(network, {motion});
    for (const AccelerationReport& report : {one_pass(problem), dominant_term(problem)}) {
        CHECK(report.not_identified == std::vector<SpringParameter>{{ParameterKind::stiffness, quiet}});
        CHECK(report.theta.allFinite());
        auto fitted = network;
        apply(problem, report, fitted);
        CHECK(fitted.stiffness(quiet) == 17);
        fitted.stiffness(quiet) = truth.stiffness(quiet);
        CHECK(test::relative_error(problem.parameters, ParameterKind::stiffness, fitted.stiffness, truth.stiffness) <
              (std::same_as<Scalar, double> ? 1e-6 : 1e-3));
    }
    // No motion at all: everything is prior.
    const AccelerationProblem nothing = AccelerationObjective<dim, Scalar>(network).problem();
    CHECK(nothing.n_unknowns() == 0);
    auto rest = motion;
    for (auto& x : rest.positions) {
        x = network.rest_positions;
    }
    for (auto* frames : {&rest.accelerations, &rest.external_forces}) {
        for (auto& frame : *frames) {
            frame.setZero();
        }
    }
    const AccelerationProblem still = acceleration_problem<dim, Scalar>(network, {rest});
    const AccelerationReport report = dominant_term(still, {.start = SweepStart::given});
    CHECK(report.theta.allFinite());
    if (std::same_as<Scalar, double>) {
        CHECK(report.objective < 1e-24); // strains of rounding only
    }
}

TEST_CASE_TEMPLATE("bounds hold to the last bit and active ones push the right way", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    Random random(36);
    for (auto body : test::bodies<dim, Scalar>()) {
        CAPTURE(body.name);
        auto network = body.network;
        test::randomise(network, false, random);
        const auto motion = test::random_motion<dim, Scalar>(network, body.clamped, 20, random);
        AccelerationOptions<Scalar> options;
        options.parameters.stiffness.lower = 250; // the truth spreads from 100 to 1000
        options.parameters.stiffness.upper = 600;
        const AccelerationProblem problem = acceleration_problem<dim, Scalar>(network, {motion}, options);
        const AccelerationReport report = dominant_term(problem, {.max_sweeps = 2000, .tolerance = 1e-10});
        CHECK(report.status == Status::converged);
        CHECK(report.theta.minCoeff() == 250);
        CHECK(report.theta.maxCoeff() == 600);
        CHECK(report.at_lower.size() > 0);
        CHECK(report.at_upper.size() > 0);
        CHECK(report.lower_multipliers.minCoeff() >= 0);
        CHECK(report.upper_multipliers.minCoeff() >= 0);
        const Values<double> gradient = problem.objective.gradient(report.theta);
        const double scale = problem.objective.linear().cwiseAbs().maxCoeff();
        CHECK((gradient - report.lower_multipliers + report.upper_multipliers).cwiseAbs().maxCoeff() < 1e-8 * scale);
        const auto pass = one_pass(problem);
        CHECK(pass.theta.minCoeff() >= 250);
        CHECK(pass.theta.maxCoeff() <= 600);

        // Equal bounds fix the value; the rest of the world goes on.
        options.parameters.stiffness.lower = options.parameters.stiffness.upper = 400;
        options.parameters.damping.fit = true;
        const AccelerationProblem fixed = acceleration_problem<dim, Scalar>(network, {motion}, options);
        const AccelerationReport with_fixed = dominant_term(fixed, {.max_sweeps = 500});
        CHECK((fixed.parameters.per_spring(ParameterKind::stiffness, with_fixed.theta).array() == 400).count() >=
              problem.n_unknowns());
        CHECK(with_fixed.objective < fixed.objective.value(fixed.prior));
    }
}

TEST_CASE_TEMPLATE("ties give one value per group", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    constexpr bool in_double = std::same_as<Scalar, double>;
    Random random(37);
    for (auto body : test::bodies<dim, Scalar>()) {
        CAPTURE(body.name);
        auto truth = body.network;
        test::randomise(truth, true, random);
        AccelerationOptions<Scalar> options;
        options.parameters.damping.fit = true;
        for (int e = 0; e < truth.n_springs(); ++e) {
            options.parameters.stiffness.ties.push_back(e % 3);
            options.parameters.damping.ties.push_back(10);
            truth.stiffness(e) = static_cast<Scalar>(100 * (1 + e % 3));
            truth.damping(e) = Scalar(0.5);
        }
        // Three frames would not do for free springs.
        const auto motion = test::random_motion<dim, Scalar>(truth, body.clamped, 3, random);
        const AccelerationProblem problem = acceleration_problem<dim, Scalar>(body.network, {motion}, options);
        CHECK(problem.n_unknowns() == 4);
        CHECK((body.network.mass.array() == 1).all());
        auto with_masses = body.network;
        with_masses.mass = truth.mass;
        const AccelerationProblem right = acceleration_problem<dim, Scalar>(with_masses, {motion}, options);
        for (const AccelerationReport& report : {one_pass(right), dominant_term(right)}) {
            auto fitted = with_masses;
            apply(right, report, fitted);
            CHECK(test::relative_difference(fitted.stiffness, truth.stiffness) < (in_double ? 1e-6 : 1e-3));
            CHECK(test::relative_difference(fitted.damping, truth.damping) < (in_double ? 1e-6 : 1e-2));
        }
        // With the wrong masses nothing fits; one block is the whole problem, so the first sweep ends it.
        const AccelerationReport wrong = dominant_term(problem, {.tolerance = 1e-8});
        CHECK(wrong.status == Status::converged);
        CHECK(wrong.objective > 0);
    }
}

TEST_CASE_TEMPLATE("sweeps never raise the objective, on a solid that springs cannot represent", T,
                   test::Space<2, double>, test::Space<3, double>) {
    constexpr int dim = T::dimension;
    Random random(38);
    const auto mesh = [] {
        if constexpr (dim == 2) {
            auto triangles = triangle_grid<double>({8, 6}, {1, 0.75});
            jitter(triangles, 0.3, 5u);
            return triangles;
        } else {
            auto tets = tetrahedron_grid<double>({3, 3, 2}, {0.75, 0.75, 0.5});
            jitter(tets, 0.2, 5u);
            return tets;
        }
    }();
    auto network = test::network_at_rest<dim, double>(mesh.nodes, edges(mesh));
    network.mass.setConstant(0.01);
    const auto motion = test::vibration<dim>(network, test::simplex_stiffness(mesh, 1000., 0.45), 60, 1e-3, random);
    const AccelerationProblem problem = acceleration_problem<dim, double>(network, {motion});
    for (const SweepStart start : {SweepStart::one_pass, SweepStart::given, SweepStart::better}) {
        const AccelerationReport report = dominant_term(problem, {.max_sweeps = 50, .tolerance = 0, .start = start});
        double before = report.objective_start;
        CHECK(report.history.size() == std::size_t(report.iterations));
        for (double value : report.history) {
            CHECK(value <= before);
            before = value;
        }
        CHECK(test::relative(report.objective, before, before) < 1e-9);
        CHECK(report.objective < report.objective_start);
        CHECK((report.theta.array() >= 0).all());
    }
    // `better` starts at the lower of the two.
    const auto start_of = [&](SweepStart start) {
        return dominant_term(problem, {.max_sweeps = 0, .start = start}).objective;
    };
    CHECK(start_of(SweepStart::better) == std::min(start_of(SweepStart::one_pass), start_of(SweepStart::given)));

    // A stop asked for after the third sweep keeps what the third sweep found.
    int calls = 0;
    const AccelerationReport stopped =
        dominant_term(problem, {.tolerance = 0, .progress = [&](const Progress&) { return ++calls < 3; }});
    CHECK(stopped.status == Status::interrupted);
    CHECK(stopped.iterations == 3);
    CHECK(stopped.objective == dominant_term(problem, {.max_sweeps = 3, .tolerance = 0}).objective);
    CHECK_THROWS_AS((void)dominant_term(problem, {.max_sweeps = -1}), InvalidArgument);
    CHECK_THROWS_AS((void)dominant_term(problem, {.tolerance = std::nan("")}), InvalidArgument);
    CHECK_THROWS_AS((void)dominant_term(problem, {.initial = Values<double>::Ones(3)}), InvalidArgument);
    CHECK_THROWS_AS((void)dominant_term(problem, {.initial = Values<double>::Constant(problem.n_unknowns(), NAN)}),
                    InvalidArgument);
}
