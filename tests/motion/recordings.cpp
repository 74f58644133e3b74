// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <random>

#include <springfit/motion/gaps.hpp>
#include <springfit/motion/replay.hpp>
#include <springfit/motion/resample.hpp>
#include <springfit/motion/smoothing.hpp>
#include <springfit/motion/units.hpp>

using namespace springfit;

namespace {

constexpr Index n_nodes = 40;

/// Two shapes that swing at two frequencies, over 48 frames; the first node is clamped.
template <int Dim, class Scalar>
Motion<Dim, Scalar> swinging() {
    std::mt19937 random(7);
    std::normal_distribution<double> number;
    const auto shape = [&] {
        Points<Dim, Scalar> points(Dim, n_nodes);
        for (Scalar& value : points.reshaped()) {
            value = static_cast<Scalar>(number(random));
        }
        points.col(0).setZero();
        return points;
    };
    Motion<Dim, Scalar> motion;
    motion.rest_positions = 10 * shape();
    motion.clamped = {0};
    const Points<Dim, Scalar> slow = shape(), fast = Scalar(0.3) * shape();
    for (int t = 0; t < 48; ++t) {
        const auto time = Scalar(0.1) * static_cast<Scalar>(t);
        const Scalar a = std::sin(2 * time), va = 2 * std::cos(2 * time);
        const Scalar b = std::cos(5 * time), vb = -5 * std::sin(5 * time);
        motion.times.push_back(time);
        motion.positions.push_back(motion.rest_positions + a * slow + b * fast);
        motion.velocities.push_back(va * slow + vb * fast);
        motion.accelerations.push_back(-4 * a * slow - 25 * b * fast);
        motion.external_forces.push_back(slow);
    }
    return motion;
}

template <int Dim, class Scalar>
std::vector<Points<Dim, Scalar>> displacements_of(const Motion<Dim, Scalar>& motion) {
    auto frames = motion.positions;
    for (auto& frame : frames) {
        frame -= motion.rest_positions;
    }
    return frames;
}

template <int Dim, class Scalar>
double mean_distance(const std::vector<Points<Dim, Scalar>>& a, const std::vector<Points<Dim, Scalar>>& b) {
    double sum = 0;
    for (std::size_t t = 0; t < a.size(); ++t) {
        sum += static_cast<double>((a[t] - b[t]).squaredNorm());
    }
    return std::sqrt(sum / static_cast<double>(a.size() * static_cast<std::size_t>(a.front().size())));
}

/// The motion with Gaussian noise of this size on all nodes but the clamped one.
template <int Dim, class Scalar>
Motion<Dim, Scalar> noisy(Motion<Dim, Scalar> motion, double sigma) {
    std::mt19937 random(11);
    std::normal_distribution<double> noise(0, sigma);
    for (auto& frame : motion.positions) {
        for (Index i = 1; i < n_nodes; ++i) {
            for (int d = 0; d < Dim; ++d) {
                frame(d, i) += static_cast<Scalar>(noise(random));
            }
        }
    }
    return motion;
}

} // namespace

TEST_CASE_TEMPLATE("gaps of a motion of few shapes are filled in as the motion goes", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto motion = swinging<dim, Scalar>();
    const auto whole = displacements_of(motion);
    auto frames = whole;
    for (std::size_t t = 10; t < 25; ++t) {
        frames[t].col(5).setConstant(std::numeric_limits<Scalar>::quiet_NaN());
        frames[t](0, 9) = std::numeric_limits<Scalar>::quiet_NaN();
    }
    frames[0].col(3).setConstant(std::numeric_limits<Scalar>::quiet_NaN());
    const auto unobserved = fill_gaps<dim, Scalar>(motion.rest_positions, motion.times, frames);
    REQUIRE(unobserved.size() == frames.size());
    CHECK(unobserved[0] == std::vector<int>{3});
    CHECK(unobserved[1].empty());
    CHECK(unobserved[12] == std::vector<int>{5, 9});
    CHECK(mean_distance(frames, whole) < 1e-3);
    CHECK(frames[30] == whole[30]);
    CHECK(fill_gaps<dim, Scalar>(motion.rest_positions, motion.times, frames).empty());
}

