// SPDX-License-Identifier: BSD-3-Clause
// Many copies of one body in real time, each with a load of its own: which load bends the beam to where we want it?

#include <cstdio>

#include <springfit/springfit.hpp>

int main() {
    using namespace springfit;
    const auto beam = tetrahedron_grid<float>({12, 2, 2}, {0.6f, 0.1f, 0.1f});
    auto network = springs_along_edges(beam, {.density = 1000.f});
    network.stiffness = van_gelder(beam, network.springs, {.young = 2e5, .poisson = 0.25}).stiffness;
    network.damping = stiffness_proportional_damping(network, 2e-3f);

    constexpr Index n_bodies = 64; // as many loads are tried at once
    SpringBatch<3, float> bodies(network, n_bodies);
    const auto held = side_nodes<3, float>(beam.nodes, {0, false}, 0.01f);
    const auto tip = side_nodes<3, float>(beam.nodes, {0, true}, 0.01f);
    bodies.set_clamped(held);

    const float goal = -0.05f; // m
    const float step = 0.5f * stable_step(network);
    const int n_steps = static_cast<int>(1.5f / step);
    float low = -10;
    float high = 0; // N, at the tip
    for (int round = 0; round < 3; ++round) {
        const auto force = [&](Index b) { return low + (high - low) * static_cast<float>(b) / (n_bodies - 1); };
        const Points<3, float> still = Points<3, float>::Zero(3, network.n_nodes());
        for (Index b = 0; b < n_bodies; ++b) {
            Points<3, float> forces = still;
            for (int node : tip) {
                forces(2, node) = force(b) / static_cast<float>(tip.size());
            }
            bodies.write(b, network.rest_positions, still);
            bodies.set_external_forces(b, forces);
        }
        for (int s = 0; s < n_steps; ++s) {
            bodies.step(step);
        }
        Index best = 0;
        float least = 1;
        Points<3, float> positions, velocities;
        for (Index b = 0; b < n_bodies; ++b) {
            bodies.read(b, positions, velocities);
            const float drop = (positions - network.rest_positions)(2, tip).mean();
            if (std::abs(drop - goal) < least) {
                least = std::abs(drop - goal);
                best = b;
            }
        }
        std::printf("%d steps of %lld bodies of %lld springs: %.3f N leave the tip %.2f mm from its goal\n", n_steps,
                    static_cast<long long>(n_bodies), static_cast<long long>(network.n_springs()),
                    static_cast<double>(force(best)), 1e3 * static_cast<double>(least));
        const float width = (high - low) / (n_bodies - 1);
        const float middle = force(best);
        low = middle - width;
        high = middle + width;
    }
}
