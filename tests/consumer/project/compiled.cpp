// SPDX-License-Identifier: BSD-3-Clause
// Fits and steps with what the library holds; the same lines as header-only.
#include <springfit/compiled/compiled.hpp>

int main() {
    using namespace springfit;
    const auto mesh = tetrahedron_grid<float>({2, 2, 2}, {1.F, 1.F, 1.F});
    auto network = springs_along_edges(mesh, {.density = 1000.F});
    network.stiffness.setConstant(100);
    SpringBody<3, float> body(network);
    body.step(1e-4F);
    AccelerationProblem problem;
    problem.objective = NodeQuadratic(1);
    const int column = 0;
    const double hessian = 2;
    const double linear = 6;
    problem.objective.add_term(0, {&column, 1}, {&hessian, 1}, {&linear, 1}, 9);
    problem.parameters =
        Parameters(network, {.stiffness = {.ties = std::vector<int>(std::size_t(network.n_springs()), 0)}});
    problem.lower = problem.parameters.lower();
    problem.upper = problem.parameters.upper();
    problem.prior = problem.parameters.prior();
    return std::abs(exact(problem).theta(0) - 3) < 1e-9 ? 0 : 1;
}
