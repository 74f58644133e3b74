// SPDX-License-Identifier: BSD-3-Clause
#include "random_meshes.hpp"
#include "tolerance.hpp"

#include <springfit/cgal/interpolation.hpp>
#include <springfit/mesh/topology.hpp>

using namespace springfit;
using test::random_points;
using test::relative;
using test::rounding;
using test::shaken;

TEST_CASE_TEMPLATE("interpolation carries affine fields exactly, and near points to the surface", Scalar, float,
                   double) {
    const auto mesh = shaken(tetrahedron_grid<Scalar>({3, 3, 3}, {1, 1, 1}));
    const auto inside = random_points<3, Scalar>(60, Scalar(0), Scalar(1));
    const auto weights = cgal::interpolation(mesh, inside);
    CHECK_NOTHROW(validate(weights, "weights"));
    CHECK((interpolate(weights, mesh.nodes) - inside).cwiseAbs().maxCoeff() < rounding<Scalar>());

    Points<3, Scalar> outside(3, 1);
    outside << Scalar(0.25), Scalar(0.5), Scalar(1.1);
    const Vector<3, Scalar> foot{Scalar(0.25), Scalar(0.5), Scalar(1)};
    CHECK((interpolate(cgal::interpolation(mesh, outside), mesh.nodes) - foot).norm() < rounding<Scalar>());
    CHECK_THROWS_AS((void)cgal::interpolation(mesh, outside, Scalar(0.05)), InvalidArgument);
    outside(0, 0) = 5;
    CHECK_THROWS_AS((void)cgal::interpolation(mesh, outside), InvalidArgument);
}

TEST_CASE("a fine mesh and a coarse one exchange motion and keep force and mass") {
    const auto fine = shaken(tetrahedron_grid<double>({6, 6, 6}, {1., 1., 1.}));
    const auto coarse = shaken(tetrahedron_grid<double>({2, 2, 2}, {1., 1., 1.}));
    const auto at_coarse = cgal::interpolation(fine, coarse.nodes);
    const auto at_fine = cgal::interpolation(coarse, fine.nodes);
    Motion<3, double> motion;
    motion.rest_positions = fine.nodes;
    for (int node : boundary_nodes(fine)) {
        if (fine.nodes(2, node) == 0) {
            motion.clamped.push_back(node);
        }
    }
    const Eigen::Matrix3d gradient = Eigen::Matrix3d::Random();
    motion.times = {0.};
    motion.positions = {gradient * fine.nodes};
    motion.velocities = {fine.nodes};
    motion.accelerations = {fine.nodes};
    motion.external_forces = {random_points<3, double>(static_cast<int>(fine.n_nodes()), -1., 1.)};
    const auto carried = transfer(motion, at_coarse, at_fine, coarse.nodes);
    CHECK(test::relative_difference(carried.positions[0], gradient * coarse.nodes) < 1e-13);
    const auto moment = [](const Points<3, double>& x, const Points<3, double>& f) {
        Vector<3, double> sum = Vector<3, double>::Zero();
        for (Index i = 0; i < x.cols(); ++i) {
            sum += x.col(i).cross(f.col(i));
        }
        return sum;
    };
    CHECK((carried.external_forces[0].rowwise().sum() - motion.external_forces[0].rowwise().sum()).norm() < 1e-12);
    CHECK((moment(coarse.nodes, carried.external_forces[0]) - moment(fine.nodes, motion.external_forces[0])).norm() <
          1e-12);
    std::vector<int> bottom;
    for (int node : boundary_nodes(coarse)) {
        if (coarse.nodes(2, node) == 0) {
            bottom.push_back(node);
        }
    }
    CHECK(carried.clamped == bottom);
    const Values<double> masses = Values<double>::Ones(fine.n_nodes());
    CHECK(relative(restrict_masses(at_fine, masses).sum(), masses.sum(), masses.sum()) < 1e-13);
}
