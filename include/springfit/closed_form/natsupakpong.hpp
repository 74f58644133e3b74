// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/closed_form/detail/element_stiffness.hpp>
#include <springfit/closed_form/detail/simplex_edges.hpp>
#include <springfit/core/maximum.hpp>
#include <springfit/solve/bounded_least_squares.hpp>

namespace springfit {

/// Springs between all corners of a cell whose stiffness matrix is nearest to that of the finite element, after
/// Natsupakpong and Cavusoglu [Natsupakpong2010]: per cell
///
///     minimise | K - sum_e k_e b_e b_e' |_F   over k_e >= 0 ,
///
/// K the stiffness of the linear element at rest, b_e = n at one end of the spring and -n at the other; a spring sums
/// its cells. Any linear cell of any shape and any nu; quadrilaterals and hexahedra need all their diagonals. The
/// method is theirs, the solution by an active set ours. Squares at nu = 1/3 get 17/56 E h along the edges and
/// 23/56 E h along the diagonals, regular tetrahedra at nu = 1/4 the value of `lloyd`.
///
/// The caveat tells how much of the worst cell's K is missed. `n_clamped` counts springs that every cell holds at 0.
/// The springs join the nodes of `corner_mesh(mesh)`. Throws InvalidArgument for a material out of range, an inverted
/// cell, two corners of a cell without a spring. O(cells corners^6): small, but the dearest of the closed forms.
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] ClosedForm<Scalar> natsupakpong(const Mesh<Dim, Scalar, Cell>& mesh, const NodePairs& springs,
                                              const IsotropicSolid& solid) {
    constexpr int n_edges = static_cast<int>(Cell::edges.size());
    constexpr int n_pairs = n_edges + static_cast<int>(Cell::diagonals.size());
    const auto pair_of = [](int p) {
        return p < n_edges ? Cell::edges[std::size_t(p)] : Cell::diagonals[std::size_t(p - n_edges)];
    };
    const auto constants = detail::constants<Dim, Cell, Scalar>(solid);
    const auto corners = corner_mesh(mesh);
    const SpringLookup lookup(springs);
    Values<Scalar> stiffness = Values<Scalar>::Zero(springs.cols());
    std::vector<bool> touched(static_cast<std::size_t>(springs.cols()), false);
    double most_missed = 0;
    BoundedLeastSquares least_squares;
    const Values<double> lower = Values<double>::Zero(n_pairs);
    const Values<double> upper = Values<double>::Constant(n_pairs, std::numeric_limits<double>::infinity());
    for (Index c = 0; c < corners.n_cells(); ++c) {
        // Sizes at run time, so that all cells share one instantiation of products and solver.
        const DenseMatrix<double> element = detail::element_stiffness(corners, c, constants);
        const auto x = corners.cell_nodes(c).template cast<double>().eval();
        DenseMatrix<double> b = DenseMatrix<double>::Zero(Dim * Cell::n_corners, n_pairs);
        for (int p = 0; p < n_pairs; ++p) {
            const auto [i, j] = pair_of(p);
            const Vector<Dim, double> n = (x.col(j) - x.col(i)).normalized();
            b.col(p).template segment<Dim>(Dim * i) = -n;
            b.col(p).template segment<Dim>(Dim * j) = n;
        }
        // The square of the distance is k'Hk - 2 g'k + |K|^2.
        const DenseMatrix<double> products = b.transpose() * b;
        const DenseMatrix<double> hessian = products.cwiseAbs2();
        const DenseMatrix<double> images = element * b;
        const Values<double> linear = b.cwiseProduct(images).colwise().sum().transpose();
        const double scale = linear.maxCoeff(); // the solver's tolerance is relative to it
        Values<double> k = lower;
        (void)least_squares.solve(hessian, Values<double>(linear / scale), lower, upper, k);
        k *= scale;
        const double missed2 = element.squaredNorm() + k.dot(hessian * k) - 2 * k.dot(linear);
        most_missed = maximum(most_missed, std::sqrt(std::max(missed2, 0.) / element.squaredNorm()));
        for (int p = 0; p < n_pairs; ++p) {
            const auto [i, j] = pair_of(p);
            const int spring = detail::spring_on_edge(lookup, corners.cells(i, c), corners.cells(j, c));
            stiffness(spring) += static_cast<Scalar>(k(p));
            touched[static_cast<std::size_t>(spring)] = true;
        }
    }
    auto result = detail::close(std::move(stiffness), touched, most_missed < detail::exactness,
                                text("nearest in the Frobenius norm; misses up to ",
                                     std::ceil(100 * most_missed - 1e-6), " % of a cell's finite element stiffness"));
    for (Index e = 0; e < springs.cols(); ++e) {
        result.n_clamped += touched[static_cast<std::size_t>(e)] && !(result.stiffness(e) > 0) ? 1 : 0;
    }
    return result;
}

} // namespace springfit
