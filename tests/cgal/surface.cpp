// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include "shapes.hpp"

#include <springfit/cgal/surface.hpp>

using namespace springfit;
using test::relative;

namespace {

/// The error that `call` throws, or "" where it throws none.
template <class Error, class Call>
std::string message(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("every file format, text and binary, gives the same solid") {
    const test::TemporaryFolder folder;
    const auto l = test::l_shape();
    for (const auto& path :
         {folder.file("l.off", test::off(l)), folder.file("l.obj", test::obj(l)),
          folder.file("text.ply", test::ply(l, false)), folder.file("binary.ply", test::ply(l, true)),
          folder.file("text.stl", test::stl(l, false)), folder.file("binary.STL", test::stl(l, true))}) {
        CAPTURE(path.filename().string());
        const auto surface = cgal::read_surface(path);
        CHECK(surface.n_nodes() == 12);
        CHECK(surface.n_cells() == 20);
        const auto found = cgal::require_solid(surface);
        CHECK(relative(found.volume, 3., 3.) < 1e-14);
        CHECK(found.pieces == 1);
        const auto membrane = cgal::surface_mesh<float>(path);
        CHECK(membrane.cells == surface.cells);
        CHECK(membrane.nodes == surface.nodes.cast<float>());
    }
}

TEST_CASE("polygons are cut, points given twice merged, faces turned outwards, flat ones dropped") {
    const test::TemporaryFolder folder;
    const auto quads =
        folder.file("quads.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                                 "f 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    CHECK(relative(cgal::examine(cgal::read_surface(quads)).volume, 1., 1.) < 1e-14);

    auto inside_out = test::box(1, 2, 3);
    inside_out.cells.row(0).swap(inside_out.cells.row(1));
    CHECK(relative(cgal::examine(cgal::repair(inside_out)).volume, 6., 6.) < 1e-14);
    inside_out = test::box(1, 2, 3);
    std::swap(inside_out.cells(0, 4), inside_out.cells(1, 4)); // one face of twelve
    CHECK(relative(cgal::examine(cgal::repair(inside_out)).volume, 6., 6.) < 1e-14);

    auto messy = test::box(1, 1, 1);
    messy.cells.conservativeResize(3, 14);
    messy.cells.col(12) << 0, 1, 1;           // no area
    messy.cells.col(13) = messy.cells.col(3); // twice
    const auto clean = cgal::repair(messy);
    CHECK(clean.n_cells() == 12);
    CHECK(cgal::examine(clean).bounds_volume);

    auto nested = test::both(test::box(3, 3, 3), test::box(1, 1, 1), {1, 1, 1}); // a hollow: 27 - 1
    CHECK(relative(cgal::require_solid(cgal::repair(nested)).volume, 26., 26.) < 1e-14);
}

TEST_CASE("open surfaces are refused with their boundary and closed where holes are small enough") {
    auto open = test::sphere(2);
    open.cells = open.cells.rightCols(open.n_cells() - 1).eval();
    CHECK(message<InvalidArgument>([&] { cgal::require_solid(open, "ball.off"); }) ==
          "ball.off: expected a closed surface, found an open one: 3 boundary edges around 1 hole, 0.546523 across "
          "(the surface is 3.4641); close it first, or fill its holes (--fill-holes)");
    const auto found = cgal::examine(open);
    CHECK(found.holes == 1);
    CHECK(found.boundary_edges == 3);
    CHECK(found.volume == 0);
    CHECK_FALSE(found.bounds_volume);
    CHECK(cgal::examine(cgal::repair(open, {.max_hole_edges = 2})).holes == 1);
    CHECK(cgal::repair(open, {.max_hole_edges = 3}).n_cells() == test::sphere(2).n_cells());
    const double whole = cgal::require_solid(test::sphere(2)).volume;
    CHECK(relative(cgal::require_solid(cgal::repair(open, {.max_hole_edges = 3})).volume, whole, whole) < 1e-13);
    CHECK_THROWS_AS((void)cgal::repair(open, {.max_hole_edges = -1}), InvalidArgument);
}

TEST_CASE("self-intersecting and flat surfaces are refused with how many") {
    const auto crossing = test::both(test::box(1, 1, 1), test::box(1, 1, 1), {0.5, 0.25, 0.125});
    const auto found = cgal::examine(crossing);
    CHECK(found.pieces == 2);
    CHECK(found.self_intersections > 0);
    CHECK(message<InvalidArgument>([&] { cgal::require_solid(crossing); }) ==
          "surface: expected a surface that does not cross itself, found " + std::to_string(found.self_intersections) +
              " pairs of intersecting faces");
    auto flat = test::box(1, 1, 1);
    flat.nodes.row(2).setZero();
    CHECK_FALSE(cgal::examine(flat).bounds_volume);
    CHECK_THROWS_AS(cgal::require_solid(flat), InvalidArgument);
    flat.nodes.setZero();
    CHECK_THROWS_AS((void)cgal::repair(flat), InvalidArgument);
}

TEST_CASE("what is wrong with a file is said with its name and line") {
    const test::TemporaryFolder folder;
    const auto read = [](const std::filesystem::path& path) {
        return message<FileError>([&] { (void)cgal::read_surface(path); });
    };
    CHECK(contains(read(folder / "none.off"), "none.off: no such file"));
    CHECK(contains(read(folder.file("a.xyz", "1 2 3")), "unknown kind of surface file '.xyz'"));
    CHECK(contains(read(folder.file("a.off", "")), "is empty"));
    std::filesystem::create_directory(folder / "b.off");
    CHECK(contains(read(folder / "b.off"), "is a folder"));
    CHECK(contains(read(folder.file("words.off", "these are no numbers\n")), "words.off:1: expected OFF"));
    auto box = test::box(1, 1, 1);
    box.cells(0, 0) = 8;
    CHECK(contains(read(folder.file("index.off", test::off(box))), "index.off:11: face 0 names vertex 8, there are 8"));
    box.nodes.setZero();
    box.cells(0, 0) = 0;
    CHECK(contains(read(folder.file("zero.off", test::off(box))), "every face is degenerate"));
}

TEST_CASE("faces of many corners are cut, those that cross themselves refused by their number") {
    const test::TemporaryFolder folder;
    const std::string corners = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nv 0 0 1\nv 2 0 1\nv 2 2 1\nv 1 0.5 1\n"
                                "v 0 2 1\n";
    const std::string sides = "f 1 2 7 6\nf 2 3 8 7\nf 3 4 9 8\nf 4 5 10 9\nf 5 1 6 10\n";
    const auto notched = folder.file("notched.obj", corners + sides + "f 5 4 3 2 1\nf 6 7 8 9 10\n");
    CHECK(relative(cgal::require_solid(cgal::read_surface(notched)).volume, 2.5, 2.5) < 1e-14);
    const auto crossed = folder.file("crossed.obj", corners + sides + "f 5 4 3 2 1\nf 6 8 7 9 10\n");
    CHECK(contains(message<InvalidArgument>([&] { (void)cgal::read_surface(crossed); }),
                   "crossed.obj: expected faces that neither cross nor touch themselves, found face 7, whose 5 corners "
                   "begin at (0 0 1)"));
    const auto on_a_line =
        folder.file("line.obj", corners + sides + "f 5 4 3 2 1\nf 6 7 8 9 10\nv 1 0 0\nv 0.5 0 0\nf 1 2 11 12\n");
    CHECK(cgal::read_surface(on_a_line).n_cells() == 16);
}

TEST_CASE("points that are nearer than a millionth of the body are one; sizes out of range are refused") {
    for (const double gap : {1e-7, 1e-9, 1e-16, 1e-100, 1e-310}) {
        CAPTURE(gap);
        auto twice = test::box(1, 1, 1);
        twice.nodes.conservativeResize(3, 9);
        twice.nodes.col(8) << gap, 0, 0; // beside node 0, which only some of the faces name
        twice.cells(0, 0) = 8;
        const auto surface = cgal::repair(twice);
        CHECK(surface.n_nodes() == 8);
        CHECK(relative(cgal::require_solid(surface).volume, 1., 1.) < 1e-6);
    }
    auto close = test::box(1, 1, 1);
    close.nodes.conservativeResize(3, 9);
    close.nodes.col(8) << 1e-5, 0, 0;
    close.cells(0, 0) = 8;
    CHECK(cgal::repair(close).n_nodes() == 9);
    for (const double size : {1e-40, 1e40}) {
        CHECK(contains(message<InvalidArgument>([&] { (void)cgal::repair(test::box(size, size, size)); }),
                       "surface: expected a body of a size from 1e-30 to 1e+30"));
    }
}

TEST_CASE("a sheet is told apart from a body with a hole") {
    auto sheet = test::box(2, 1, 1);
    sheet.cells = sheet.cells.leftCols(2).eval();
    sheet.nodes = sheet.nodes.leftCols(4).eval();
    CHECK(message<InvalidArgument>([&] { cgal::require_solid(sheet, "cloth.obj"); }) ==
          "cloth.obj: expected a closed surface, found a sheet: 4 boundary edges, 2.23607 across (it would be a "
          "membrane; "
          "a volume is needed)");
}
