// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include "shapes.hpp"

#include <springfit/cgal/detail/clean_solid.hpp>
#include <springfit/cgal/detail/sharp_edges.hpp>
#include <springfit/cgal/tetrahedralize.hpp>

using namespace springfit;
using test::relative;

namespace {

template <class Scalar>
Scalar volume(const Mesh<3, Scalar, Tet4>& mesh) {
    Scalar sum = 0;
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const auto x = mesh.cell_nodes(c);
        const Scalar cell = (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).dot(x.col(3) - x.col(0)) / 6;
        CHECK(cell > 0);
        sum += cell;
    }
    return sum;
}

double mean_edge(const Mesh<3, double, Tet4>& mesh) {
    const NodePairs pairs = edges(mesh);
    double sum = 0;
    for (Index e = 0; e < pairs.cols(); ++e) {
        sum += (mesh.nodes.col(pairs(0, e)) - mesh.nodes.col(pairs(1, e))).norm();
    }
    return sum / static_cast<double>(pairs.cols());
}

/// Smallest angle between two faces of a cell, degrees.
double smallest_dihedral(const Mesh<3, double, Tet4>& mesh) {
    double largest_cosine = -1;
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const auto x = mesh.cell_nodes(c);
        std::array<Vector<3, double>, 4> normals;
        for (std::size_t f = 0; f < 4; ++f) {
            const auto& corners = Tet4::facets[f];
            normals[f] =
                (x.col(corners[1]) - x.col(corners[0])).cross(x.col(corners[2]) - x.col(corners[0])).normalized();
        }
        for (std::size_t f = 0; f < 4; ++f) {
            for (std::size_t g = 0; g < f; ++g) {
                largest_cosine = std::max(largest_cosine, -normals[f].dot(normals[g]));
            }
        }
    }
    return std::acos(largest_cosine) * 180 / 3.14159265358979;
}

} // namespace

TEST_CASE("a solid with sharp edges is filled exactly, a round one nearly, by well-shaped cells") {
    const auto l = cgal::tetrahedralize<double>(test::l_shape(), {.cell_size = 0.35});
    CHECK_NOTHROW(validate(l));
    CHECK(relative(volume(l), 3., 3.) < 1e-12);
    CHECK(smallest_dihedral(l) > 5);
    CHECK(relative(mean_edge(l), 0.35, 0.35) < 0.2);
    for (const auto& corner : {Vector<3, double>{1, 1, 0}, Vector<3, double>{2, 1, 1}, Vector<3, double>{0, 0, 0}}) {
        CHECK((l.nodes.colwise() - corner).colwise().norm().minCoeff() < 1e-12);
    }
    Index on_inner_edge = 0;
    for (Index i = 0; i < l.n_nodes(); ++i) {
        on_inner_edge += (l.nodes.col(i).head<2>() - Vector<2, double>{1, 1}).norm() < 1e-12 ? 1 : 0;
    }
    CHECK(on_inner_edge >= 3);

    const auto ball = cgal::tetrahedralize<double>(test::sphere(4), {.cell_size = 0.3});
    CHECK(relative(volume(ball), 4.18879, 4.18879) < 0.05);
    CHECK(smallest_dihedral(ball) > 5);
    for (int node : boundary_nodes(ball)) {
        CHECK(ball.nodes.col(node).norm() > 0.99);
    }
}

TEST_CASE("a wanted number of nodes is met within ten per cent, from a file as from arrays") {
    const test::TemporaryFolder folder;
    const auto path = folder.file("ball.off", test::off(test::sphere(3)));
    const auto mesh = cgal::tetrahedralize<double>(path, {.n_nodes = 400});
    CHECK(relative(static_cast<double>(mesh.n_nodes()), 400., 400.) < 0.1);
    const auto box = cgal::tetrahedralize<float>(test::box(4, 1, 1), {.n_nodes = 200});
    CHECK(relative(static_cast<double>(box.n_nodes()), 200., 200.) < 0.1);
    CHECK(relative(volume(box), 4.f, 4.f) < 1e-5f);
}

