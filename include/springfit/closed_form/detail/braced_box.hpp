// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/closed_form/detail/box_cell.hpp>

namespace springfit::detail {

/// Stiffness of boxes braced by the diagonals that the springs hold, such that every shear has the modulus mu and a
/// strain along one axis alone the stress `normal` mu times the strain along that axis. Per cell of sides a_p, with V
/// the volume and s = a_1^2 + a_2^2 + a_3^2,
///
///     k_body    = b mu s V / (4 max a_p^2 a_q^2) ,
///     k_face,pq = (a_p^2 + a_q^2) (mu V / (4 a_p^2 a_q^2) - k_body / s) ,
///     k_edge,p  = normal mu V / (4 a_p^2) - sum_q a_p^2 k_face,pq / (a_p^2 + a_q^2) - a_p^2 k_body / s ,
///
/// where b, the share of the body diagonals in the shear, is 0, 1 (cubes alone) or, with both, 1/2.
template <std::floating_point Scalar>
ClosedForm<Scalar> braced_boxes(const Mesh<3, Scalar, Hex8>& mesh, const NodePairs& springs, Scalar mu, Scalar normal,
                                bool exact) {
    constexpr int planes[12] = {0, 0, 0, 0, 1, 1, 2, 2, 1, 1, 2, 2}; // of the face diagonals: xy, xz, yz
    constexpr int axes[12] = {0, 1, 0, 1, 0, 1, 0, 1, 2, 2, 2, 2};   // of the edges
    constexpr int plane_axes[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    require(mesh.n_cells() > 0, "mesh", "at least one cell", "none");
    const SpringLookup lookup(springs);
    const auto has = [&](const std::array<int, 2>& ends) {
        return lookup.find(mesh.cells(ends[0], 0), mesh.cells(ends[1], 0)) >= 0;
    };
    const bool faces = has(Hex8::diagonals.front());
    const bool bodies = has(Hex8::diagonals.back());
    require(faces || bodies, "springs", "face or body diagonals", "neither");
    const Scalar body_share = !bodies ? Scalar(0) : faces ? Scalar(0.5) : Scalar(1);

    Values<Scalar> stiffness = Values<Scalar>::Zero(springs.cols());
    std::vector<bool> touched(static_cast<std::size_t>(springs.cols()), false);
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const Vector<3, Scalar> a2 = box_sides(mesh, c).cwiseAbs2();
        const Scalar volume = std::sqrt(a2.prod());
        if (!faces && !all_equal(a2)) {
            throw InvalidArgument("mesh", "cubes, where body diagonals are the only bracing",
                                  text("cell ", c, " with sides ", a2.cwiseSqrt().transpose()));
        }
        const Scalar most = std::max({a2(0) * a2(1), a2(0) * a2(2), a2(1) * a2(2)});
        const Scalar body = body_share * mu * a2.sum() * volume / (4 * most);
        Scalar face[3];
        Vector<3, Scalar> edge = (normal * mu * volume / 4) * a2.cwiseInverse() - body / a2.sum() * a2;
        for (int plane = 0; plane < 3; ++plane) {
            const Scalar p2 = a2(plane_axes[plane][0]);
            const Scalar q2 = a2(plane_axes[plane][1]);
            face[plane] = faces ? (p2 + q2) * (mu * volume / (4 * p2 * q2) - body / a2.sum()) : Scalar(0);
            edge(plane_axes[plane][0]) -= p2 * face[plane] / (p2 + q2);
            edge(plane_axes[plane][1]) -= q2 * face[plane] / (p2 + q2);
        }
        const auto add = [&](const std::array<int, 2>& ends, Scalar value) {
            const int spring = spring_on_edge(lookup, mesh.cells(ends[0], c), mesh.cells(ends[1], c));
            stiffness(spring) += value;
            touched[static_cast<std::size_t>(spring)] = true;
        };
        for (std::size_t e = 0; e < 12; ++e) {
            add(Hex8::edges[e], edge(axes[e]));
            if (faces) {
                add(Hex8::diagonals[e], face[planes[e]]);
            }
        }
        for (std::size_t d = 12; bodies && d < 16; ++d) {
            add(Hex8::diagonals[d], body);
        }
    }
    return close(std::move(stiffness), touched, exact, "exact for Poisson's ratio 1/4 alone; in shear for any");
}

} // namespace springfit::detail
