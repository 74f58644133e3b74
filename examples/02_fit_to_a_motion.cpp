// SPDX-License-Identifier: BSD-3-Clause
// Springs found again from the motion of a spring network: the dominant-term fit is exact where springs can represent
// the reference.

#include <cstdio>
#include <random>

#include <springfit/springfit.hpp>

int main() {
    using namespace springfit;
    const auto mesh = triangle_grid<double>({6, 6}, {1., 1.});
    auto truth = springs_along_edges(mesh, {.density = 10.});
    std::mt19937 random(1);
    std::uniform_real_distribution<double> decade(1, 2);
    for (double& k : truth.stiffness) {
        k = std::pow(10., decade(random)); // N/m
    }

    Scenario<2, double> scenario;
    scenario.name = "swing";
    scenario.clamps.push_back({.nodes = {0, 6}, .position = {}});
    scenario.gravity.push_back({.acceleration = {0.5, -2.}, .amplitude = {}});
    const auto motion = record(truth, scenario, {.dt = 0.02, .frames = 100}).motion;

    auto network = springs_along_edges(mesh, {.density = 10.});
    network.stiffness.setConstant(30); // what a spring gets that no motion excites
    AccelerationObjective<2, double> objective(network);
    objective.add(motion);
    const AccelerationProblem problem = objective.problem();
    const AccelerationReport report = dominant_term(problem);
    apply(problem, report, network);

    std::printf("%s after %d sweeps; largest relative error of a stiffness %.1e\n",
                std::string(to_string(report.status)).c_str(), report.iterations,
                ((network.stiffness - truth.stiffness).array() / truth.stiffness.array()).abs().maxCoeff());
}
