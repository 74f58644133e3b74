// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include <springfit/motion/body.hpp>

namespace springfit {

/// A family of loads.
enum class LoadKind {
    body_force, ///< a smooth random field of force per mass, a few waves over the body
    patch,      ///< a random push or pull on a patch of the surface
    gravity,    ///< uniform, in a random direction
    twist       ///< forces around an axis through the centre, growing with the distance from it
};

[[nodiscard]] constexpr std::string_view to_string(LoadKind kind) {
    switch (kind) {
    case LoadKind::body_force: return "body force";
    case LoadKind::patch: return "patch";
    case LoadKind::gravity: return "gravity";
    case LoadKind::twist: return "twist";
    }
    return "unknown";
}

/// Amplitude that rises smoothly from 0 to 1 over `ramp`, holds, and from `release` on falls as smoothly over half of
/// `ramp`: afterwards the body swings freely.
template <std::floating_point Scalar>
[[nodiscard]] Amplitude<Scalar> ramp_and_release(Scalar ramp, Scalar release) {
    require(ramp > 0, "ramp", "a positive time", ramp);
    require(release >= ramp, "release", text("a time not before the end of the ramp, ", ramp), release);
    return [ramp, release](Scalar time) {
        const auto step = [](Scalar s) {
            s = std::clamp(s, Scalar(0), Scalar(1));
            return s * s * (3 - 2 * s);
        };
        return step(time / ramp) - step(2 * (time - release) / ramp);
    };
}

namespace detail {

template <int Dim, std::floating_point Scalar>
Vector<Dim, Scalar> random_direction(std::mt19937& random) {
    std::normal_distribution<Scalar> normal;
    Vector<Dim, Scalar> direction;
    do {
        for (int d = 0; d < Dim; ++d) {
            direction(d) = normal(random);
        }
    } while (!(direction.norm() > Scalar(1e-3)));
    return direction.normalized();
}

/// Force per mass at every node `[Dim x n_nodes]`, of order 1.
template <int Dim, std::floating_point Scalar>
Points<Dim, Scalar> force_per_mass(LoadKind kind, const Body<Dim, Scalar>& body, std::mt19937& random) {
    const auto& x = body.rest_positions;
    const Vector<Dim, Scalar> low = x.rowwise().minCoeff();
    const Vector<Dim, Scalar> high = x.rowwise().maxCoeff();
    const Vector<Dim, Scalar> centre = (low + high) / 2;
    const Scalar size = (high - low).norm();
    Points<Dim, Scalar> field = Points<Dim, Scalar>::Zero(Dim, x.cols());
    switch (kind) {
    case LoadKind::gravity: field.colwise() += random_direction<Dim, Scalar>(random); break;
    case LoadKind::body_force:
        for (int wave = 0; wave < 3; ++wave) {
            std::uniform_real_distribution<Scalar> phase(0, 2 * std::numbers::pi_v<Scalar>);
            const Vector<Dim, Scalar> direction = random_direction<Dim, Scalar>(random);
            const Vector<Dim, Scalar> wave_vector =
                std::numbers::pi_v<Scalar> / size * static_cast<Scalar>(wave + 1) * random_direction<Dim, Scalar>(random);
            const Scalar shift = phase(random);
            for (Index i = 0; i < x.cols(); ++i) {
                field.col(i) += std::sin(wave_vector.dot(x.col(i) - centre) + shift) * direction;
            }
        }
        break;
    case LoadKind::patch: {
        std::uniform_int_distribution<std::size_t> pick(0, body.surface.size() - 1);
        const Vector<Dim, Scalar> middle = x.col(body.surface[pick(random)]);
        const Vector<Dim, Scalar> direction = random_direction<Dim, Scalar>(random);
        const Scalar radius = size / 8;
        for (int node : body.surface) {
            const Scalar distance = (x.col(node) - middle).norm() / radius;
            if (distance < 1) {
                field.col(node) = (1 - distance * distance) * direction;
            }
        }
        break;
    }
    case LoadKind::twist: {
        Vector<3, Scalar> axis = Vector<3, Scalar>::UnitZ();
        if constexpr (Dim == 3) {
            axis = random_direction<3, Scalar>(random);
        }
        for (Index i = 0; i < x.cols(); ++i) {
            Vector<3, Scalar> arm = Vector<3, Scalar>::Zero();
            arm.template head<Dim>() = (x.col(i) - centre) / size;
            field.col(i) = axis.cross(arm).template head<Dim>();
        }
        break;
    }
    }
    return field;
}

} // namespace detail

/// One random load of a kind on a body, fixed by the seed: its forces are masses times a field of order 1 m/s^2, constant
/// in time; scale it to the strain you want, and give it an amplitude. Throws InvalidArgument where the body has no
/// surface nodes.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Scenario<Dim, Scalar> random_load(LoadKind kind, const Body<Dim, Scalar>& body, unsigned seed) {
    require(body.masses.size() == body.rest_positions.cols(), "body", "one mass per node", body.masses.size());
    require(!body.surface.empty(), "body", "surface nodes", "none");
    std::mt19937 random(seed);
    Scenario<Dim, Scalar> scenario;
    scenario.name = text(to_string(kind), " ", seed);
    scenario.clamps = body.clamps;
    NodalLoad<Dim, Scalar> load;
    const Points<Dim, Scalar> field = detail::force_per_mass(kind, body, random);
    for (Index i = 0; i < field.cols(); ++i) {
        if (field.col(i).squaredNorm() > 0) {
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

/// Load cases that a fit sees, and others that it never sees.
template <int Dim, std::floating_point Scalar>
struct LoadCases {
    std::vector<Scenario<Dim, Scalar>> training;
    std::vector<Scenario<Dim, Scalar>> held_out;
};

struct LoadCaseOptions {
    int training = 6;  ///< body forces and patches in turn, >= 1
    int held_out = 3;  ///< an unseen patch, then kinds that training never shows: gravity, twist, ..., >= 1
    unsigned seed = 1; ///< fixes every case
};

/// Random load cases, split into training and held-out.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] LoadCases<Dim, Scalar> random_loads(const Body<Dim, Scalar>& body, const LoadCaseOptions& options) {
    require(options.training >= 1, "training", "at least one load case", options.training);
    require(options.held_out >= 1, "held_out", "at least one load case", options.held_out);
    constexpr LoadKind seen[] = {LoadKind::body_force, LoadKind::patch};
    constexpr LoadKind unseen[] = {LoadKind::patch, LoadKind::gravity, LoadKind::twist};
    LoadCases<Dim, Scalar> cases;
    unsigned seed = 1000 * options.seed;
    for (int c = 0; c < options.training; ++c) {
        cases.training.push_back(random_load(seen[c % 2], body, seed++));
    }
    for (int c = 0; c < options.held_out; ++c) {
        cases.held_out.push_back(random_load(unseen[c % 3], body, seed++));
    }
    return cases;
}

/// Multiplies all forces and accelerations of a scenario and gives them one amplitude over time.
template <int Dim, std::floating_point Scalar>
void set_loading(Scenario<Dim, Scalar>& scenario, Scalar factor, const Amplitude<Scalar>& amplitude) {
    for (auto& load : scenario.loads) {
        load.forces *= factor;
        load.amplitude = amplitude;
    }
    for (auto& gravity : scenario.gravity) {
        gravity.acceleration *= factor;
        gravity.amplitude = amplitude;
    }
}

} // namespace springfit
