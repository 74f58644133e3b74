// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "random_meshes.hpp"
#include "tolerance.hpp"

#include <springfit/cgal/location.hpp>

namespace springfit::test {

/// Points inside are found, in the cell that holds them, with weights that give the point back.
template <int Dim, class Scalar, class Cell>
void check_inside(Mesh<Dim, Scalar, Cell> mesh) {
    const cgal::Locator locator(mesh);
    const auto points = random_points<Dim, Scalar>(200, Scalar(0.001), Scalar(0.999));
    for (Index p = 0; p < points.cols(); ++p) {
        const auto place = locator.cell_at(points.col(p));
        REQUIRE(place.has_value());
        CHECK(relative(place->weights.sum(), Scalar(1), Scalar(1)) < rounding<Scalar>());
        if (Cell::n_nodes == Cell::n_corners) {
            CHECK(place->weights.minCoeff() > -rounding<Scalar>(2000));
        }
        const Vector<Dim, Scalar> back = mesh.cell_nodes(place->cell) * place->weights;
        CHECK((back - points.col(p)).norm() < rounding<Scalar>());
    }
    for (Index i = 0; i < mesh.n_nodes(); i += 7) { // nodes themselves: all weight on the node
        const auto place = locator.cell_at(mesh.nodes.col(i));
        REQUIRE(place.has_value());
        for (int a = 0; a < Cell::n_nodes; ++a) {
            const Scalar expected = mesh.cells(a, place->cell) == i ? 1 : 0;
            CHECK(std::abs(place->weights(a) - expected) < rounding<Scalar>(1000));
        }
    }
    CHECK_FALSE(locator.cell_at(Vector<Dim, Scalar>::Constant(Scalar(1.01))).has_value());
    CHECK_FALSE(locator.cell_at(Vector<Dim, Scalar>::Constant(Scalar(-7))).has_value());
    CHECK_FALSE(locator.cell_at(Vector<Dim, Scalar>::Constant(std::numeric_limits<Scalar>::quiet_NaN())).has_value());
}

/// Nearest points on the unit square or cube.
template <int Dim, class Scalar, class Cell>
void check_nearest(const Mesh<Dim, Scalar, Cell>& mesh) {
    const cgal::Locator locator(mesh);
    const auto points = random_points<Dim, Scalar>(200, Scalar(-1), Scalar(2));
    for (Index p = 0; p < points.cols(); ++p) {
        const Vector<Dim, Scalar> point = points.col(p);
        Vector<Dim, Scalar> expected = point.cwiseMax(Scalar(0)).cwiseMin(Scalar(1));
        Scalar depth = 0; // inside: the nearest side
        if (expected == point) {
            int axis = 0;
            depth = std::min(point.minCoeff(), 1 - point.maxCoeff());
            while (std::min(point(axis), 1 - point(axis)) != depth) {
                ++axis;
            }
            expected(axis) = point(axis) < Scalar(0.5) ? 0 : 1;
        }
        const auto place = locator.nearest(point);
        CHECK((place.point - expected).norm() < rounding<Scalar>());
        CHECK(relative(place.distance, (expected - point).norm(), Scalar(1)) < rounding<Scalar>());
        CHECK(place.weights.minCoeff() >= 0);
        Vector<Dim, Scalar> back = Vector<Dim, Scalar>::Zero();
        for (Index a = 0; a < place.nodes.size(); ++a) {
            back += place.weights(a) * mesh.nodes.col(place.nodes(a));
            CHECK((mesh.cells.col(place.cell).array() == place.nodes(a)).any());
        }
        CHECK((back - expected).norm() < rounding<Scalar>());
        CHECK(place.facet >= 0);
    }
    CHECK_THROWS_AS((void)locator.nearest(Vector<Dim, Scalar>::Constant(std::numeric_limits<Scalar>::quiet_NaN())),
                    InvalidArgument);
}

} // namespace springfit::test
