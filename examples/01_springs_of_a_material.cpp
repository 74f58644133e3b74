// SPDX-License-Identifier: BSD-3-Clause
// Springs from a mesh and a material by a closed form, with masses, damping and the step that is stable.

#include <cstdio>

#include <springfit/springfit.hpp>

int main() {
    using namespace springfit;
    auto mesh = tetrahedron_grid<double>({6, 3, 3}, {0.2, 0.1, 0.1}); // a 20 cm block, m
    jitter(mesh, 0.2, 1);

    auto network = springs_along_edges(mesh, {.density = 1000.}); // kg/m^3
    network.stiffness = van_gelder(mesh, network.springs, {.young = 5e4, .poisson = 0.25}).stiffness;
    network.damping = stiffness_proportional_damping(network, 1e-3);

    std::printf("%lld springs, %.3f kg, stiffness %.1f to %.1f N/m, stable step %.2e s\n",
                static_cast<long long>(network.n_springs()), network.mass.sum(), network.stiffness.minCoeff(),
                network.stiffness.maxCoeff(), stable_step(network));
}