TEST_CASE("the same input gives the same mesh") {
    const auto surface = test::sphere(3);
    const auto first = cgal::tetrahedralize<double>(surface, {.cell_size = 0.4});
    (void)cgal::tetrahedralize<double>(test::l_shape(), {.cell_size = 0.6});
    const auto again = cgal::tetrahedralize<double>(surface, {.cell_size = 0.4});
    CHECK(first.nodes == again.nodes);
    CHECK(first.cells == again.cells);
    const auto other = cgal::tetrahedralize<double>(surface, {.cell_size = 0.4, .seed = 5});
    CHECK(relative(volume(other), volume(first), volume(first)) < 0.02);
}

TEST_CASE("sharp edges are kept by their angle, short ones dropped as noise") {
    const auto edges_above = [](double angle) {
        return cgal::detail::SharpEdges(cgal::detail::solid_surface(test::l_shape(), {}, angle, "l"), angle);
    };
    auto edges = edges_above(60);
    CHECK(edges.lines().size() == 18);
    CHECK(edges_above(100).lines().empty());
    edges.drop_short(0.5, 21.9); // the outline is 8 long, twice, and 6 edges stand upright: 22 in all
    CHECK(edges.lines().size() == 18);
    edges.drop_short(0.5, 22.1);
    CHECK(edges.lines().empty());
}

TEST_CASE("flakes on the surface and crumbs beside the body are taken off") {
    Mesh<3, double, Tet4> mesh; // a tetrahedron, a flat one on its face (0, 1, 2), a small one at its edge (0, 3)
    mesh.nodes.resize(3, 8);
    mesh.nodes.transpose() << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0.4, 0.4, -0.001, -0.1, 0, 0, 0, -0.1, 0, 9, 9, 9;
    mesh.cells.resize(4, 3);
    mesh.cells << 0, 0, 0, 1, 2, 5, 2, 1, 6, 3, 4, 3;
    CHECK(cgal::detail::n_pieces(mesh) == 2);
    const auto body = cgal::detail::without_flakes(mesh, 2);
    CHECK(body.n_cells() == 2);
    CHECK(body.n_nodes() == 6);
    CHECK(cgal::detail::without_flakes(mesh, 0.01).n_cells() == 3);
    CHECK(cgal::detail::without_crumbs(body, 0.005).n_cells() == 2);
    const auto whole = cgal::detail::without_crumbs(body, 0.02);
    CHECK(whole.n_cells() == 1);
    CHECK(whole.nodes == Points<3, double>(mesh.nodes.leftCols(4)));
    CHECK(relative(volume(whole), 1. / 6, 1. / 6) < 1e-15);
}

TEST_CASE("what cannot be meshed is refused with what is wrong") {
    const auto surface = test::box(1, 1, 1);
    using Options = cgal::TetrahedralizeOptions;
    CHECK_THROWS_WITH_AS((void)cgal::tetrahedralize<double>(surface, {}),
                         "cell_size, n_nodes: expected one of the two, found neither", InvalidArgument);
    CHECK_THROWS_WITH_AS((void)cgal::tetrahedralize<double>(surface, {.cell_size = 1, .n_nodes = 9}),
                         "cell_size, n_nodes: expected one of the two, found both", InvalidArgument);
    CHECK_THROWS_AS((void)cgal::tetrahedralize<double>(surface, {.cell_size = -1}), InvalidArgument);
    CHECK_THROWS_AS((void)cgal::tetrahedralize<double>(surface, {.cell_size = std::nan("")}), InvalidArgument);
    CHECK_THROWS_AS((void)cgal::tetrahedralize<double>(surface, {.n_nodes = 3}), InvalidArgument);
    CHECK_THROWS_AS((void)cgal::tetrahedralize<double>(surface, Options{.cell_size = 1, .sharp_edge_angle = 0}),
                    InvalidArgument);
    CHECK_THROWS_AS((void)cgal::tetrahedralize<double>(surface, Options{.cell_size = 1, .surface_distance = -1}),
                    InvalidArgument);
    CHECK_THROWS_AS((void)cgal::tetrahedralize<double>(surface, Options{.cell_size = 1, .sliver_angle = 50}),
                    InvalidArgument);
    CHECK_THROWS_WITH_AS((void)cgal::tetrahedralize<double>(surface, {.n_nodes = 2147483647}),
                         "n_nodes: expected at most 20000000, found 2147483647", InvalidArgument);
    CHECK_THROWS_WITH_AS((void)cgal::tetrahedralize<double>(surface, {.cell_size = 1e-9}),
                         "cell_size: expected a length at which the body has at most 20000000 nodes, found 1e-09, at "
                         "which it has some 1.4e+27",
                         InvalidArgument);
    auto open = surface;
    open.cells = open.cells.rightCols(11).eval();
    CHECK_THROWS_WITH_AS((void)cgal::tetrahedralize<double>(open, {.cell_size = 1}),
                         "surface: expected a closed surface, found an open one: 3 boundary edges around 1 hole, "
                         "1.41421 across (the surface is 1.73205); close it first, or fill its holes (--fill-holes)",
                         InvalidArgument);
    CHECK(relative(volume(cgal::tetrahedralize<double>(open, {.cell_size = 1, .repair = {.max_hole_edges = 3}})), 1.,
                   1.) < 1e-12);
    CHECK_THROWS_AS((void)cgal::tetrahedralize<double>("/no/such/surface.off", {.cell_size = 1}), FileError);
}

