// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include "shapes.hpp"

#include <springfit/cgal/triangulate.hpp>

using namespace springfit;
using test::relative;

namespace {

template <class Scalar>
Scalar area(const Mesh<2, Scalar, Tri3>& mesh) {
    Scalar sum = 0;
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const auto x = mesh.cell_nodes(c);
        const Vector<2, Scalar> a = x.col(1) - x.col(0);
        const Vector<2, Scalar> b = x.col(2) - x.col(0);
        const Scalar cell = (a(0) * b(1) - a(1) * b(0)) / 2;
        CHECK(cell > 0);
        sum += cell;
    }
    return sum;
}

double smallest_angle(const Mesh<2, double, Tri3>& mesh) {
    double largest_cosine = -1;
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const auto x = mesh.cell_nodes(c);
        for (int a = 0; a < 3; ++a) {
            const Vector<2, double> u = (x.col((a + 1) % 3) - x.col(a)).normalized();
            largest_cosine = std::max(largest_cosine, u.dot((x.col((a + 2) % 3) - x.col(a)).normalized()));
        }
    }
    return std::acos(largest_cosine) * 180 / 3.14159265358979;
}

double mean_edge(const Mesh<2, double, Tri3>& mesh) {
    const NodePairs pairs = edges(mesh);
    double sum = 0;
    for (Index e = 0; e < pairs.cols(); ++e) {
        sum += (mesh.nodes.col(pairs(0, e)) - mesh.nodes.col(pairs(1, e))).norm();
    }
    return sum / static_cast<double>(pairs.cols());
}

