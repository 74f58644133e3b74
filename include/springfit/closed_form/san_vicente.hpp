// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <springfit/closed_form/detail/box_cell.hpp>
#include <springfit/solve/bounded_least_squares.hpp>

namespace springfit {

/// The tension test that the cells of `san_vicente` are fitted to; by default E and nu in the limit of small strain.
struct TensileCurves {
    double largest_strain = 0;                     ///< strains in (0, this] are matched; 0: the limit of small strain
    std::function<double(double strain)> stress{}; ///< force per undeformed area, Pa; empty: E strain
    std::function<double(double strain)> contraction{}; ///< shortening across, relative; empty: nu strain
    int samples = 20;                                   ///< strains at which the curves are read, >= 1
};

namespace detail {

/// Nominal stress of a lattice of unit cubes along its first axis and across, at the stretches along and across, per
/// unit of the stiffness of edges, face and body diagonals `[2 x 3]`.
template <std::floating_point Real>
[[nodiscard]] Eigen::Matrix<Real, 2, 3> cube_stress(Real along, Real across) {
    const Real face = std::sqrt((along * along + across * across) / 2); // stretches of the diagonals
    const Real body = std::sqrt((along * along + 2 * across * across) / 3);
    Eigen::Matrix<Real, 2, 3> stress;
    stress << 4 * (along - 1), 8 * (1 - 1 / face) * along, 4 * (1 - 1 / body) * along, //
        4 * (across - 1), 4 * (1 - 1 / face) * across + 4 * (across - 1), 4 * (1 - 1 / body) * across;
    return stress;
}

/// The same per unit of strain, in the limit of small strain, with `contraction` across.
template <std::floating_point Real>
[[nodiscard]] Eigen::Matrix<Real, 2, 3> cube_stress_rate(Real contraction) {
    const Real nu = contraction;
    Eigen::Matrix<Real, 2, 3> rate;
    rate << 4, 4 - 4 * nu, (4 - 8 * nu) / 3, //
        -4 * nu, 2 - 6 * nu, (4 - 8 * nu) / 3;
    return rate;
}

/// The square of what a cell misses of a tension test, k'(hessian k - 2 linear) + target, by the stiffnesses k of its
/// edges, face and body diagonals, in units of E and the side of the cube.
struct TensileMisfit {
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
    Eigen::Vector3d linear = Eigen::Vector3d::Zero();
    double target = 0;

    template <class Row>
    void add(const Eigen::MatrixBase<Row>& row, double stress) {
        hessian += row.row(0).transpose() * row.row(0) + 2 * row.row(1).transpose() * row.row(1);
        linear += stress * row.row(0).transpose();
        target += stress * stress;
    }

