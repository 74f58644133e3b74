// SPDX-License-Identifier: BSD-3-Clause
// A finite element reference recorded under a load, and how near springs by a closed form come to its motion.

#include <cstdio>

#include <springfit/springfit.hpp>

int main() {
    using namespace springfit;
    auto mesh = triangle_grid<double>({12, 4}, {0.3, 0.1}); // a sheet, m
    jitter(mesh, 0.2, 1);
    const fem::Model reference{mesh,
                               fem::StVenantKirchhoff{.young = 1e5, .poisson = 1. / 3.},
                               1000.,
                               {.thickness = 0.01, .stiffness_damping = 1e-3}};

    Scenario<2, double> scenario;
    scenario.name = "sag";
    Clamp<2, double> left;
    for (int i = 0; i < mesh.n_nodes(); ++i) {
        if (mesh.nodes(0, i) == 0) {
            left.nodes.push_back(i);
        }
    }
    scenario.clamps.push_back(left);
    scenario.gravity.push_back({.acceleration = {0., -2.}, .amplitude = ramp_and_release(0.1, 0.3)});
    const auto recording = record(reference, scenario, {.dt = 0.01, .frames = 60});

    auto network = springs_along_edges(mesh, {.density = 1000., .thickness = 0.01});
    network.stiffness =
        van_gelder(mesh, network.springs, {.young = 1e5, .poisson = 1. / 3., .thickness = 0.01}).stiffness;
    network.damping = stiffness_proportional_damping(network, 1e-3);
    const std::vector scenarios{scenario};
    const std::vector motions{recording.motion};
    std::printf("%lld frames; motion error of Van Gelder's springs %.3f\n",
                static_cast<long long>(recording.motion.n_frames()), motion_error(network, scenarios, motions).error);
}
