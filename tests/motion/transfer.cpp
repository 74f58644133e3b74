// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/mesh/structured.hpp>
#include <springfit/motion/transfer.hpp>

using namespace springfit;
using test::rounding;

namespace {

/// Nodes of the unit square or cube cut n times along each axis, x fastest.
template <int Dim, class Scalar>
Points<Dim, Scalar> grid(int n) {
    const Index count = Dim == 2 ? (n + 1) * (n + 1) : (n + 1) * (n + 1) * (n + 1);
    Points<Dim, Scalar> nodes(Dim, count);
    for (Index i = 0; i < count; ++i) {
        Index rest = i;
        for (int d = 0; d < Dim; ++d) {
            nodes(d, i) = static_cast<Scalar>(rest % (n + 1)) / static_cast<Scalar>(n);
            rest /= n + 1;
        }
    }
    return nodes;
}

/// Multilinear weights of points in the grid's boxes.
template <int Dim, class Scalar>
Interpolation<Scalar> in_grid(int n, const Points<Dim, Scalar>& points) {
    std::vector<Eigen::Triplet<Scalar>> entries;
    for (Index p = 0; p < points.cols(); ++p) {
        for (int corner = 0; corner < (1 << Dim); ++corner) {
            Scalar weight = 1;
            int node = 0;
            int stride = 1;
            for (int d = 0; d < Dim; ++d) {
                const Scalar place = points(d, p) * static_cast<Scalar>(n);
                const int box = std::min(n - 1, static_cast<int>(place));
                const Scalar share = place - static_cast<Scalar>(box);
                const bool far = ((corner >> d) & 1) != 0;
                weight *= far ? share : 1 - share;
                node += stride * (box + (far ? 1 : 0));
                stride *= n + 1;
            }
            entries.emplace_back(node, static_cast<int>(p), weight);
        }
    }
    Interpolation<Scalar> interpolation;
    interpolation.weights.resize(static_cast<Index>(std::pow(n + 1, Dim)), points.cols());
    interpolation.weights.setFromTriplets(entries.begin(), entries.end());
    return interpolation;
}

template <class Scalar>
Scalar cross(const Vector<2, Scalar>& x, const Vector<2, Scalar>& f) {
    return x(0) * f(1) - x(1) * f(0);
}
template <class Scalar>
Vector<3, Scalar> cross(const Vector<3, Scalar>& x, const Vector<3, Scalar>& f) {
    return x.cross(f);
}

template <int Dim, class Scalar>
auto moment(const Points<Dim, Scalar>& positions, const Points<Dim, Scalar>& forces) {
    auto sum = cross<Scalar>(Vector<Dim, Scalar>(positions.col(0)), Vector<Dim, Scalar>(forces.col(0)));
    for (Index i = 1; i < forces.cols(); ++i) {
        sum += cross<Scalar>(Vector<Dim, Scalar>(positions.col(i)), Vector<Dim, Scalar>(forces.col(i)));
    }
    return Values<Scalar>(Eigen::Matrix < Scalar, Dim == 2 ? 1 : 3, 1 > (sum));
}

/// A fine grid of five boxes along each axis beside a coarse one of two: no fine plane is a coarse one.
template <int Dim, class Scalar>
struct Pair {
    Points<Dim, Scalar> fine = grid<Dim, Scalar>(5);
    Points<Dim, Scalar> coarse = grid<Dim, Scalar>(2);
    Interpolation<Scalar> at_coarse = in_grid<Dim, Scalar>(5, coarse);
    Interpolation<Scalar> at_fine = in_grid<Dim, Scalar>(2, fine);
};

} // namespace

