// SPDX-License-Identifier: BSD-3-Clause
#include "threads.hpp"
#include "trajectory_cases.hpp"

#include <springfit/fit/acceleration/dominant_term.hpp>
#include <springfit/fit/acceleration/exact.hpp>

using namespace springfit;
using test::Random;

TEST_CASE_TEMPLATE("the same bits on any number of threads", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    Random random(61);
    const auto mesh = [] {
        if constexpr (dim == 2) {
            return triangle_grid<Scalar>({20, 20}, {1, 1});
        } else {
            return tetrahedron_grid<Scalar>({6, 6, 6}, {1, 1, 1});
        }
    }();
    auto network = test::network_at_rest<dim, Scalar>(mesh.nodes, edges(mesh));
    test::randomise(network, true, random);
    const auto motion = test::random_motion<dim, Scalar>(network, {0, 1}, 40, random);
    AccelerationOptions<Scalar> options;
    options.parameters.damping.fit = true;
    const AccelerationProblem alone = acceleration_problem<dim, Scalar>(network, {motion}, options);
    for (int threads : {1, 2, 4}) {
        const Execution execution = test::backwards_on_threads(threads);
        const AccelerationProblem problem = acceleration_problem<dim, Scalar>(network, {motion}, options, execution);
        CHECK(problem.objective.linear() == alone.objective.linear());
        CHECK(problem.objective.value(problem.prior) == alone.objective.value(alone.prior));
        CHECK(one_pass(problem, {.execution = execution}).theta == one_pass(alone).theta);
        CHECK(dominant_term(problem, {.max_sweeps = 3, .tolerance = 0, .execution = execution}).theta ==
              dominant_term(alone, {.max_sweeps = 3, .tolerance = 0}).theta);
        CHECK(exact(problem, {.execution = execution}).theta == exact(alone).theta);
    }
}

TEST_CASE_TEMPLATE("matching of motion has the same bits on any number of threads", T, test::Dimension<2>,
                   test::Dimension<3>) {
    constexpr int dim = T::value;
    const test::SmallBlock<dim> block;
    const auto truth = block.network(0.5, 5);
    std::vector<Motion<dim, double>> motions = block.equilibria(truth, 20, 0.02); // two blocks of cases
    for (auto& motion : block.swings(truth, 3, 0.02, 0.2, 8)) {
        motions.push_back(std::move(motion));
    }
    const auto fitted = [&](GaussNewtonForm form, const Execution& execution) {
        TrajectoryOptions options;
        options.execution = execution;
        const TrajectoryProblem<dim> problem(block.network(0, 0), motions, options);
        return gauss_newton(problem, {.max_iterations = 3, .form = form}).theta;
    };
    for (const GaussNewtonForm form : {GaussNewtonForm::dense, GaussNewtonForm::matrix_free}) {
        const Values<double> alone = fitted(form, {});
        for (int threads : {1, 3}) {
            CHECK(fitted(form, test::backwards_on_threads(threads)) == alone);
        }
    }
}
