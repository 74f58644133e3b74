// SPDX-License-Identifier: BSD-3-Clause
#include <springfit/ipopt/exact.hpp>

int main() {
    // (theta - 3)^2, theta >= 0
    springfit::AccelerationProblem problem;
    problem.objective = springfit::NodeQuadratic(1);
    const int column = 0;
    const double hessian = 2;
    const double linear = 6;
    problem.objective.add_term(0, {&column, 1}, {&hessian, 1}, {&linear, 1}, 9);
    springfit::SpringNetwork<2, double> network;
    network.rest_positions = springfit::Points<2, double>::Identity(2, 2);
    network.springs = springfit::NodePairs(2, 1);
    network.springs << 0, 1;
    network.stiffness = network.damping = springfit::Values<double>::Zero(1);
    network.rest_length = springfit::Values<double>::Ones(1);
    network.mass = springfit::Values<double>::Ones(2);
    problem.parameters = springfit::Parameters(network, {});
    problem.lower = problem.parameters.lower();
    problem.upper = problem.parameters.upper();
    problem.prior = problem.parameters.prior();
    return std::abs(springfit::ipopt::exact(problem).theta(0) - 3) < 1e-6 ? 0 : 1;
}
