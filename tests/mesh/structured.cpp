// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/mesh/structured.hpp>

using namespace springfit;
using springfit::test::relative;
using springfit::test::rounding;

namespace {

template <class Scalar>
Scalar signed_volume(const Mesh<3, Scalar, Tet4>& mesh) {
    Scalar volume = 0;
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const auto x = mesh.cell_nodes(c);
        const Scalar cell = (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).dot(x.col(3) - x.col(0)) / 6;
        CHECK(cell > 0);
        volume += cell;
    }
    return volume;
}

template <class Scalar>
Scalar signed_area(const Mesh<2, Scalar, Tri3>& mesh) {
    Scalar area = 0;
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const auto x = mesh.cell_nodes(c);
        const Vector<2, Scalar> a = x.col(1) - x.col(0);
        const Vector<2, Scalar> b = x.col(2) - x.col(0);
        const Scalar cell = (a(0) * b(1) - a(1) * b(0)) / 2;
        CHECK(cell > 0);
        area += cell;
    }
    return area;
}

} // namespace

TEST_CASE_TEMPLATE("grids fill their box with cells of positive volume", Scalar, float, double) {
    const auto triangles = triangle_grid<Scalar>({5, 3}, {Scalar(2), Scalar(1)});
    CHECK(triangles.n_cells() == 30);
    CHECK(relative(signed_area(triangles), Scalar(2), Scalar(2)) < rounding<Scalar>());

    const auto equilateral = equilateral_triangles<Scalar>(4, 3, Scalar(0.5));
    const Scalar one = std::sqrt(Scalar(3)) / 4 * Scalar(0.25);
    CHECK(relative(signed_area(equilateral), 24 * one, 24 * one) < rounding<Scalar>());
    const NodePairs sides = edges(equilateral);
    for (Index e = 0; e < sides.cols(); ++e) {
        const Scalar length = (equilateral.nodes.col(sides(0, e)) - equilateral.nodes.col(sides(1, e))).norm();
        CHECK(relative(length, Scalar(0.5), Scalar(0.5)) < rounding<Scalar>());
    }

    auto tets = tetrahedron_grid<Scalar>({3, 2, 4}, {Scalar(1), Scalar(2), Scalar(0.5)});
    CHECK(tets.n_cells() == 6 * 24);
    CHECK(relative(signed_volume(tets), Scalar(1), Scalar(1)) < rounding<Scalar>());
    jitter(tets, Scalar(0.2), 7);
    CHECK(relative(signed_volume(tets), Scalar(1), Scalar(1)) < rounding<Scalar>(1000));

    CHECK(quad_grid<Scalar>({5, 3}, {Scalar(2), Scalar(1)}).n_cells() == 15);
    CHECK(hex_grid<Scalar>({2, 3, 4}, {Scalar(2), Scalar(1), Scalar(1)}).n_nodes() == 60);
}

TEST_CASE("jitter moves interior nodes only and is fixed by its seed") {
    const auto grid = triangle_grid<double>({6, 6}, {1., 1.});
    auto a = grid;
    auto b = grid;
    auto c = grid;
    jitter(a, 0.3, 1);
    jitter(b, 0.3, 1);
    jitter(c, 0.3, 2);
    CHECK(a.nodes == b.nodes);
    CHECK(a.nodes != c.nodes);
    for (int node : boundary_nodes(grid)) {
        CHECK(a.nodes.col(node) == grid.nodes.col(node));
    }
}

TEST_CASE("quadratic cells have their extra nodes in the middle of their edges") {
    const auto check = [](const auto& linear) {
        using Cell = std::remove_cvref_t<decltype(quadratic(linear))>;
        const Cell mesh = quadratic(linear);
        CHECK(mesh.n_nodes() == linear.n_nodes() + edges(linear).cols());
        CHECK_NOTHROW(validate(mesh));
        CHECK(edges(mesh) == edges(linear));
        const auto x = mesh.cell_nodes(0);
        CHECK((x.col(linear.cells.rows()) - (x.col(0) + x.col(1)) / 2).norm() < 1e-15);
    };
    check(triangle_grid<double>({2, 2}, {1., 1.}));
    check(tetrahedron_grid<double>({2, 2, 1}, {1., 1., 1.}));
}

TEST_CASE("bad sizes and broken meshes are refused by name") {
    CHECK_THROWS_WITH_AS((void)quad_grid<double>({0, 3}, {1., 1.}),
                         "cells: expected at least one cell along each axis, found 0", InvalidArgument);
    CHECK_THROWS_AS((void)hex_grid<double>({1, 1, 1}, {1., -1., 1.}), InvalidArgument);
    auto mesh = triangle_grid<double>({2, 2}, {1., 1.});
    mesh.nodes(1, 4) = std::nan("");
    CHECK_THROWS_AS(validate(mesh), InvalidArgument);
    mesh = triangle_grid<double>({2, 2}, {1., 1.});
    mesh.cells(0, 3) = 9;
    CHECK_THROWS_WITH_AS(validate(mesh), "mesh: expected node numbers in [0, 9), found node 9 in cell 3",
                         InvalidArgument);
    mesh = triangle_grid<double>({2, 2}, {1., 1.});
    mesh.cells.conservativeResize(3, 0);
    CHECK_THROWS_WITH_AS(validate(mesh), "mesh: expected at least one cell, found none", InvalidArgument);
}
