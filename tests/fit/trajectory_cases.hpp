// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "fit_data.hpp"

#include <springfit/closed_form/van_gelder.hpp>
#include <springfit/fem/statics.hpp>
#include <springfit/fit/trajectory/gauss_newton.hpp>
#include <springfit/motion/record.hpp>
#include <springfit/motion/record_static.hpp>
#include <springfit/network/builders.hpp>
#include <springfit/network/volume.hpp>
#include <springfit/simulate/static_solver.hpp>
#include <springfit/simulate/symplectic_euler.hpp>

namespace springfit::test {

template <int D>
using Dimension = std::integral_constant<int, D>;

/// A small jittered block of simplices, with scenarios that hold one end and pull at random at every node.
template <int Dim>
struct SmallBlock {
    Mesh<Dim, double, std::conditional_t<Dim == 2, Tri3, Tet4>> mesh;
    std::vector<int> clamped;

    SmallBlock() {
        if constexpr (Dim == 2) {
            mesh = triangle_grid<double>({3, 2}, {1.5, 1.});
        } else {
            mesh = tetrahedron_grid<double>({2, 1, 1}, {1., 0.5, 0.5});
        }
        for (Index i = 0; i < mesh.n_nodes(); ++i) {
            if (mesh.nodes(0, i) == 0) {
                clamped.push_back(static_cast<int>(i));
            }
        }
        jitter(mesh, 0.15, 3u);
    }

    /// Springs along the edges, of one stiffness up to a factor exp(+- spread).
    [[nodiscard]] SpringNetwork<Dim, double> network(double spread, unsigned seed) const {
        auto springs = springs_along_edges(mesh, {.density = 0.1});
        Random random(seed);
        for (Index e = 0; e < springs.n_springs(); ++e) {
            springs.stiffness(e) = std::exp(random(-spread, spread));
            springs.damping(e) = 0.02;
        }
        return springs;
    }

    [[nodiscard]] std::vector<Scenario<Dim, double>> pulls(int count, double force) const {
        std::vector<Scenario<Dim, double>> cases;
        Random random(17);
        for (int c = 0; c < count; ++c) {
            Scenario<Dim, double> scenario;
            scenario.name = text("pull ", c);
            scenario.clamps = {{clamped, {}}};
            NodalLoad<Dim, double> load;
            for (int i = 0; i < mesh.n_nodes(); ++i) {
                load.nodes.push_back(i);
            }
            load.forces = random.points<Dim, double>(mesh.n_nodes(), force);
            scenario.loads = {load};
            cases.push_back(scenario);
        }
        return cases;
    }

    /// Equilibria of a reference.
    template <StaticReference R>
    [[nodiscard]] std::vector<Motion<Dim, double>> equilibria(const R& reference, int count, double force) const {
        std::vector<Motion<Dim, double>> motions;
        for (auto& [motion, status] : record_statics(reference, pulls(count, force))) {
            REQUIRE(status == Status::converged);
            motions.push_back(std::move(motion));
        }
        return motions;
    }

    /// A network's own swings, from rest under a sudden load.
    [[nodiscard]] std::vector<Motion<Dim, double>> swings(const SpringNetwork<Dim, double>& network, int count,
                                                          double force, double dt, int frames) const {
        std::vector<Motion<Dim, double>> motions;
        for (const auto& scenario : pulls(count, force)) {
            SymplecticEulerOptions<double> fine;
            fine.step_fraction = 0.05;
            SymplecticEuler<Dim, double> stepper(network, fine);
            auto recording = record_stepper(stepper, scenario, {.dt = dt, .frames = frames});
            REQUIRE(recording.status == Status::converged);
            motions.push_back(std::move(recording.motion));
        }
        return motions;
    }

    /// Equilibria of linear elasticity, and the network of Van Gelder's closed form as prior.
    [[nodiscard]] TrajectoryProblem<Dim> elastic(const TrajectoryOptions& options, int count, double force) const {
        const IsotropicSolid solid{.young = 1., .poisson = 0.4};
        auto prior = springs_along_edges(mesh, {.density = 0.1});
        prior.stiffness = van_gelder(mesh, prior.springs, solid).stiffness;
        const fem::Model model{mesh, fem::LinearElastic{.young = solid.young, .poisson = solid.poisson}, 0.1};
        return TrajectoryProblem<Dim>(prior, equilibria(model, count, force), options);
    }
};

} // namespace springfit::test
