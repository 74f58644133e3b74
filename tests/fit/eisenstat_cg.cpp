// SPDX-License-Identifier: BSD-3-Clause
#include "fit_data.hpp"
#include "threads.hpp"

#include <springfit/fit/acceleration/detail/eisenstat_cg.hpp>

using namespace springfit;
using test::Random;

namespace {

/// Stiffness and damping of a jittered grid's springs: terms over two unknowns per spring, two of which share two
/// terms.
template <int Dim>
NodeQuadratic quadratic(int n, int frames, Random& random) {
    auto mesh = [n] {
        if constexpr (Dim == 2) {
            return triangle_grid<double>({n, n}, {1, 1});
        } else {
            return tetrahedron_grid<double>({n, n, n}, {1, 1, 1});
        }
    }();
    jitter(mesh, 0.2, 21u);
    auto network = test::network_at_rest<Dim, double>(mesh.nodes, edges(mesh));
    test::randomise(network, true, random);
    AccelerationOptions<double> options;
    options.parameters.damping.fit = true;
    const auto motion = test::random_motion<Dim, double>(network, {0, 1}, frames, random);
    return acceleration_problem<Dim, double>(network, {motion}, options).objective;
}

Values<double> random_values(Index n, Random& random) {
    return random.points<2, double>(n, 1).row(0).transpose();
}

/// All but every third unknown.
Values<double> some_weights(const Values<double>& curvature) {
    Values<double> weight = (curvature.array() > 0).select(curvature.cwiseInverse(), 0.);
    for (Index u = 0; u < weight.size(); u += 3) {
        weight(u) = 0;
    }
    return weight;
}

/// The Hessian of the unknowns with a weight, scaled to a diagonal of d.
DenseMatrix<double> scaled_hessian(const NodeQuadratic& quadratic, const Values<double>& weight, double d) {
    DenseMatrix<double> h = SparseMatrix<double>(quadratic.hessian().selfadjointView<Eigen::Lower>());
    const Values<double> root = weight.cwiseSqrt();
    h = (root.asDiagonal() * h * root.asDiagonal()).eval();
    h.diagonal() *= d;
    return h;
}

} // namespace

TEST_CASE_TEMPLATE("the two triangles are those of the scaled Hessian", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    using Sweeps = detail::SymmetricGaussSeidel<Scalar>;
    using Lanes = typename Sweeps::Lanes;
    Random random(31);
    const NodeQuadratic h = quadratic<dim>(dim == 2 ? 5 : 2, 30, random);
    const Values<double> curvature = h.curvature();
    const Values<double> weight = some_weights(curvature);
    const Scalar d = Scalar(1.25);
    const DenseMatrix<double> a = scaled_hessian(h, weight, d);
    const double tolerance = test::rounding<Scalar>(1000);

    Sweeps sweeps(h, curvature, {});
    const auto by_place = [&](const Values<double>& gradient) {
        Values<Scalar> result;
        sweeps.gather(weight, gradient, 1, result);
        return result;
    };
    const auto right_side = [](const Values<Scalar>& b) {
        return [&b](Index place) -> Lanes { return Lanes::at(b.data() + place); };
    };
    for (int sample = 0; sample < 5; ++sample) {
        CAPTURE(sample);
        const Values<double> gradient = random_values(h.n_unknowns(), random);
        const Values<Scalar> q = by_place(gradient.cwiseProduct(curvature.cwiseSqrt()));
        Values<double> back;
        sweeps.scatter(q, 2, back);
        const Values<double> expected =
            2 * (weight.array() > 0).select(gradient.cwiseProduct(weight.cwiseSqrt()), 0.).matrix();
        CHECK(test::relative_difference(back, expected) < tolerance);

        // W' p = q and p' (W + W' - d) p = p' A p
        Values<Scalar> p = Values<Scalar>::Zero(sweeps.size());
        const auto sums = sweeps.solve_upper(d, right_side(q), p);
        CHECK(test::relative(sums.xx, double(p.squaredNorm()), sums.xx) < tolerance);
        CHECK(test::relative(sums.xb, double(p.dot(q)), sums.xx) < tolerance);
        Values<double> moved;
        sweeps.scatter(p, 1, moved);
        const Values<double> scaled = moved.cwiseProduct(curvature.cwiseSqrt());
        CHECK(test::relative(2 * sums.xb - d * sums.xx, scaled.dot(a * scaled), sums.xx) < tolerance);

        // (W^-1 b)' q = b' (W'^-1 q)
        const Values<Scalar> b = by_place(random_values(h.n_unknowns(), random).cwiseProduct(curvature.cwiseSqrt()));
        Values<Scalar> x = Values<Scalar>::Zero(sweeps.size());
        sweeps.solve_lower(d, right_side(b), x);
        CHECK(test::relative(double(x.dot(q)), double(b.dot(p)), double(b.norm() * p.norm())) < tolerance);
    }
}

