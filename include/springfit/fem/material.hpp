// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <limits>
#include <string_view>

#include <springfit/core/error.hpp>

namespace springfit::fem {

/// Hooke's law for small strains eps = sym(F) - I: W = mu eps : eps + lambda/2 theta^2, theta = tr eps.
struct LinearElastic {
    static constexpr std::string_view name = "linear elastic";
    double young = 0;   ///< Young's modulus E, Pa, > 0
    double poisson = 0; ///< Poisson's ratio nu, in (-1, 0.5)
};

/// Hooke's law on the stretch S of the polar decomposition F = R S: W = mu |S - I|^2 + lambda/2 theta^2,
/// theta = tr S - d. The derivatives are those of the polar decomposition itself, nothing is left out.
struct Corotated {
    static constexpr std::string_view name = "corotated";
    double young = 0;   ///< Young's modulus E, Pa, > 0
    double poisson = 0; ///< Poisson's ratio nu, in (-1, 0.5)
};

/// Hooke's law on Green's strain E = (F'F - I) / 2: W = mu E : E + lambda/2 theta^2, theta = tr E.
/// Softens under compression and buckles at 1 / sqrt(3) of the length: keep to moderate strains.
struct StVenantKirchhoff {
    static constexpr std::string_view name = "St Venant-Kirchhoff";
    double young = 0;   ///< Young's modulus E, Pa, > 0
    double poisson = 0; ///< Poisson's ratio nu, in (-1, 0.5)
};

/// Compressible neo-Hookean rubber: W = mu/2 (I1 - d) - mu ln J + lambda/2 (ln J)^2, I1 = tr F'F, theta = J = det F.
/// The energy is infinite where J <= 0: cells do not turn inside out.
struct NeoHookean {
    static constexpr std::string_view name = "neo-Hookean";
    double young = 0;   ///< Young's modulus E, Pa, > 0
    double poisson = 0; ///< Poisson's ratio nu, in (-1, 0.5)
};

/// A material of the `fem` room: isotropic, W(F) = shear(F) + U(theta(F)), from E and nu.
///
/// Models of the concept: `LinearElastic`, `Corotated`, `StVenantKirchhoff`, `NeoHookean`.
template <class M>
concept Material = requires(const M& material) {
    { M::name } -> std::convertible_to<std::string_view>;
    { material.young } -> std::convertible_to<double>;
    { material.poisson } -> std::convertible_to<double>;
};

/// Throws InvalidArgument unless E > 0 and -1 < nu < 0.5.
template <Material M>
void validate(const M& material) {
    require(material.young > 0 && material.young < std::numeric_limits<double>::infinity(), "young",
            "a positive modulus", material.young);
    require(material.poisson > -1 && material.poisson < 0.5, "poisson", "a value in (-1, 0.5)", material.poisson);
}

/// Shear modulus mu = E / (2 (1 + nu)), Pa.
template <Material M>
[[nodiscard]] double shear_modulus(const M& material) {
    return material.young / (2 * (1 + material.poisson));
}

/// Lamé's first parameter lambda = E nu / ((1 + nu)(1 - 2 nu)), Pa.
template <Material M>
[[nodiscard]] double lame_lambda(const M& material) {
    return material.young * material.poisson / ((1 + material.poisson) * (1 - 2 * material.poisson));
}

/// The constant in the place of lambda in plane stress: E nu / (1 - nu^2), Pa.
template <Material M>
[[nodiscard]] double plane_stress_lambda(const M& material) {
    return material.young * material.poisson / (1 - material.poisson * material.poisson);
}

} // namespace springfit::fem
