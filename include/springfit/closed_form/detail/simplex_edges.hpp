// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/closed_form/isotropic_solid.hpp>
#include <springfit/network/builders.hpp>

namespace springfit::detail {

/// An edge as one simplex sees it.
template <std::floating_point Scalar>
struct SimplexEdge {
    Scalar volume;         ///< of the cell, V or A
    Scalar squared_length; ///< l^2
    Scalar gradients;      ///< grad N_i . grad N_j; in a triangle -cot(theta) / (2 A), theta opposite the edge
};

/// The spring of an edge; throws InvalidArgument where there is none.
inline int spring_on_edge(const SpringLookup& lookup, int i, int j) {
    const int spring = lookup.find(i, j);
    if (spring < 0) {
        throw InvalidArgument("springs", "a spring on every edge of the mesh", text("none from ", i, " to ", j));
    }
    return spring;
}

/// Sums `share(edge)` over the cells at each spring. The springs join the nodes of `corner_mesh(mesh)`.
///
/// A triangle's energy is a full quadratic in the strains of its three edges, of which springs have the diagonal: the
/// rest is 0 for cot_i cot_j = (1 - nu) / 2 at every pair of angles, so in equilateral triangles at nu = 1/3 alone.
/// `in_space` is the caveat for tetrahedra, where no shape gives that.
template <int Dim, std::floating_point Scalar, SimplexCell Cell, class Share>
ClosedForm<Scalar>
sum_over_simplices(const Mesh<Dim, Scalar, Cell>& mesh, const NodePairs& springs,
                   const ElasticConstants<Scalar>& constants, const Share& share,
                   std::string_view in_space = "exact for no tetrahedra; nearest at Poisson's ratio 1/4") {
    constexpr int d = Cell::dimension;
    const auto corners = corner_mesh(mesh);
    const SpringLookup lookup(springs);
    Values<Scalar> stiffness = Values<Scalar>::Zero(springs.cols());
    std::vector<bool> touched(static_cast<std::size_t>(springs.cols()), false);
    bool exact = Cell::dimension == 2 && has_poisson(constants, 1. / 3);
    for (Index c = 0; c < corners.n_cells(); ++c) {
        const Scalar volume = corner_volumes(corners, c).sum();
        const auto x = corners.cell_nodes(c);
        const Eigen::Matrix<Scalar, Dim, d> sides = x.template rightCols<d>().colwise() - x.col(0);
        Eigen::Matrix<Scalar, Dim, d + 1> gradients; // of the shape functions, one column each
        const Eigen::Matrix<Scalar, d, d> metric = sides.transpose() * sides;
        gradients.template rightCols<d>() = sides * metric.inverse();
        gradients.col(0) = -gradients.template rightCols<d>().rowwise().sum();
        Vector<static_cast<int>(Cell::edges.size()), Scalar> squares;
        for (std::size_t e = 0; e < Cell::edges.size(); ++e) {
            const auto [a, b] = Cell::edges[e];
            const int spring = spring_on_edge(lookup, corners.cells(a, c), corners.cells(b, c));
            squares(static_cast<Index>(e)) = (x.col(b) - x.col(a)).squaredNorm();
            stiffness(spring) += share(
                SimplexEdge<Scalar>{volume, squares(static_cast<Index>(e)), gradients.col(a).dot(gradients.col(b))});
            touched[static_cast<std::size_t>(spring)] = true;
        }
        exact = exact && all_equal(squares);
    }
    return close(std::move(stiffness), touched, exact,
                 Cell::dimension == 3 ? in_space : "exact for equilateral triangles with Poisson's ratio 1/3 alone");
}

} // namespace springfit::detail