TEST_CASE("a node that is never seen moves as those around it; a body that is never seen is refused") {
    auto motion = swinging<3, double>();
    auto frames = displacements_of(motion);
    const Vector<3, double> way(1, 2, 3);
    for (std::size_t t = 0; t < frames.size(); ++t) {
        frames[t] = (static_cast<double>(t) * way).replicate(1, n_nodes);
        frames[t].col(4).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    (void)fill_gaps<3, double>(motion.rest_positions, motion.times, frames);
    CHECK((frames[20].col(4) - 20 * way).norm() < 1e-9);
    for (auto& frame : frames) {
        frame.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    CHECK_THROWS_AS((void)(fill_gaps<3, double>(motion.rest_positions, motion.times, frames)), InvalidArgument);
}

TEST_CASE_TEMPLATE("noise is measured, and smoothing takes most of it away", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto motion = swinging<dim, Scalar>();
    CHECK(noise_level(motion) < Scalar(1e-3)); // its own motion is no noise
    for (const double sigma : {0.01, 0.05}) {
        CAPTURE(sigma);
        const auto recorded = noisy(motion, sigma);
        const auto found = static_cast<double>(noise_level(recorded));
        CHECK(found > 0.85 * sigma);
        CHECK(found < 1.15 * sigma);
        const auto estimate = smoothed(recorded, static_cast<Scalar>(found));
        CHECK(mean_distance(estimate.positions, motion.positions) < 0.35 * sigma);
        CHECK(mean_distance(estimate.velocities, motion.velocities) < 0.1);
        CHECK(estimate.positions[7].col(0) == recorded.positions[7].col(0)); // clamped
    }
    CHECK(smoothed(motion, 0).positions == motion.positions);
    CHECK_THROWS_AS((void)smoothed(motion, Scalar(-1)), InvalidArgument);
}

TEST_CASE("noise does not depend on the unit, and is none in few frames") {
    const auto recorded = noisy(swinging<3, double>(), 0.02);
    const auto scaled = in_si_units(recorded, 1e-3, 1e-6);
    CHECK(test::relative(noise_level(scaled), 1e-3 * noise_level(recorded), noise_level(scaled)) < 1e-9);
    CHECK(noise_level(excerpt(recorded, 0, 11)) == 0);
}

TEST_CASE_TEMPLATE("a motion in other units is the same in SI units", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto motion = swinging<dim, Scalar>();
    const auto si = in_si_units(motion, Scalar(0.001), Scalar(0.01));
    const auto same = [](const auto& a, const auto& b) {
        return test::relative_difference(a, b) < test::rounding<Scalar>();
    };
    CHECK(test::relative(si.times[3], Scalar(0.01) * motion.times[3], si.times[3]) < test::rounding<Scalar>());
    CHECK(same(si.positions[3], Points<dim, Scalar>(Scalar(0.001) * motion.positions[3])));
    CHECK(same(si.velocities[3], Points<dim, Scalar>(Scalar(0.1) * motion.velocities[3])));
    CHECK(same(si.accelerations[3], Points<dim, Scalar>(10 * motion.accelerations[3])));
    CHECK(si.external_forces[3] == motion.external_forces[3]);
    CHECK_THROWS_AS((void)in_si_units(motion, 0, 1), InvalidArgument);
}

TEST_CASE("excerpts and resampling keep what was not seen") {
    auto motion = swinging<2, double>();
    motion.unobserved.resize(48);
    motion.unobserved[10] = {2, 5};
    motion.unobserved[11] = {3};
    const auto part = excerpt(motion, 10, 20);
    REQUIRE(part.unobserved.size() == 10);
    CHECK(part.unobserved[0] == std::vector<int>{2, 5});
    motion.times[11] += 0.03; // the new 11th frame lies between the 10th and that
    const auto even = resample(motion);
    CHECK(even.unobserved[11] == std::vector<int>{2, 3, 5});
    std::vector<int> seen;
    for_observed(motion, 10, {1, 2, 3, 5, 6}, [&](int node) { seen.push_back(node); });
    CHECK(seen == std::vector<int>{1, 3, 6});
}

TEST_CASE_TEMPLATE("differences are exact for polynomials of the fourth degree", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    std::vector<Scalar> times;
    std::vector<Points<dim, Scalar>> frames;
    const auto value = [](Scalar t) { return 1 + t - 2 * t * t + t * t * t * t / 2; };
    for (int f = 0; f < 9; ++f) {
        times.push_back(Scalar(0.3) * static_cast<Scalar>(f) + (f % 2 == 0 ? Scalar(0.05) : Scalar(0)));
        frames.push_back(Points<dim, Scalar>::Constant(dim, 2, value(times.back())));
    }
    const auto velocity = differentiate<dim, Scalar>(times, frames, 1);
    const auto acceleration = differentiate<dim, Scalar>(times, frames, 2);
    for (std::size_t f = 0; f < 9; ++f) {
        const Scalar t = times[f];
        CAPTURE(f);
        CHECK(test::relative(velocity[f](0, 1), 1 - 4 * t + 2 * t * t * t, Scalar(10)) < 20 * test::rounding<Scalar>());
        CHECK(test::relative(acceleration[f](0, 1), -4 + 6 * t * t, Scalar(10)) < 200 * test::rounding<Scalar>());
    }
}