    /// As a part of the test's stress.
    template <class Stiffness>
    [[nodiscard]] double relative(const Eigen::MatrixBase<Stiffness>& k) const {
        return std::sqrt(maximum(0., target + k.dot(hessian * k - 2 * linear)) / target);
    }
};

template <std::same_as<IsotropicSolid> Solid>
[[nodiscard]] TensileMisfit tensile_misfit(const Solid& solid, const TensileCurves& curves) {
    TensileMisfit misfit;
    if (curves.largest_strain == 0) {
        misfit.add(cube_stress_rate(solid.poisson), 1);
        return misfit;
    }
    for (int s = 1; s <= curves.samples; ++s) {
        const double strain = curves.largest_strain * s / curves.samples;
        const double contraction = curves.contraction ? curves.contraction(strain) : solid.poisson * strain;
        const double stress = curves.stress ? curves.stress(strain) / solid.young : strain;
        require(contraction < 1, "contraction", "values below 1", contraction);
        require(std::isfinite(stress), "stress", "finite values", stress);
        misfit.add(cube_stress(1 + strain, 1 - contraction), stress);
    }
    return misfit;
}

/// The k >= 0 of least misfit and, among equals, of the least norm; 0 for diagonals that there are none of.
template <std::same_as<TensileMisfit> Misfit>
[[nodiscard]] Values<double> least_misfit(const Misfit& misfit, bool faces, bool bodies) {
    const double infinity = std::numeric_limits<double>::infinity();
    const Values<double> lower = Values<double>::Zero(3);
    Values<double> upper = lower;
    upper << infinity, faces ? infinity : 0, bodies ? infinity : 0;
    Values<double> k = lower;
    BoundedLeastSquares solver;
    const double near = 1e-6 * misfit.hessian.trace(); // steps of this proximal weight: the least norm among equals
    const Eigen::Matrix3d regular = misfit.hessian + near * Eigen::Matrix3d::Identity();
    for (int step = 0; step < 10; ++step) {
        (void)solver.solve(regular, Values<double>(misfit.linear + near * k), lower, upper, k);
    }
    return k;
}

} // namespace detail

/// Cubes braced by face diagonals, body diagonals or both (which, the springs tell), after the method of San-Vicente,
/// Aguinaga and Celigueta [SanVicente2012]: the three stiffnesses of a cell are fitted to a tension test, so that the
/// stress-strain and the contraction curve of the lattice are those of the material,
///
///     minimise sum over strains (P(k) - stress)^2 + 2 Q(k)^2   over k >= 0 ,
///
/// P the lattice's nominal stress along one of its axes and Q the one across, at the material's contraction. Both are
/// linear in k at any strain. Of the values that match equally well, those of the least norm are taken; k scales with
/// the side of the cube. The paper prints no formula known to us: objective, choice and solution are ours.
///
/// In small strain the tension along the axes is exact for any nu >= 0 with all springs, every uniform strain at
/// nu = 1/4. Throws InvalidArgument for a material or curve out of range, a cell that is no cube, and springs that
/// leave an edge, or one of the diagonals of a kind, without a spring. O(cells log springs).
template <std::floating_point Scalar>
[[nodiscard]] ClosedForm<Scalar> san_vicente(const Mesh<3, Scalar, Hex8>& mesh, const NodePairs& springs,
                                             const IsotropicSolid& solid, const TensileCurves& curves = {}) {
    const auto constants = detail::constants<3, Hex8, Scalar>(solid);
    require(mesh.n_cells() > 0, "mesh", "at least one cell", "none");
    require(curves.largest_strain >= 0 && curves.largest_strain < 10, "largest_strain", "a value in [0, 10)",
            curves.largest_strain);
    require(curves.samples >= 1, "samples", "at least one", curves.samples);
    const bool small = curves.largest_strain == 0;
    require(!small || (!curves.stress && !curves.contraction), "largest_strain", "a positive strain, with curves",
            curves.largest_strain);
    const SpringLookup lookup(springs);
    const auto has = [&](const std::array<int, 2>& ends) {
        return lookup.find(mesh.cells(ends[0], 0), mesh.cells(ends[1], 0)) >= 0;
    };
    const bool faces = has(Hex8::diagonals.front());
    const bool bodies = has(Hex8::diagonals.back());
    require(faces || bodies, "springs", "face or body diagonals", "neither");

    const detail::TensileMisfit misfit = detail::tensile_misfit(solid, curves);
    const Values<double> k = detail::least_misfit(misfit, faces, bodies);
    const double missed = misfit.relative(k);

    const Scalar stiffness_of[3] = {static_cast<Scalar>(solid.young * k(0)), static_cast<Scalar>(solid.young * k(1)),
                                    static_cast<Scalar>(solid.young * k(2))};
    Values<Scalar> stiffness = Values<Scalar>::Zero(springs.cols());
    std::vector<bool> touched(static_cast<std::size_t>(springs.cols()), false);
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const Vector<3, Scalar> sides = detail::box_sides(mesh, c);
        if (!detail::all_equal(sides.cwiseAbs2())) {
            throw InvalidArgument("mesh", "cubes (cubic_cell and baudet take boxes)",
                                  text("cell ", c, " with sides ", sides.transpose()));
        }
        const auto add = [&](const std::array<int, 2>& ends, int kind) {
            const int spring = detail::spring_on_edge(lookup, mesh.cells(ends[0], c), mesh.cells(ends[1], c));
            stiffness(spring) += sides.mean() * stiffness_of[kind];
            touched[static_cast<std::size_t>(spring)] = true;
        };
        for (const auto& edge : Hex8::edges) {
            add(edge, 0);
        }
        for (std::size_t d = 0; d < 16; ++d) {
            if (d < 12 ? faces : bodies) {
                add(Hex8::diagonals[d], d < 12 ? 1 : 2);
            }
        }
    }
    const bool met = missed < detail::exactness;
    return detail::close(
        std::move(stiffness), touched, met && small && detail::has_poisson(constants, 0.25),
        met ? std::string("exact in tension along the axes of the cubes alone")
            : text("misses ", std::ceil(100 * missed - 1e-6), " % of the tension along the axes of the cubes"));
}

} // namespace springfit