TEST_CASE("a thin plate takes more nodes than were wanted rather than fall apart") {
    const auto mesh = cgal::tetrahedralize<double>(test::box(1, 0.06, 1), {.n_nodes = 300});
    CHECK(cgal::detail::n_pieces(mesh) == 1);
    CHECK(relative(volume(mesh), 0.06, 0.06) < 0.05);
    CHECK(mesh.n_nodes() < 4 * 330);
}

TEST_CASE("a surface of two bodies gives a mesh of two pieces; a hollow is none") {
    const auto box = test::box(1, 1, 1);
    const auto apart = test::both(box, box, {3, 0, 0});
    CHECK(cgal::detail::n_bodies(apart) == 2);
    const auto mesh = cgal::tetrahedralize<double>(apart, {.cell_size = 0.5});
    CHECK(relative(volume(mesh), 2., 2.) < 1e-12);
    CHECK(cgal::detail::n_pieces(mesh) == 2);
    auto hollow = test::both(test::box(3, 3, 3), box, {1, 1, 1});
    hollow.cells.rightCols(box.n_cells()).row(0).swap(hollow.cells.rightCols(box.n_cells()).row(1));
    CHECK(cgal::detail::n_bodies(hollow) == 1);
}

TEST_CASE("a thin ring without sharp edges is meshed, though no line through its middle meets it") {
    const auto ring = test::torus(0.5, 0.06, 60, 14);
    const auto mesh = cgal::tetrahedralize<double>(ring, {.n_nodes = 2000});
    CHECK(cgal::detail::n_pieces(mesh) == 1);
    const double exact = 2 * std::numbers::pi * std::numbers::pi * 0.5 * 0.06 * 0.06;
    CHECK(relative(volume(mesh), exact, exact) < 0.1);
}

TEST_CASE("the caller may stop the search and gets the best mesh so far") {
    int calls = 0;
    std::string stage;
    double last = 0;
    const auto mesh =
        cgal::tetrahedralize<double>(test::sphere(2), {.n_nodes = 300, .progress = [&](const Progress& p) {
                                                           CHECK(p.fraction >= last);
                                                           CHECK(p.fraction <= 1);
                                                           last = p.fraction;
                                                           stage = p.stage;
                                                           return ++calls < 1;
                                                       }});
    CHECK(mesh.n_cells() > 0);
    CHECK(calls >= 1);
    CHECK(stage == "mesh");
}

TEST_CASE("meshing ends where a face is a needle") {
    auto needle = test::box(1, 1, 1); // the face in y = 0 has a corner on its diagonal, a little off it
    needle.nodes.conservativeResize(3, 9);
    needle.nodes.col(8) << 0.5, -1e-4, 0.5;
    const auto cells = needle.cells;
    needle.cells.resize(3, 14);
    needle.cells << cells, Eigen::Vector3i(0, 1, 8), Eigen::Vector3i(1, 5, 8);
    needle.cells.col(4) << 5, 0, 8; // was 0 1 5
    const auto mesh = cgal::tetrahedralize<double>(needle, {.n_nodes = 60});
    CHECK(relative(volume(mesh), 1., 1.) < 0.2);
}
