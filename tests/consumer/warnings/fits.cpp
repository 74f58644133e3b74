// SPDX-License-Identifier: BSD-3-Clause
// The fits, in the plane and in space: what a user's unit instantiates of vector types.
#include <springfit/springfit.hpp>

namespace {

using namespace springfit;

template <int Dim, class Scalar, class Cell>
bool fit(const Mesh<Dim, Scalar, Cell>& mesh) {
    auto network = springs_along_edges(mesh, {.density = Scalar(10)});
    network.stiffness.setConstant(Scalar(10));
    Scenario<Dim, Scalar> push;
    push.clamps.push_back({.nodes = {0, 1, 2}, .position = {}});
    push.gravity.push_back({.acceleration = Vector<Dim, Scalar>::Unit(1), .amplitude = {}});
    const auto motion = record(network, push, {.dt = Scalar(0.01), .frames = 4}).motion;

    AccelerationObjective<Dim, Scalar> objective(network);
    objective.add(motion);
    const AccelerationProblem problem = objective.problem();
    const AccelerationReport fast = dominant_term(problem);
    const AccelerationReport best = exact(problem);
    const TrajectoryProblem<Dim> motions(network, std::vector{motion}, {.horizon = 2});
    return fast.theta.allFinite() && best.theta.allFinite() && gauss_newton(motions).theta.allFinite();
}

} // namespace

// CONSUMER_IN_PLANE leaves space out, which takes long to compile.
int main() {
    bool fitted = fit(triangle_grid<double>({2, 2}, {1., 1.}));
#ifndef CONSUMER_IN_PLANE
    fitted = fitted && fit(tetrahedron_grid<double>({2, 2, 2}, {1., 1., 1.}));
#endif
    return fitted ? 0 : 1;
}
