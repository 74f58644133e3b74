// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/motion/resample.hpp>

using namespace springfit;

namespace {

/// Cubic in time, at these times.
template <int Dim, class Scalar>
Motion<Dim, Scalar> cubic(const std::vector<Scalar>& times) {
    Motion<Dim, Scalar> motion;
    const Points<Dim, Scalar> a = Points<Dim, Scalar>::Constant(Dim, 2, Scalar(0.5)), b = -2 * a, c = 3 * a;
    motion.rest_positions = a;
    motion.times = times;
    for (const Scalar t : times) {
        motion.positions.push_back(a + t * b + t * t * t * c);
        motion.velocities.push_back(b + 3 * t * t * c);
        motion.accelerations.push_back(6 * t * c);
        motion.external_forces.push_back((1 + t) * a);
    }
    return motion;
}

} // namespace

TEST_CASE_TEMPLATE("a cubic motion with linear forces is resampled exactly", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto uneven = cubic<dim, Scalar>({Scalar(0.5), Scalar(0.6), Scalar(1), Scalar(1.1), Scalar(2.5)});
    CHECK_FALSE(has_even_frames(uneven));
    const auto even = resample(uneven);
    CHECK(has_even_frames(even));
    const auto expected = cubic<dim, Scalar>(even.times);
    REQUIRE(even.n_frames() == 5);
    CHECK(even.times.front() == Scalar(0.5));
    CHECK(even.times.back() == Scalar(2.5));
    for (std::size_t t = 0; t < 5; ++t) {
        CAPTURE(t);
        CHECK(test::relative_difference(even.positions[t], expected.positions[t]) < test::rounding<Scalar>());
        CHECK(test::relative_difference(even.velocities[t], expected.velocities[t]) < test::rounding<Scalar>());
        CHECK(test::relative_difference(even.accelerations[t], expected.accelerations[t]) < test::rounding<Scalar>());
        CHECK(test::relative_difference(even.external_forces[t], expected.external_forces[t]) <
              test::rounding<Scalar>());
    }
}

TEST_CASE("frames that are off by a thousandth are even, by more they are not") {
    auto motion = cubic<2, double>({0, 1, 2, 3, 4});
    motion.times[2] += 0.0009;
    CHECK(has_even_frames(motion));
    motion.times[2] += 0.0002;
    CHECK_FALSE(has_even_frames(motion));
    motion.times[2] = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(has_even_frames(motion));
    CHECK(has_even_frames(cubic<2, double>({3})));
    CHECK_THROWS_AS((void)resample(cubic<2, double>({3})), InvalidArgument);
}