template <class Call>
std::string message(const Call& call) {
    try {
        call();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "";
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// A 4 x 3 plate with a 1 x 1 hole in it: area 11.
const std::string plate_poly =
    "# a plate\n8 2 0 1\n1 0 0 1\n2 4 0 1\n3 4 3 1 # a corner\n4 0 3 1\n5 1 1 2\n6 2 1 2\n7 2 2 2\n"
    "8 1 2 2\n\n8 1\n1 1 2 5\n2 2 3 5\n3 3 4 5\n4 4 1 5\n5 5 6 5\n6 6 7 5\n7 7 8 5\n8 8 5 5\n1\n"
    "1 1.5 1.5\n";
const std::string plate_wkt = "POLYGON ((0 0, 4 0,\n 4 3, 0 3, 0 0),\n (1 1, 1 2, 2 2, 2 1, 1 1))\n";

} // namespace

TEST_CASE("plates with holes are filled exactly, from either format") {
    const test::TemporaryFolder folder;
    std::string from_zero = plate_poly;
    for (const auto& path : {folder.file("plate.poly", plate_poly), folder.file("plate.wkt", plate_wkt)}) {
        CAPTURE(path.filename().string());
        const auto outline = cgal::read_outline(path);
        CHECK(outline.points.cols() == 8);
        CHECK(outline.segments.cols() == 8);
        CHECK(outline.holes.cols() == 1);
        const auto mesh = cgal::triangulate<double>(path, {.cell_size = 0.2});
        CHECK_NOTHROW(validate(mesh));
        CHECK(relative(area(mesh), 11., 11.) < 1e-12);
        CHECK(smallest_angle(mesh) > 20);
        CHECK(relative(mean_edge(mesh), 0.2, 0.2) < 0.15);
        CHECK(relative(area(cgal::triangulate<float>(path, {.cell_size = 0.3})), 11.f, 11.f) < 1e-5f);
        const auto counted = cgal::triangulate<double>(path, {.n_nodes = 500});
        CHECK(relative(static_cast<double>(counted.n_nodes()), 500., 500.) < 0.1);
        CHECK(cgal::triangulate<double>(path, {.n_nodes = 500}).nodes == counted.nodes);
    }
    const auto square =
        folder.file("zero.poly", "4 2 0 0\n0 0 0\n1 1 0\n2 1 1\n3 0 1\n4 0\n0 0 1\n1 1 2\n2 2 3\n3 3 0\n0\n");
    CHECK(relative(area(cgal::triangulate<double>(square, {.cell_size = 0.5})), 1., 1.) < 1e-14);
}

TEST_CASE("islands in holes, several areas and inner segments come out as drawn") {
    const test::TemporaryFolder folder;
    const auto island =
        folder.file("island.wkt", "multipolygon (((0 0, 9 0, 9 9, 0 9, 0 0), (1 1, 1 8, 8 8, 8 1, 1 1)),\n"
                                  "((3 3, 6 3, 6 6, 3 6, 3 3)))");
    CHECK(contains(message([&] { (void)cgal::triangulate<double>(island, {.cell_size = 1}); }),
                   "expected an outline of one piece (several_pieces accepts more), found 2 pieces"));
    CHECK(relative(area(cgal::triangulate<double>(island, {.cell_size = 1, .several_pieces = true})), 81. - 49 + 9,
                   41.) < 1e-11); // the mesher's coordinates are multiples of 2^-40 of the extent
    const auto neighbours =
        folder.file("two.wkt", "POLYGON ((0 0, 1 0, 1 1, 0 1, 0 0))\nPOLYGON ((1 0, 2 0, 2 1, 1 1, 1 0))\n");
    const auto mesh = cgal::triangulate<double>(neighbours, {.cell_size = 0.3});
    CHECK(relative(area(mesh), 2., 2.) < 1e-14);

    cgal::Outline wall; // a square with a segment across the middle: an edge of the mesh wherever it runs
    wall.points.resize(2, 6);
    wall.points << 0, 1, 1, 0, 0, 1, 0, 0, 1, 1, 0.5, 0.5;
    wall.segments.resize(2, 7);
    wall.segments << 0, 1, 5, 2, 3, 4, 4, 1, 5, 2, 3, 4, 0, 5;
    const auto halves = cgal::triangulate<double>(wall, {.cell_size = 0.2});
    for (Index c = 0; c < halves.n_cells(); ++c) {
        const auto y = halves.cell_nodes(c).row(1).eval();
        CHECK((y.maxCoeff() <= 0.5 || y.minCoeff() >= 0.5));
    }
    wall.holes.resize(2, 1);
    wall.holes << 0.5, 0.75;
    CHECK(relative(area(cgal::triangulate<double>(wall, {.cell_size = 0.2})), 0.5, 0.5) < 1e-14);
    wall.holes << 0.5, 1.75;
    CHECK(message([&] { (void)cgal::triangulate<double>(wall, {.cell_size = 0.2}); }) ==
          "outline: expected a hole's point inside the outline, found hole 0 at ( 0.5 1.75)");
    wall.holes.resize(2, 2);
    wall.holes << 0.5, 0.5, 0.75, 0.25;
    CHECK(contains(message([&] { (void)cgal::triangulate<double>(wall, {.cell_size = 0.2}); }), "around an area"));
}

TEST_CASE("outlines that bound nothing are refused with what is wrong and how many") {
    cgal::Outline square;
    square.points.resize(2, 4);
    square.points << 0, 1, 1, 0, 0, 0, 1, 1;
    square.segments.resize(2, 4);
    square.segments << 0, 1, 2, 3, 1, 2, 3, 0;
    CHECK_NOTHROW((void)cgal::checked(square));

    auto open = square;
    open.segments = square.segments.leftCols(3).eval();
    CHECK(message([&] { (void)cgal::checked(open); }) ==
          "outline: expected a closed outline, found an open one: 2 loose ends, the first at (0 0)");
    auto bow = square;
    bow.points.col(2).swap(bow.points.col(3));
    CHECK(message([&] { (void)cgal::checked(bow, "bow.poly"); }) ==
          "bow.poly: expected segments that meet at their ends only, found 1 pair that cross, touch or overlap");
    auto few = square;
    few.segments = square.segments.leftCols(2).eval();
    CHECK(contains(message([&] { (void)cgal::checked(few); }), "at least three segments, found 2"));
    CHECK(contains(message([&] { (void)cgal::checked({}); }), "at least three segments, found 0"));
    auto strange = square;
    strange.segments(0, 1) = 4;
    CHECK(contains(message([&] { (void)cgal::checked(strange); }), "point numbers in [0, 4), found 4 in segment 1"));
    strange = square;
    strange.points(1, 2) = std::nan("");
    CHECK(contains(message([&] { (void)cgal::checked(strange); }), "finite coordinates"));

    CHECK_THROWS_AS((void)cgal::triangulate<double>(square, {}), InvalidArgument);
    CHECK_THROWS_AS((void)cgal::triangulate<double>(square, {.cell_size = 1, .n_nodes = 10}), InvalidArgument);
    CHECK_THROWS_AS((void)cgal::triangulate<double>(square, {.cell_size = std::nan("")}), InvalidArgument);
    CHECK_THROWS_AS((void)cgal::triangulate<double>(square, {.n_nodes = 2}), InvalidArgument);
    CHECK_THROWS_AS((void)cgal::triangulate<double>(square, {.n_nodes = 20000001}), InvalidArgument);
    CHECK_THROWS_AS((void)cgal::triangulate<double>(square, {.cell_size = 1e-9}), InvalidArgument);
}

TEST_CASE("what is wrong with a file is said with its name and line") {
    const test::TemporaryFolder folder;
    const auto read = [&](const std::string& name, const std::string& content) {
        const auto path = folder.file(name, content);
        return message([&] { (void)cgal::read_outline(path); });
    };
    CHECK(contains(message([&] { (void)cgal::read_outline(folder / "none.poly"); }), "none.poly: no such file"));
    CHECK(contains(read("a.svg", "<svg/>"), "unknown kind of outline file '.svg'"));
    CHECK(contains(read("a.poly", ""), "is empty"));

    const auto replaced = [](std::string whole, const std::string& part, const std::string& by) {
        return whole.replace(whole.find(part), part.size(), by);
    };
    CHECK(contains(read("n.poly", replaced(plate_poly, "2 4 0 1", "2 4 nan 1")),
                   "n.poly:4: a coordinate is not finite: nan"));
    CHECK(contains(read("w.poly", replaced(plate_poly, "2 4 0 1", "2 4 four 1")),
                   "w.poly:4: expected a coordinate, found \"four\""));
    CHECK(contains(read("s.poly", replaced(plate_poly, "2 4 0 1", "2 4")),
                   "s.poly:4: expected two coordinates of a vertex, found the end of the line"));
    CHECK(contains(read("i.poly", replaced(plate_poly, "2 2 3 5", "2 2 9 5")),
                   "i.poly:14: expected a vertex' number in [1, 8], found 9"));
    CHECK(contains(read("c.poly", plate_poly.substr(0, 60)), "expected the vertex' number, found the end of the file"));
    CHECK(contains(read("d.poly", "8 3 0 0\n"), "d.poly:1: expected the dimension in [2, 2], found 3"));
    CHECK(contains(read("o.poly", replaced(plate_poly, "4 4 1 5", "4 4 3 5")), "o.poly: expected a closed outline"));

    CHECK(contains(read("n.wkt", replaced(plate_wkt, "4 3", "4 nan")), "n.wkt:2: a coordinate is not finite: nan"));
    CHECK(contains(read("o.wkt", "POLYGON ((0 0, 4 0, 4 3, 0 3))\n"),
                   "o.wkt:1: the outer ring is open: it starts at (0 0) and ends at (0 3)"));
    CHECK(contains(read("h.wkt", "\nPOLYGON ((0 0, 4 0, 4 3, 0 0), (1 1, 2 1, 2 2))\n"), "h.wkt:2: hole 1 is open"));
    CHECK(contains(read("l.wkt", "LINESTRING (0 0, 1 1)\n"),
                   "l.wkt:1: expected POLYGON or MULTIPOLYGON, found LINESTRING"));
    CHECK(contains(read("b.wkt", "POLYGON ((0 0, 4 0, 4 3, 0 3, 0 0)\n"),
                   "b.wkt:2: expected ), found the end of the file"));
    CHECK(contains(read("e.wkt", "POLYGON EMPTY\n"), "empty outline"));
    CHECK(contains(read("x.wkt", "POLYGON ((0 0, 1 1, 1 0, 0 1, 0 0))\n"), "1 pair that cross, touch or overlap"));
}

TEST_CASE("outlines with points, segments and angles as near as can be end, meshed or refused") {
    for (const double gap : {1e-3, 1e-5, 1e-7, 1e-9, 1e-12, 1e-16, 1e-310}) {
        CAPTURE(gap);
        cgal::Outline outline;
        outline.segments.resize(2, 5);
        outline.segments << 0, 1, 2, 3, 4, 1, 2, 3, 4, 0;
        outline.points.resize(2, 5);
        outline.points << 0, 4, 4, gap, 0, 0, 0, 3, 3, 3; // two points side by side
        CHECK(relative(area(cgal::triangulate<double>(outline, {.n_nodes = 60})), 12., 12.) < 1e-2);
        outline.points << 0, 4, 4, 2, 0, 0, 0, gap, gap, gap; // a strip
        const std::string strip = message([&] { (void)cgal::triangulate<double>(outline, {.n_nodes = 60}); });
        CHECK((gap > 1e-4 || strip.starts_with("outline: expected ")));
        outline.points << 0, 4, 4, 2, 0, 0, 0, 3, gap, 3; // a corner that nearly meets the other side
        const std::string notch = message([&] { (void)cgal::triangulate<double>(outline, {.n_nodes = 60}); });
        CHECK((notch.empty() || notch.starts_with("outline: expected ")));
    }
}
