// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>

#include <springfit/fem/model.hpp>
#include <springfit/mesh/structured.hpp>

namespace springfit::test {

/// A kind of body for typed tests: a small box of one kind of cell.
template <int D, class S, class C>
struct Body {
    static constexpr int dimension = D;
    using Scalar = S;
    using Cell = C;
};

/// Size of the box below along each axis, m.
inline constexpr double box_size[3] = {1.2, 0.8, 1.};

/// A box of `n` grid cells along each axis, its inner nodes moved; a membrane lies in the plane z = 0.
template <int Dim, class Scalar, class Cell>
[[nodiscard]] Mesh<Dim, Scalar, Cell> box(int n, Scalar moved = Scalar(0.15)) {
    if constexpr (is_membrane<Dim, Scalar, Cell>) {
        return membrane(box<2, Scalar, Cell>(n, moved));
    } else {
        Vector<Dim, Scalar> size;
        GridSize<Dim> cells;
        for (int d = 0; d < Dim; ++d) {
            size(d) = static_cast<Scalar>(box_size[d]);
            cells[std::size_t(d)] = n;
        }
        const auto moved_grid = [&](auto mesh) {
            jitter(mesh, moved, 4);
            return mesh;
        };
        if constexpr (std::same_as<Cell, Tri3>) {
            return moved_grid(triangle_grid<Scalar>(cells, size));
        } else if constexpr (std::same_as<Cell, Tri6>) {
            return quadratic(moved_grid(triangle_grid<Scalar>(cells, size)));
        } else if constexpr (std::same_as<Cell, Quad4>) {
            return moved_grid(quad_grid<Scalar>(cells, size));
        } else if constexpr (std::same_as<Cell, Tet4>) {
            return moved_grid(tetrahedron_grid<Scalar>(cells, size));
        } else if constexpr (std::same_as<Cell, Tet10>) {
            return quadratic(moved_grid(tetrahedron_grid<Scalar>(cells, size)));
        } else {
            return moved_grid(hex_grid<Scalar>(cells, size));
        }
    }
}

/// Area or volume of that box.
template <class Cell>
inline constexpr double box_volume = box_size[0] * box_size[1] * (Cell::dimension == 3 ? box_size[2] : 1.);

/// Nodes moved at random by up to `size` in each coordinate.
template <int Dim, class Scalar>
[[nodiscard]] Points<Dim, Scalar> shaken(Points<Dim, Scalar> x, double size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> entry(-size, size);
    for (Scalar& value : x.reshaped()) {
        value += static_cast<Scalar>(entry(random));
    }
    return x;
}

/// A rotation by 2.1 rad (in space about a skew axis).
template <int Dim, class Scalar>
[[nodiscard]] Eigen::Matrix<Scalar, Dim, Dim> turn() {
    if constexpr (Dim == 2) {
        return Eigen::Rotation2D<Scalar>(Scalar(2.1)).toRotationMatrix();
    } else {
        return Eigen::AngleAxis<Scalar>(Scalar(2.1), Vector<3, Scalar>(1, -2, Scalar(0.5)).normalized())
            .toRotationMatrix();
    }
}

/// The dilatations and planes that a body can have.
template <class B>
[[nodiscard]] std::vector<fem::ModelOptions<typename B::Scalar>> settings() {
    using fem::Dilatation;
    using fem::Plane;
    if constexpr (B::dimension == 2) {
        return {{.thickness = 2},
                {.thickness = 2, .plane = Plane::strain},
                {.thickness = 2, .plane = Plane::strain, .dilatation = Dilatation::mean}};
    } else if constexpr (B::Cell::dimension == 2) {
        return {{.thickness = 2}};
    } else {
        return {{}, {.dilatation = Dilatation::mean}};
    }
}

} // namespace springfit::test

/// Every kind of cell, and a membrane.
#define SPRINGFIT_TEST_BODIES(Scalar)                                                                                  \
    springfit::test::Body<2, Scalar, springfit::Tri3>, springfit::test::Body<2, Scalar, springfit::Tri6>,              \
        springfit::test::Body<2, Scalar, springfit::Quad4>, springfit::test::Body<3, Scalar, springfit::Tet4>,         \
        springfit::test::Body<3, Scalar, springfit::Tet10>, springfit::test::Body<3, Scalar, springfit::Hex8>,         \
        springfit::test::Body<3, Scalar, springfit::Tri3>
