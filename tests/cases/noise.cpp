// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/cases/noise.hpp>

using namespace springfit;

namespace {

/// 300 nodes that swing by different ways, the first two clamped, 20 frames.
template <int Dim, class Scalar>
Motion<Dim, Scalar> swing() {
    Motion<Dim, Scalar> motion;
    motion.rest_positions = Points<Dim, Scalar>::Random(Dim, 300);
    motion.clamped = {0, 1};
    for (int t = 0; t < 20; ++t) {
        Points<Dim, Scalar> positions =
            motion.rest_positions + std::sin(Scalar(t)) * Scalar(0.1) * Points<Dim, Scalar>::Random(Dim, 300);
        positions.template leftCols<2>() = motion.rest_positions.template leftCols<2>();
        motion.times.push_back(static_cast<Scalar>(t));
        motion.positions.push_back(positions);
        motion.velocities.push_back(positions);
        motion.accelerations.push_back(positions);
        motion.external_forces.push_back(positions);
    }
    return motion;
}

} // namespace

TEST_CASE_TEMPLATE("noise has the level asked for, on free nodes alone", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto motion = swing<dim, Scalar>();
    const auto noisy = with_noise(motion, 0.05, 3);
    double noise = 0;
    double way = 0;
    Vector<dim, double> mean = Vector<dim, double>::Zero();
    for (std::size_t t = 0; t < 20; ++t) {
        const Points<dim, double> added = (noisy.positions[t] - motion.positions[t]).template cast<double>();
        CHECK(added.template leftCols<2>().norm() == 0);
        noise += added.squaredNorm();
        mean += added.rowwise().sum();
        way += (motion.positions[t] - motion.rest_positions).template cast<double>().squaredNorm();
        CHECK(noisy.velocities[t] == motion.velocities[t]);
        CHECK(noisy.accelerations[t] == motion.accelerations[t]);
        CHECK(noisy.external_forces[t] == motion.external_forces[t]);
    }
    const double n = 298 * 20 * dim; // samples: the level has a standard error of 1 / sqrt(2 n)
    CHECK(test::relative(std::sqrt(noise / way), 0.05, 0.05) < 4 / std::sqrt(2 * n));
    CHECK(mean.norm() / n < 4 * std::sqrt(dim * noise) / n);
    CHECK(noisy.positions[7] == with_noise(motion, 0.05, 3).positions[7]);
    CHECK(noisy.positions[7] != with_noise(motion, 0.05, 4).positions[7]);
    CHECK(with_noise(motion, 0., 3).positions[7] == motion.positions[7]);
}

TEST_CASE("noise needs a complete motion and a level") {
    auto motion = swing<2, double>();
    CHECK_THROWS_AS((void)with_noise(motion, -0.1, 1), InvalidArgument);
    CHECK_THROWS_AS((void)with_noise(motion, std::nan(""), 1), InvalidArgument);
    auto still = motion;
    for (auto& positions : still.positions) {
        positions = still.rest_positions;
    }
    CHECK(with_noise(still, 0.1, 1).positions[3] == still.rest_positions);
    motion.clamped = {300};
    CHECK_THROWS_AS((void)with_noise(motion, 0.1, 1), InvalidArgument);
    motion = still;
    motion.velocities.pop_back();
    CHECK_THROWS_AS((void)with_noise(motion, 0.1, 1), InvalidArgument);
}
