// SPDX-License-Identifier: BSD-3-Clause
#include <springfit/search/annealing.hpp>
#include <springfit/search/genetic.hpp>

int main() {
    // Two springs in a row, of stiffness 1 where 2 is shown: pushed by 0.2, the node between them goes 0.05.
    springfit::SpringNetwork<2, double> network;
    network.rest_positions = springfit::Points<2, double>::Zero(2, 3);
    network.rest_positions.row(0) << 0., 1., 2.;
    network.springs = springfit::NodePairs(2, 2);
    network.springs << 0, 1, 1, 2;
    network.stiffness = springfit::Values<double>::Ones(2);
    network.damping = springfit::Values<double>::Zero(2);
    network.rest_length = 0.9 * springfit::Values<double>::Ones(2); // taut, so that it resists loads to its side
    network.mass = springfit::Values<double>::Ones(3);
    springfit::Motion<2, double> motion;
    motion.rest_positions = network.rest_positions;
    motion.clamped = {0, 2};
    motion.times = {0.};
    motion.positions = {network.rest_positions};
    motion.positions[0](0, 1) += 0.05; // k (0.15 - 0.05) = 0.2, k = 2
    motion.velocities = motion.accelerations = {springfit::Points<2, double>::Zero(2, 3)};
    motion.external_forces = motion.velocities;
    motion.external_forces[0](0, 1) = 0.2;
    springfit::TrajectoryOptions options;
    options.prior_weight = 0;
    options.parameters.stiffness.ties = {0, 0};
    const springfit::TrajectoryProblem<2> problem(network, std::vector{motion}, options);
    const auto annealed = springfit::search::annealing(problem);
    const auto bred = springfit::search::genetic(problem);
    return annealed.fit.misfit < 1e-2 && bred.fit.misfit < 1e-2 ? 0 : 1;
}
