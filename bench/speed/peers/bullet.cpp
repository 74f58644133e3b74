// SPDX-License-Identifier: BSD-3-Clause
// Bullet's soft bodies. The library comes in single and in double precision, whose names clash: one executable each.

#include <memory>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMassSpringForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include <springfit/simulate/stable_step.hpp>

#include "../bodies.hpp"
#include "peers.hpp"

namespace bench::peers {

namespace {

using springfit::Index;
using Network = springfit::SpringNetwork<3, btScalar>;

/// All nodes at rest, the network stretched by 1 %.
void stretch(btSoftBody& body, const Network& network) {
    for (int i = 0; i < body.m_nodes.size(); ++i) {
        const auto x = network.rest_positions.col(i);
        btSoftBody::Node& node = body.m_nodes[i];
        node.m_x = btScalar(1.01) * btVector3(x(0), x(1), x(2));
        node.m_q = node.m_x;
        node.m_v.setZero();
        node.m_vn.setZero();
    }
}

/// A soft body of the network's nodes and springs, stretched by 1 %. It collides with nothing.
std::unique_ptr<btSoftBody> soft_body(const Network& network, btSoftBodyWorldInfo& world_info) {
    btAlignedObjectArray<btVector3> positions;
    btAlignedObjectArray<btScalar> masses;
    for (Index i = 0; i < network.n_nodes(); ++i) {
        const auto x = network.rest_positions.col(i);
        positions.push_back(btVector3(x(0), x(1), x(2)));
        masses.push_back(network.mass(i));
    }
    auto body = std::make_unique<btSoftBody>(&world_info, positions.size(), &positions[0], &masses[0]);
    body->m_links.reserve(static_cast<int>(network.n_springs()));
    for (Index e = 0; e < network.n_springs(); ++e) {
        body->appendLink(network.springs(0, e), network.springs(1, e));
    }
    body->m_cfg.piterations = 1;
    body->m_cfg.collisions = 0;
    body->setActivationState(DISABLE_DEACTIVATION);
    body->updateConstants();
    body->m_bUpdateRtCst = false;
    stretch(*body, network);
    for (int i = 0; i < body->m_nodes.size(); ++i) {
        body->m_nodes[i].index = i;
    }
    return body;
}

bool is_finite(const btSoftBody& body) {
    for (int i = 0; i < body.m_nodes.size(); ++i) {
        const btVector3& x = body.m_nodes[i].m_x;
        if (!(std::isfinite(x.x()) && std::isfinite(x.y()) && std::isfinite(x.z()))) {
            return false;
        }
    }
    return true;
}

/// What both worlds are made of; no gravity, no air.
struct Parts {
    btSoftBodyRigidBodyCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btDbvtBroadphase broadphase;
};

void prepare(btSoftBodyWorldInfo& info, Parts& parts) {
    info.m_broadphase = &parts.broadphase;
    info.m_dispatcher = &parts.dispatcher;
    info.m_gravity.setZero();
    info.air_density = 0;
    info.m_sparsesdf.Initialize();
}

/// Ends a benchmark of steps of the body.
void finish(benchmark::State& state, const btSoftBody& body, const Network& network) {
    if (!is_finite(body)) {
        state.SkipWithError("the body flew apart");
    }
    count(state, network.n_springs());
}

/// One step of the world of constraints on positions: one pass over the links.
void world_step(benchmark::State& state, Index springs) {
    const Network network = bench::network<3, btScalar>(springs);
    Parts parts;
    btSequentialImpulseConstraintSolver solver;
    btSoftRigidDynamicsWorld world(&parts.dispatcher, &parts.broadphase, &solver, &parts.configuration);
    world.setGravity(btVector3(0, 0, 0));
    prepare(world.getWorldInfo(), parts);
    const auto body = soft_body(network, world.getWorldInfo());
    world.addSoftBody(body.get());
    const btScalar h = stable_step(network) / 2;
    world.stepSimulation(h, 0); // the first step allocates
    for (auto _ : state) {
        world.stepSimulation(h, 0);
        benchmark::ClobberMemory();
    }
    finish(state, *body, network);
    world.removeSoftBody(body.get());
}

/// A stiffness for all links: the force of Bullet's deformable bodies has no other.
btScalar mean_stiffness(const Network& network) {
    return network.stiffness.mean();
}

/// Forces of the links alone, without damping and integration.
void elastic_force(benchmark::State& state, Index springs) {
    const Network network = bench::network<3, btScalar>(springs);
    Parts parts;
    btSoftBodyWorldInfo info;
    prepare(info, parts);
    const auto body = soft_body(network, info);
    btDeformableMassSpringForce springs_force(mean_stiffness(network), 0);
    springs_force.addSoftBody(body.get());
    btAlignedObjectArray<btVector3> force;
    force.resize(body->m_nodes.size(), btVector3(0, 0, 0));
    for (auto _ : state) {
        springs_force.addScaledElasticForce(btScalar(1e-3), force);
        benchmark::DoNotOptimize(&force[0]);
        benchmark::ClobberMemory();
    }
    count(state, network.n_springs());
}

/// One step of the world of deformable bodies: half a stable step with elastic forces explicit, 30 with them implicit.
/// Damping is implicit in both.
void deformable_step(benchmark::State& state, Index springs, bool implicit) {
    const Network network = bench::network<3, btScalar>(springs);
    Parts parts;
    btDeformableBodySolver deformable_solver;
    btDeformableMultiBodyConstraintSolver solver;
    solver.setDeformableSolver(&deformable_solver);
    btDeformableMultiBodyDynamicsWorld world(&parts.dispatcher, &parts.broadphase, &solver, &parts.configuration,
                                             &deformable_solver);
    world.setGravity(btVector3(0, 0, 0));
    prepare(world.getWorldInfo(), parts);
    world.setImplicit(implicit);
    world.setLineSearch(false);
    world.setUseProjection(implicit); // conjugate gradients; without them an implicit step leaves the body where it is
    const auto body = soft_body(network, world.getWorldInfo());
    world.addSoftBody(body.get());
    const btScalar stiffness = mean_stiffness(network);
    btDeformableMassSpringForce springs_force(stiffness, btScalar(1e-3) * stiffness);
    world.addForce(body.get(), &springs_force);
    const btScalar h = implicit ? 30 * stable_step(network) : stable_step(network) / 2;
    for (auto _ : state) {
        state.PauseTiming();
        stretch(*body, network); // its solver has nothing to do in a body that has come to rest
        state.ResumeTiming();
        world.stepSimulation(h, 0);
        benchmark::ClobberMemory();
    }
    if (!(body->m_nodes[body->m_nodes.size() - 1].m_v.length2() > 0)) {
        state.SkipWithError("the body did not move"); // Bullet sets velocities that are not numbers to 0
    }
    finish(state, *body, network);
    world.removeForce(body.get(), &springs_force);
    world.removeSoftBody(body.get());
}

} // namespace

void add_bullet(Index springs) {
    const auto add = [&](const char* what, auto function) {
        benchmark::RegisterBenchmark(bench::name<3, btScalar>(what, springs).c_str(), function, springs);
    };
    add("bullet_world_step", world_step);
    add("bullet_deformable_elastic_force", elastic_force);
    add("bullet_deformable_explicit_step", [](benchmark::State& state, Index n) { deformable_step(state, n, false); });
    if (springs <= 100000) {
        add("bullet_deformable_implicit_step",
            [](benchmark::State& state, Index n) { deformable_step(state, n, true); });
    }
}

} // namespace bench::peers