TEST_CASE_TEMPLATE("conjugate gradients by sweeps end where the free gradient is 0", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    Random random(32);
    const NodeQuadratic h = quadratic<dim>(dim == 2 ? 5 : 2, 30, random);
    const Values<double> curvature = h.curvature();
    const Values<double> weight = some_weights(curvature);
    for (const double ridge : {0., 0.5}) {
        CAPTURE(ridge);
        const DenseMatrix<double> a = scaled_hessian(h, weight, 1 + ridge);
        const Values<double> gradient =
            1e-3 * random_values(h.n_unknowns(), random).cwiseProduct(curvature.cwiseSqrt());
        const Values<double> scaled = gradient.cwiseProduct(weight.cwiseSqrt());
        detail::EisenstatCg<Scalar> gradients(h, curvature, {});
        gradients.start(weight, gradient, ridge, scaled.cwiseAbs().maxCoeff());
        CHECK(gradients.largest() == 1);
        Values<double> step, part;
        const double goal = test::rounding<Scalar>(30);
        int iterations = 0;
        for (; gradients.largest() > goal && iterations < 2000; ++iterations) {
            REQUIRE(gradients.iterate());
            if (iterations == 2) { // a step taken on the way changes nothing
                gradients.take_step(part);
            }
        }
        CHECK(iterations < 2000);
        CHECK(iterations > 2);
        gradients.take_step(step);
        step += part;
        const Values<double> found = step.cwiseProduct(curvature.cwiseSqrt());
        CHECK((weight.array() > 0).select(0., step).isZero(0));
        CHECK(test::relative_difference(a * found, -scaled) < 1000 * goal);
    }
}

TEST_CASE("a matrix that is not positive definite is noticed, and the step stays where it was") {
    // H = [[1, 2], [2, 1]]
    NodeQuadratic h(2);
    h.add_term(0, std::vector<int>{0, 1}, std::vector<double>{1, 2, 1}, std::vector<double>{0, 0}, 0);
    detail::EisenstatCg<double> gradients(h, h.curvature(), {});
    gradients.start(Values<double>::Ones(2), Values<double>{{1, -1}}, 0, 1);
    CHECK_FALSE(gradients.iterate());
    Values<double> step;
    gradients.take_step(step);
    CHECK(step.isZero(0));
}

TEST_CASE_TEMPLATE("unknowns that share no term need one iteration, and none at all nothing", Scalar, float, double) {
    NodeQuadratic h(40);
    for (int u = 0; u < 39; ++u) { // the last is in no term
        h.add_term(u, std::vector<int>{u}, std::vector<double>{u + 1.}, std::vector<double>{0}, 0);
    }
    Values<double> weight = Values<double>::Zero(40);
    for (int u = 0; u < 39; ++u) {
        weight(u) = 1 / (u + 1.);
    }
    detail::EisenstatCg<Scalar> gradients(h, h.curvature(), {});
    gradients.start(weight, Values<double>::Ones(40), 0, 1);
    CHECK(gradients.iterate());
    Values<double> step;
    gradients.take_step(step);
    CHECK(test::relative_difference(step, -weight) < test::rounding<Scalar>());
    detail::EisenstatCg<Scalar> empty(NodeQuadratic(0), Values<double>(0), {});
    empty.start(Values<double>(0), Values<double>(0), 0, 1);
    CHECK_FALSE(empty.iterate());
}

TEST_CASE_TEMPLATE("sweeps give the same bits on any number of threads", Scalar, float, double) {
    Random random(33);
    const NodeQuadratic h = quadratic<2>(70, 3, random); // several chunks in each colour
    const Values<double> curvature = h.curvature();
    const Values<double> weight = some_weights(curvature);
    const Values<double> gradient = random_values(h.n_unknowns(), random).cwiseProduct(curvature.cwiseSqrt());
    const auto step_with = [&](const Execution& execution) {
        detail::EisenstatCg<Scalar> gradients(h, curvature, execution);
        gradients.start(weight, gradient, 0.1, 1);
        for (int i = 0; i < 10; ++i) {
            CHECK(gradients.iterate());
        }
        Values<double> step;
        gradients.take_step(step);
        return step;
    };
    const Values<double> alone = step_with({});
    for (int threads : {1, 2, 4}) {
        CHECK(step_with(test::backwards_on_threads(threads)) == alone);
    }
}
