// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <string>

#include <springfit/core/error.hpp>
#include <springfit/core/types.hpp>
#include <springfit/mesh/cell.hpp>
#include <springfit/network/spring_network.hpp>

namespace springfit {

/// The material as closed forms need it.
struct IsotropicSolid {
    double young = 0;          ///< Young's modulus E > 0, Pa
    double poisson = 0;        ///< Poisson's ratio nu in (-1, 0.5)
    double thickness = 1;      ///< h > 0, m; of plane bodies and membranes
    bool plane_strain = false; ///< of plane bodies, else plane stress; membranes are in plane stress
};

/// The values that a closed form gives to the springs.
template <std::floating_point Scalar>
struct ClosedForm {
    Values<Scalar> stiffness; ///< k_e >= 0 [n_springs], N/m
    Index n_clamped = 0;      ///< values that would be negative and are 0 instead
    Index n_without_cell = 0; ///< springs of no cell, as of a second ring: the formula says nothing, they get 0
    /// l_e > 0 [n_springs], m, of a form whose springs pull or push at rest; empty: the distance of the ends.
    Values<Scalar> rest_length{};
    /// For what the form is exact, where that is not what was asked; empty where every uniform strain of this mesh and
    /// this material has its exact energy.
    std::string caveat{};
};

/// A closed form with the name of its function.
template <std::floating_point Scalar>
struct NamedClosedForm {
    std::string name;
    ClosedForm<Scalar> form;
};

/// Gives a network the stiffness of a closed form, and its rest lengths where it has any. Throws InvalidArgument for
/// another number of springs.
template <int Dim, std::floating_point Scalar>
void apply(const ClosedForm<Scalar>& form, SpringNetwork<Dim, Scalar>& network) {
    require(form.stiffness.size() == network.n_springs(), "form", text(network.n_springs(), " values, one per spring"),
            form.stiffness.size());
    network.stiffness = form.stiffness;
    if (form.rest_length.size() > 0) {
        network.rest_length = form.rest_length;
    }
}

namespace detail {

/// Lame's constants as a body of the given dimension feels them: in the plane lambda is the plane one and both carry
/// the thickness. E and nu are those of a plane stress with these constants (plane bodies) or the solid's own.
template <std::floating_point Scalar>
struct ElasticConstants {
    Scalar lambda;
    Scalar mu;
    Scalar young;
    Scalar poisson;
};

template <int Dim, CellType Cell, std::floating_point Scalar>
ElasticConstants<Scalar> constants(const IsotropicSolid& solid) {
    const double e = solid.young;
    const double nu = solid.poisson;
    require(e > 0 && std::isfinite(e), "young", "a positive modulus", e);
    require(nu > -1 && nu < 0.5, "poisson", "a value in (-1, 0.5)", nu);
    require(solid.thickness > 0 && std::isfinite(solid.thickness), "thickness", "a positive thickness",
            solid.thickness);
    require(!solid.plane_strain || (Dim == 2 && Cell::dimension == 2), "plane_strain", "a plane body",
            Cell::dimension == 3 ? "a solid" : "a membrane");
    const double mu = e / (2 * (1 + nu));
    const double lambda = e * nu / ((1 + nu) * (1 - 2 * nu));
    if (Cell::dimension == 3) {
        return {static_cast<Scalar>(lambda), static_cast<Scalar>(mu), static_cast<Scalar>(e), static_cast<Scalar>(nu)};
    }
    const double plane = solid.plane_strain ? lambda : e * nu / (1 - nu * nu);
    const double h = solid.thickness;
    return {static_cast<Scalar>(h * plane), static_cast<Scalar>(h * mu),
            static_cast<Scalar>(h * 4 * mu * (plane + mu) / (plane + 2 * mu)),
            static_cast<Scalar>(plane / (plane + 2 * mu))};
}

/// Relative tolerance within which a shape is regular, or Poisson's ratio the one that a form is exact for.
inline constexpr double exactness = 1e-4;

/// True where the values, squared lengths or the like, are the same.
template <class Squares>
bool all_equal(const Squares& squares) {
    return squares.maxCoeff() - squares.minCoeff() < 2 * exactness * squares.maxCoeff();
}

template <std::floating_point Scalar>
bool has_poisson(const ElasticConstants<Scalar>& constants, double poisson) {
    return std::abs(static_cast<double>(constants.poisson) - poisson) < exactness;
}

/// Sets negative values to 0 and counts them; `touched` marks the springs that a cell gave something to. `caveat` is
/// what holds unless the form is `exact` for what was asked.
template <std::floating_point Scalar>
ClosedForm<Scalar> close(Values<Scalar>&& stiffness, const std::vector<bool>& touched, bool exact,
                         std::string_view caveat) {
    ClosedForm<Scalar> result{std::move(stiffness), 0, 0};
    for (Index e = 0; e < result.stiffness.size(); ++e) {
        if (result.stiffness(e) < 0) {
            result.stiffness(e) = 0;
            ++result.n_clamped;
        }
        result.n_without_cell += touched[static_cast<std::size_t>(e)] ? 0 : 1;
    }
    if (!exact) {
        result.caveat = caveat;
    } else if (result.n_clamped > 0) {
        result.caveat = "not exact where a negative value was set to 0";
    }
    return result;
}

} // namespace detail

} // namespace springfit
