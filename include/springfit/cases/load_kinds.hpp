// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <springfit/cases/detail/load_fields.hpp>

namespace springfit {

/// A family of loads: fields of force per mass, of order 1 m/s^2.
enum class LoadKind {
    body_force, ///< a smooth random field all over the body, up to three half waves long
    patch,      ///< a push or pull on a patch of the surface
    pull,       ///< two patches of the surface drawn apart: no net force, no net moment
    gravity,    ///< uniform
    stretch,    ///< away from the clamp, growing with the distance from it
    bend,       ///< across that direction, growing likewise
    twist,      ///< around an axis about that direction (in the plane: around a point of the body), growing likewise
    press ///< the surface pressed together across a direction, growing with the square of the distance to the middle
};

/// The kinds that training sees: they reach every part of a body at random.
inline constexpr std::array training_kinds{LoadKind::body_force, LoadKind::patch, LoadKind::pull};

/// The kinds that training never sees: what a body is used for.
inline constexpr std::array held_out_kinds{LoadKind::gravity, LoadKind::stretch, LoadKind::bend, LoadKind::twist,
                                           LoadKind::press};

[[nodiscard]] constexpr std::string_view to_string(LoadKind kind) {
    switch (kind) {
    case LoadKind::body_force: return "body force";
    case LoadKind::patch: return "patch";
    case LoadKind::pull: return "pull";
    case LoadKind::gravity: return "gravity";
    case LoadKind::stretch: return "stretch";
    case LoadKind::bend: return "bend";
    case LoadKind::twist: return "twist";
    case LoadKind::press: return "press";
    }
    return "unknown";
}

/// One random load of a kind on a body under its clamps, fixed by the seed: forces m_i b_i on the free nodes, b of the
/// kind's field, constant in time. Scale it to the strain you want (`scale_to_strain`), and give it an amplitude.
///
/// Forces go by positions, not by node numbers; on a flat sheet in space they lie within its plane, where its stiffness
/// is. Throws InvalidArgument where no node is free, and for kinds that act on the surface where none of its nodes is.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Scenario<Dim, Scalar> random_load(LoadKind kind, const Specimen<Dim, Scalar>& body, unsigned seed) {
    validate(body);
    Scenario<Dim, Scalar> scenario;
    scenario.name = text(to_string(kind), " ", seed);
    scenario.clamps = body.clamps;
    const std::vector<int> clamped = clamped_nodes(scenario, body.n_nodes());
    require(static_cast<Index>(clamped.size()) < body.n_nodes(), "body", "nodes left to move", "none");
    const detail::LoadFieldSampler<Dim, Scalar> ground(body, clamped);
    std::mt19937 random(seed);
    const auto field = [&]() -> Points<Dim, Scalar> {
        const bool on_surface = kind == LoadKind::patch || kind == LoadKind::pull || kind == LoadKind::press;
        require(!on_surface || !ground.free_surface_nodes().empty(), "body", "free surface nodes", "none");
        switch (kind) {
        case LoadKind::body_force: return ground.waves(random);
        case LoadKind::patch: return ground.patch(random);
        case LoadKind::pull: return ground.pull(random);
        case LoadKind::gravity: return ground.uniform(random);
        case LoadKind::stretch: return ground.stretch(random);
        case LoadKind::bend: return ground.bend(random);
        case LoadKind::twist: return ground.twist(random);
        case LoadKind::press: return ground.press(random);
        }
        throw InvalidArgument("kind", "a kind of load", text(static_cast<int>(kind)));
    }();
    NodalLoad<Dim, Scalar> load;
    for (Index i = 0; i < field.cols(); ++i) {
        if (!ground.is_held(i) && field.col(i).squaredNorm() > 0) {
            load.nodes.push_back(static_cast<int>(i));
        }
    }
    load.forces.resize(Dim, static_cast<Index>(load.nodes.size()));
    for (std::size_t a = 0; a < load.nodes.size(); ++a) {
        load.forces.col(static_cast<Index>(a)) = body.masses(load.nodes[a]) * field.col(load.nodes[a]);
    }
    scenario.loads.push_back(std::move(load));
    return scenario;
}

} // namespace springfit