TEST_CASE_TEMPLATE("an affine motion comes out exactly, forces and moments are kept", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    using Matrix = Eigen::Matrix<Scalar, dim, dim>;
    const Pair<dim, Scalar> pair;
    const Matrix gradient = Matrix::Random();
    const Matrix rate = Matrix::Random();
    Motion<dim, Scalar> motion;
    motion.name = "affine";
    motion.rest_positions = pair.fine;
    for (int t = 0; t < 3; ++t) {
        motion.times.push_back(static_cast<Scalar>(t));
        const Matrix f = Matrix::Identity() + static_cast<Scalar>(t) * gradient;
        motion.positions.push_back((f * pair.fine).colwise() + Vector<dim, Scalar>::Constant(static_cast<Scalar>(t)));
        motion.velocities.push_back(gradient * pair.fine);
        motion.accelerations.push_back(rate * pair.fine);
        motion.external_forces.push_back(Points<dim, Scalar>::Random(dim, pair.fine.cols()));
    }
    const auto coarse = transfer(motion, pair.at_coarse, pair.at_fine, pair.coarse);
    CHECK_NOTHROW(validate(coarse));
    CHECK(coarse.name == "affine");
    CHECK(coarse.times == motion.times);
    CHECK(coarse.rest_positions == pair.coarse);
    for (std::size_t t = 0; t < 3; ++t) {
        const Matrix f = Matrix::Identity() + static_cast<Scalar>(t) * gradient;
        const Points<dim, Scalar> expected =
            (f * pair.coarse).colwise() + Vector<dim, Scalar>::Constant(static_cast<Scalar>(t));
        CHECK(test::relative_difference(coarse.positions[t], expected) < rounding<Scalar>());
        CHECK(test::relative_difference(coarse.velocities[t], gradient * pair.coarse) < rounding<Scalar>());
        CHECK(test::relative_difference(coarse.accelerations[t], rate * pair.coarse) < rounding<Scalar>());

        const auto& given = motion.external_forces[t];
        const auto& handed = coarse.external_forces[t];
        const Scalar size = given.cwiseAbs().sum();
        CHECK((handed.rowwise().sum() - given.rowwise().sum()).norm() < rounding<Scalar>() * size);
        CHECK((moment<dim, Scalar>(pair.coarse, handed) - moment<dim, Scalar>(pair.fine, given)).norm() <
              rounding<Scalar>() * size);
        // The same work on any motion of the coarse nodes.
        const Points<dim, Scalar> move = Points<dim, Scalar>::Random(dim, pair.coarse.cols());
        const Scalar work = (interpolate(pair.at_fine, move).array() * given.array()).sum();
        CHECK(test::relative(Scalar((move.array() * handed.array()).sum()), work, size) < rounding<Scalar>());
    }
}

TEST_CASE_TEMPLATE("masses are handed over to the last grain", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const Pair<dim, Scalar> pair;
    const Values<Scalar> masses = Values<Scalar>::LinSpaced(pair.fine.cols(), 1, 3);
    const auto coarse = restrict_masses(pair.at_fine, masses);
    CHECK(coarse.minCoeff() > 0);
    CHECK(test::relative(coarse.sum(), masses.sum(), masses.sum()) < rounding<Scalar>());
    // The other way, fine nodes that no coarse node is near get nothing.
    CHECK_THROWS_AS((void)restrict_masses(pair.at_coarse, Values<Scalar>(Values<Scalar>::Ones(pair.coarse.cols()))),
                    InvalidArgument);
}

TEST_CASE("a coarse node is clamped where all that it is read from is") {
    const Pair<3, double> pair;
    Motion<3, double> motion;
    motion.rest_positions = pair.fine;
    for (Index i = 0; i < pair.fine.cols(); ++i) {
        if (pair.fine(0, i) == 0 || i == 5) { // the face x = 0, and a corner of the other one
            motion.clamped.push_back(static_cast<int>(i));
        }
    }
    const auto coarse = transfer(motion, pair.at_coarse, pair.at_fine, pair.coarse);
    std::vector<int> expected;
    for (Index c = 0; c < pair.coarse.cols(); ++c) {
        if (pair.coarse(0, c) == 0 || c == 2) {
            expected.push_back(static_cast<int>(c));
        }
    }
    CHECK(coarse.clamped == expected);
    CHECK(targets_of(pair.at_coarse, motion.clamped) == expected);
    CHECK(targets_of(pair.at_coarse, {}).empty());
    CHECK_THROWS_AS((void)targets_of(pair.at_coarse, {216}), InvalidArgument);
    CHECK(coarse.n_frames() == 0);
}

