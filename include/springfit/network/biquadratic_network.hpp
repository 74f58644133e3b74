// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/network/masses.hpp>

namespace springfit {

/// One value per corner of each triangle, or per edge, by the corner that faces it `[3 x n_triangles]`.
template <std::floating_point Scalar>
using TriangleValues = Eigen::Matrix<Scalar, 3, Eigen::Dynamic>;

/// Point masses joined by triangular biquadratic springs [Delingette2008]: tensile ones along the edges of triangles,
/// angular ones between the two edges at each corner. In the plane, or a membrane in space, which does not resist
/// bending.
///
/// With D_i = L_i^2 - l_i^2 for the edge that faces corner i, L its length and l its rest length, a triangle has
///
///     W = sum_i k_i/4 D_i^2 + sum_i c_i/2 D_j D_m ,   (j, m) the other two corners,
///
/// which forces along its edges can balance, as those of springs do. `damping` beta adds beta dD/dt to D in the forces:
/// damping in proportion to the stiffness. `delingette` gives the coefficients of a material.
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
struct BiquadraticNetwork {
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    Points<Dim, Scalar> rest_positions;              ///< [Dim x n_nodes], m
    Eigen::Matrix<int, 3, Eigen::Dynamic> triangles; ///< corners [3 x n_triangles]
    TriangleValues<Scalar> tensile;                  ///< k_i of the edge that faces corner i [3 x n_triangles], N/m^3
    TriangleValues<Scalar> angular;                  ///< c_i of corner i, of either sign [3 x n_triangles], N/m^3
    TriangleValues<Scalar> rest_length;              ///< l_i > 0 of the edge that faces corner i [3 x n_triangles], m
    Values<Scalar> mass;                             ///< m_i > 0 [n_nodes], kg
    Scalar damping = 0;                              ///< beta >= 0, s

    [[nodiscard]] Index n_nodes() const { return rest_positions.cols(); }
    [[nodiscard]] Index n_triangles() const { return triangles.cols(); }
};

/// Throws InvalidArgument unless all sizes agree, corners are three different nodes, and values are finite and in
/// range.
template <int Dim, std::floating_point Scalar>
void validate(const BiquadraticNetwork<Dim, Scalar>& network) {
    const Index nodes = network.n_nodes();
    const Index triangles = network.n_triangles();
    require(network.rest_positions.allFinite(), "rest_positions", "finite coordinates", "a value that is not finite");
    require(network.mass.size() == nodes, "mass", text(nodes, " values, one per node"), network.mass.size());
    require((network.mass.array() > 0).all() && network.mass.allFinite(), "mass", "positive values",
            network.mass.minCoeff());
    const auto check = [&](const TriangleValues<Scalar>& values, std::string_view name, Scalar least) {
        require(values.cols() == triangles, name, text(triangles, " columns, one per triangle"), values.cols());
        require(values.allFinite() && (values.array() >= least).all(), name,
                least > 0 ? "positive values" : "finite values", "another");
    };
    check(network.tensile, "tensile", std::numeric_limits<Scalar>::lowest());
    check(network.angular, "angular", std::numeric_limits<Scalar>::lowest());
    check(network.rest_length, "rest_length", std::numeric_limits<Scalar>::min());
    require(network.damping >= 0 && std::isfinite(network.damping), "damping", "a value not below 0", network.damping);
    for (Index t = 0; t < triangles; ++t) {
        const auto corners = network.triangles.col(t);
        require(corners.minCoeff() >= 0 && corners.maxCoeff() < nodes, "triangles",
                text("node numbers in [0, ", nodes, ")"), text(corners.transpose(), " in triangle ", t));
        require(corners(0) != corners(1) && corners(1) != corners(2) && corners(2) != corners(0), "triangles",
                "three different corners", text(corners.transpose(), " in triangle ", t));
    }
}

template <std::floating_point Scalar>
struct BiquadraticOptions {
    Scalar density = 1;   ///< rho > 0, kg/m^3
    Scalar thickness = 1; ///< h > 0, m
};

/// The biquadratic network of a triangle mesh, at rest; masses from the cells, coefficients 0 until `delingette` or the
/// user sets them.
///
///     auto cloth = biquadratic_network(mesh, {.density = 300., .thickness = 1e-3});
///     apply(delingette(mesh, {.young = 1e6, .poisson = 0.3, .thickness = 1e-3}), cloth);
///
/// The nodes are those of `corner_mesh(mesh)`. Throws InvalidArgument for a mesh or an option that cannot be used.
template <int Dim, std::floating_point Scalar, SimplexCell Cell>
    requires(Cell::dimension == 2)
[[nodiscard]] BiquadraticNetwork<Dim, Scalar> biquadratic_network(const Mesh<Dim, Scalar, Cell>& mesh,
                                                                  const BiquadraticOptions<Scalar>& options = {}) {
    validate(mesh);
    const auto corners = corner_mesh(mesh);
    BiquadraticNetwork<Dim, Scalar> network;
    network.rest_positions = corners.nodes;
    network.triangles = corners.cells;
    network.tensile = TriangleValues<Scalar>::Zero(3, corners.n_cells());
    network.angular = TriangleValues<Scalar>::Zero(3, corners.n_cells());
    network.rest_length.resize(3, corners.n_cells());
    for (Index t = 0; t < corners.n_cells(); ++t) {
        const auto x = corners.cell_nodes(t);
        for (int i = 0; i < 3; ++i) {
            network.rest_length(i, t) = (x.col((i + 2) % 3) - x.col((i + 1) % 3)).norm();
        }
    }
    network.mass = node_masses(corners, options.density, options.thickness);
    validate(network);
    return network;
}

} // namespace springfit
