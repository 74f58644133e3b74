// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/mesh/structured.hpp>
#include <springfit/motion/surface.hpp>

using namespace springfit;
using test::rounding;

namespace {

template <int Dim, class Scalar>
auto box() {
    if constexpr (Dim == 2) {
        return triangle_grid<Scalar>({4, 3}, {Scalar(2), Scalar(1)});
    } else {
        return tetrahedron_grid<Scalar>({3, 2, 2}, {Scalar(2), Scalar(1), Scalar(1)});
    }
}

/// A network of the one simplex with the origin and the ends of the axes as corners, and the barycentric coordinates of
/// points in it, which need not lie inside.
template <int Dim, class Scalar>
struct OneCell {
    Points<Dim, Scalar> nodes = Points<Dim, Scalar>::Zero(Dim, Dim + 1);

    OneCell() { nodes.rightCols(Dim).setIdentity(); }

    [[nodiscard]] Interpolation<Scalar> at(const Points<Dim, Scalar>& points) const {
        DenseMatrix<Scalar> weights(Dim + 1, points.cols());
        weights << 1 - points.colwise().sum().array(), points;
        return {weights.sparseView()};
    }
};

/// Length of a closed outline's normal, or area of a closed surface's: sum of the cells' normals, and of their sizes.
template <int Dim, class Scalar>
std::pair<Vector<Dim, Scalar>, Scalar> normals(const EmbeddedSurface<Dim, Scalar>& surface) {
    Vector<Dim, Scalar> sum = Vector<Dim, Scalar>::Zero();
    Scalar size = 0;
    Scalar outwards = 0;
    const Vector<Dim, Scalar> centre = surface.rest_positions.rowwise().mean();
    for (Index c = 0; c < surface.n_cells(); ++c) {
        const auto x = [&](int a) -> Vector<Dim, Scalar> { return surface.rest_positions.col(surface.cells(a, c)); };
        Vector<Dim, Scalar> normal;
        if constexpr (Dim == 2) {
            const Vector<2, Scalar> along = x(1) - x(0);
            normal << along(1), -along(0);
        } else {
            normal = (x(1) - x(0)).cross(x(2) - x(0)) / 2;
        }
        sum += normal;
        size += normal.norm();
        outwards += normal.dot(x(0) - centre);
        CHECK(normal.dot(x(0) - centre) > 0); // a box is convex
    }
    CHECK(test::relative(outwards / Dim, Scalar(2), Scalar(2)) < 1e-5); // the volume of the box, by Gauss
    return {sum, size};
}

} // namespace

TEST_CASE_TEMPLATE("a carried surface follows translations, rotations and affine motions", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const OneCell<dim, Scalar> network;
    const auto mesh = box<dim, Scalar>();
    const auto surface = boundary_surface(mesh, network.at(mesh.nodes));
    CHECK_NOTHROW(validate(surface, dim + 1));
    CHECK(deform(surface, network.nodes, network.nodes) == surface.rest_positions);

    const Eigen::Matrix<Scalar, dim, dim> gradient = Eigen::Matrix<Scalar, dim, dim>::Random();
    const Vector<dim, Scalar> shift = Vector<dim, Scalar>::Random();
    Motion<dim, Scalar> motion;
    motion.rest_positions = network.nodes;
    motion.positions = {network.nodes, (gradient * network.nodes).colwise() + shift};
    const auto frames = deform(surface, motion);
    REQUIRE(frames.size() == 2);
    CHECK(frames[0] == surface.rest_positions);
    const Points<dim, Scalar> expected = (gradient * surface.rest_positions).colwise() + shift;
    CHECK(test::relative_difference(frames[1], expected) < rounding<Scalar>());
}

TEST_CASE_TEMPLATE("a point outside the network rests where it belongs and moves with the nearest of it", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const OneCell<dim, Scalar> network;
    EmbeddedSurface<dim, Scalar> surface;
    surface.rest_positions = Points<dim, Scalar>::Constant(dim, 1, Scalar(-0.25));
    surface.from_nodes.weights.resize(dim + 1, 1);
    surface.from_nodes.weights.insert(0, 0) = 1; // the origin is nearest
    CHECK(deform(surface, network.nodes, network.nodes) == surface.rest_positions);
    Points<dim, Scalar> moved = network.nodes;
    moved.colwise() += Vector<dim, Scalar>::Constant(Scalar(0.5));
    CHECK(deform(surface, network.nodes, moved) == Points<dim, Scalar>::Constant(dim, 1, Scalar(0.25)));
}

TEST_CASE_TEMPLATE("the boundary is closed, faces outwards and has the mesh's own nodes", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const OneCell<dim, Scalar> network;
    const auto check = [&](const auto& mesh) {
        const auto weights = network.at(mesh.nodes);
        const auto surface = boundary_surface(mesh, weights);
        const auto nodes = boundary_nodes(mesh);
        CHECK(surface.rest_positions == mesh.nodes(Eigen::all, nodes));
        for (std::size_t p = 0; p < nodes.size(); ++p) {
            CHECK((surface.from_nodes.weights.col(static_cast<Index>(p)) - weights.weights.col(nodes[p])).norm() == 0);
        }
        const auto [sum, size] = normals(surface);
        CHECK(sum.norm() < rounding<Scalar>());
        CHECK(test::relative(size, Scalar(dim == 2 ? 6 : 10), Scalar(10)) < rounding<Scalar>());
    };
    check(box<dim, Scalar>());
    if constexpr (dim == 2) {
        check(quad_grid<Scalar>({4, 3}, {Scalar(2), Scalar(1)}));
    } else {
        check(hex_grid<Scalar>({3, 2, 2}, {Scalar(2), Scalar(1), Scalar(1)}));
    }
}

TEST_CASE("a surface that does not fit its network is refused by name") {
    const OneCell<3, double> network;
    const auto mesh = box<3, double>();
    const auto surface = boundary_surface(mesh, network.at(mesh.nodes));
    CHECK_THROWS_WITH_AS(
        validate(surface, 7),
        text("surface: expected weights [7 x ", surface.n_points(), "], found [4 x ", surface.n_points(), "]").c_str(),
        InvalidArgument);
    auto broken = surface;
    broken.cells(0, 0) = static_cast<int>(surface.n_points());
    CHECK_THROWS_AS(validate(broken, 4), InvalidArgument);
    broken = surface;
    broken.from_nodes.weights.coeffRef(0, 0) += 1;
    CHECK_THROWS_AS(validate(broken, 4), InvalidArgument);
    broken = surface;
    broken.rest_positions(0, 0) = std::nan("");
    CHECK_THROWS_AS(validate(broken, 4), InvalidArgument);
    CHECK_THROWS_AS((void)boundary_surface(mesh, surface.from_nodes), InvalidArgument);
    const Points<3, double> five = Points<3, double>::Zero(3, 5);
    CHECK_THROWS_AS((void)deform(surface, network.nodes, five), InvalidArgument);
    CHECK_THROWS_AS((void)deform(surface, five, five), InvalidArgument);
    CHECK_THROWS_AS((void)deform<3>(surface.from_nodes, five, network.nodes, network.nodes), InvalidArgument);
}