TEST_CASE_TEMPLATE("a coarse node that is half held is clamped on request, and moves as what holds it", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const Pair<dim, Scalar> pair;
    Motion<dim, Scalar> motion;
    motion.rest_positions = pair.fine;
    for (Index i = 0; i < pair.fine.cols(); ++i) {
        if (pair.fine(0, i) < Scalar(0.5)) { // the coarse plane x = 1/2 lies midway between the fine 2/5 and 3/5
            motion.clamped.push_back(static_cast<int>(i));
        }
    }
    motion.times = {0};
    motion.positions = {pair.fine};
    motion.velocities = {Points<dim, Scalar>::Zero(dim, pair.fine.cols())};
    for (Index i = 0; i < pair.fine.cols(); ++i) {
        const bool held = pair.fine(0, i) < Scalar(0.5);
        motion.positions[0](1, i) += held ? Scalar(0.25) : Scalar(-3);
        motion.velocities[0](0, i) = held ? Scalar(2) : Scalar(7);
    }
    motion.accelerations = motion.velocities;
    motion.external_forces = motion.velocities;
    const auto strict = transfer(motion, pair.at_coarse, pair.at_fine, pair.coarse);
    const auto half = transfer(motion, pair.at_coarse, pair.at_fine, pair.coarse, Scalar(0.5));
    CHECK(strict.clamped.size() * 2 == half.clamped.size());
    CHECK(transfer(motion, pair.at_coarse, pair.at_fine, pair.coarse, Scalar(0.6)).clamped == strict.clamped);
    for (Index c = 0; c < pair.coarse.cols(); ++c) {
        const bool held = std::binary_search(half.clamped.begin(), half.clamped.end(), static_cast<int>(c));
        CHECK(held == (pair.coarse(0, c) < Scalar(0.75)));
        if (held) {
            CHECK(test::relative(half.positions[0](1, c), pair.coarse(1, c) + Scalar(0.25), Scalar(1)) <
                  rounding<Scalar>());
            CHECK(test::relative(half.velocities[0](0, c), Scalar(2), Scalar(2)) < rounding<Scalar>());
        } else {
            CHECK(half.positions[0].col(c) == strict.positions[0].col(c));
        }
    }
    CHECK((half.external_forces[0] - strict.external_forces[0]).norm() == 0);
    CHECK_THROWS_AS((void)transfer(motion, pair.at_coarse, pair.at_fine, pair.coarse, Scalar(0)), InvalidArgument);
    CHECK_THROWS_AS((void)transfer(motion, pair.at_coarse, pair.at_fine, pair.coarse, Scalar(1.5)), InvalidArgument);
}

TEST_CASE("a quadratic mesh and its corners read each other's positions") {
    const auto check = [](const auto& mesh) {
        const auto corners = corner_mesh(mesh);
        const auto [at_corners, at_nodes] = corner_interpolations(mesh);
        validate(at_corners, "at_corners");
        validate(at_nodes, "at_nodes");
        CHECK(interpolate(at_corners, mesh.nodes) == corners.nodes);
        CHECK(test::relative_difference(interpolate(at_nodes, corners.nodes), mesh.nodes) < 1e-15);
        CHECK(restrict_masses(at_nodes, Values<double>(Values<double>::Ones(mesh.n_nodes()))).minCoeff() >= 1);
    };
    check(quadratic(triangle_grid<double>({3, 2}, {1., 1.})));
    check(quadratic(tetrahedron_grid<double>({2, 1, 2}, {1., 1., 1.})));
    check(hex_grid<double>({2, 1, 2}, {1., 1., 1.}));
}

TEST_CASE("interpolations that do not fit are refused by name") {
    const Pair<2, double> pair;
    Motion<2, double> motion;
    motion.rest_positions = pair.fine;
    CHECK_THROWS_WITH_AS((void)transfer(motion, pair.at_fine, pair.at_coarse, pair.coarse),
                         "at_coarse: expected weights [36 x 9], found [9 x 36]", InvalidArgument);
    CHECK_THROWS_AS((void)transfer(motion, pair.at_coarse, pair.at_coarse, pair.coarse), InvalidArgument);
    auto half = pair.at_fine;
    half.weights.coeffRef(0, 0) = 0.5;
    CHECK_THROWS_WITH_AS((void)transfer(motion, pair.at_coarse, half, pair.coarse),
                         "at_fine: expected weights that sum to 1, found 0.5 at target 0", InvalidArgument);
    half.weights.coeffRef(0, 0) = std::nan("");
    CHECK_THROWS_AS(validate(half, "half"), InvalidArgument);
    CHECK_THROWS_AS((void)interpolate(pair.at_fine, pair.fine), InvalidArgument);
    CHECK_THROWS_AS((void)restrict_forces(pair.at_fine, pair.coarse), InvalidArgument);
    CHECK_THROWS_AS((void)restrict_masses(pair.at_fine, Values<double>(Values<double>::Ones(4))), InvalidArgument);
}
