// SPDX-License-Identifier: BSD-3-Clause
#include "files.hpp"

#include <cstdint>
#include <cstring>

#include <springfit/io/outline_file.hpp>
#include <springfit/io/surface_file.hpp>

using namespace springfit;
using namespace springfit::io;
using springfit::test::put;
using springfit::test::ScratchFolder;

namespace {

using Point = std::array<double, 3>;

/// A tetrahedron with coordinates that single precision holds.
const std::vector<Point> points{{0, 0, 0}, {1.5, 0, 0}, {0, -2, 0}, {0.25, 0, 4}};
const std::vector<std::vector<int>> faces{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};

SurfaceFile read(const std::string& name, const std::string& content) {
    const ScratchFolder folder;
    put(folder / name, content);
    return read_surface_file(folder / name);
}

/// The message of the FileError with which a file is refused, from the end of its name on.
template <class Read>
std::string refusal(const std::string& name, const std::string& content, const Read& read_file) {
    const ScratchFolder folder;
    put(folder / name, content);
    const std::string message = test::file_error([&] { (void)read_file(folder / name); });
    const std::string path = folder / name;
    return message.starts_with(path) ? message.substr(path.size()) : message;
}

std::string refusal(const std::string& name, const std::string& content) {
    return refusal(name, content, [](const auto& path) { return read_surface_file(path); });
}

std::string outline_refusal(const std::string& name, const std::string& content) {
    return refusal(name, content, [](const auto& path) { return read_outline_file(path); });
}

bool contains(const std::string& whole, const std::string& part) {
    return whole.find(part) != std::string::npos;
}

std::string replaced(std::string whole, const std::string& part, const std::string& by) {
    REQUIRE(contains(whole, part));
    return whole.replace(whole.find(part), part.size(), by);
}

template <class T>
void append(std::string& content, T value, std::endian order = std::endian::little) {
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), &value, sizeof(T));
    if (order != std::endian::native) {
        std::reverse(raw.begin(), raw.end());
    }
    content.append(raw.data(), raw.size());
}

/// A text with one line for each point and for each face.
std::string lines(const std::string& before_point, const std::string& behind_point, const std::string& before_face,
                  const std::string& behind_face, int first = 0) {
    std::string content;
    for (const Point& p : points) {
        content += text(before_point, p[0], ' ', p[1], ' ', p[2], behind_point, '\n');
    }
    for (const auto& f : faces) {
        content += text(before_face, f[0] + first, ' ', f[1] + first, ' ', f[2] + first, behind_face, '\n');
    }
    return content;
}

struct Off {
    static constexpr const char* name = "a.off";
    static std::string good() { return "OFF\n4 4 6\n" + lines("", "", "3 ", ""); }
};

struct BinaryOff {
    static constexpr const char* name = "b.off";
    static std::string good() { return with_header("OFF BINARY\n", 0); }
    static std::string with_header(const std::string& header, int extras) {
        std::string content = header;
        for (const std::int32_t n : {4, 4, 6}) {
            append(content, n, std::endian::big);
        }
        for (const Point& p : points) {
            for (const double x : p) {
                append(content, static_cast<float>(x), std::endian::big);
            }
            for (int e = 0; e < extras; ++e) {
                append(content, 0.5F, std::endian::big);
            }
        }
        for (const auto& f : faces) {
            for (const std::int32_t n : {3, f[0], f[1], f[2], 1}) {
                append(content, n, std::endian::big);
            }
            append(content, 0.5F, std::endian::big);
        }
        return content;
    }
};

struct Obj {
    static constexpr const char* name = "a.obj";
    static std::string good() { return "# a body\no body\n" + lines("v ", "", "f ", "", 1); }
};

struct TextStl {
    static constexpr const char* name = "a.stl";
    static std::string good() {
        std::string content = "solid facet\n";
        for (const auto& f : faces) {
            content += "facet normal 0 0 nan\n outer loop\n";
            for (const int i : f) {
                const Point& p = points[static_cast<std::size_t>(i)];
                content += text("  vertex ", p[0], '\t', p[1], ' ', p[2], '\n');
            }
            content += " endloop\nendfacet\n";
        }
        return content + "endsolid facet\n";
    }
};

struct BinaryStl {
    static constexpr const char* name = "b.stl";
    static std::string good() { return with_header("solid of some program", 4); }
    static std::string with_header(std::string content, std::uint32_t n) {
        content.resize(80, '\0');
        append(content, n);
        for (const auto& f : faces) {
            content += std::string(12, '\xFF'); // normals that are NaN
            for (const int i : f) {
                for (const double x : points[static_cast<std::size_t>(i)]) {
                    append(content, static_cast<float>(x));
                }
            }
            content += std::string(2, '\x01');
        }
        return content;
    }
};

struct TextPly {
    static constexpr const char* name = "a.ply";
    static std::string good() {
        return "ply\nformat ascii 1.0\ncomment element face 9\nelement vertex 4\nproperty float x\nproperty float y\n"
               "property float z\nproperty float nx\nelement face 4\nproperty list uchar int vertex_indices\n"
               "property uchar red\nend_header\n" +
               lines("", " nan", "3 ", " 255");
    }
};

template <std::endian Order>
struct BinaryPly {
    static constexpr const char* name = "b.ply";
    /// Faces first, a list to skip, coordinates as double, float and short, and one element that is of no concern.
    static std::string good() { return with_index<std::uint16_t>("ushort"); }
    template <class Index>
    static std::string with_index(const std::string& type) {
        std::string content =
            text("ply\r\nformat binary_", Order == std::endian::big ? "big" : "little",
                 "_endian 1.0\r\nelement face 4\r\nproperty float quality\r\nproperty list int8 ", type,
                 " vertex_index\r\nproperty list uint uint8 flags\r\nelement material 1\r\nproperty int32 id\r\n"
                 "element vertex 4\r\nproperty double x\r\nproperty float32 z\r\nproperty int16 y\r\nend_header\r\n");
        for (const auto& f : faces) {
            append(content, 1.F, Order);
            content += '\3';
            for (const int i : f) {
                append(content, static_cast<Index>(i), Order);
            }
            append(content, std::uint32_t(2), Order);
            content += "\n\n";
        }
        append(content, std::int32_t(7), Order);
        for (const Point& p : points) {
            append(content, p[0], Order);
            append(content, static_cast<float>(p[2]), Order);
            append(content, static_cast<std::int16_t>(p[1]), Order);
        }
        return content;
    }
};

/// The points that faces name, in their order.
std::vector<std::vector<Point>> corners(const std::vector<Point>& of, const std::vector<std::vector<int>>& polygons) {
    std::vector<std::vector<Point>> result;
    for (const auto& polygon : polygons) {
        auto& list = result.emplace_back();
        for (const int i : polygon) {
            list.push_back(of.at(static_cast<std::size_t>(i)));
        }
    }
    return result;
}

bool is_the_body(const SurfaceFile& surface) {
    return corners(surface.points, surface.polygons) == corners(points, faces);
}

} // namespace

TEST_CASE_TEMPLATE("a surface is read, and each beginning of its file is read or refused", Format, Off, BinaryOff, Obj,
                   TextStl, BinaryStl, TextPly, BinaryPly<std::endian::little>, BinaryPly<std::endian::big>) {
    const std::string good = Format::good();
    CHECK(is_the_body(read(Format::name, good)));
    const ScratchFolder folder;
    const auto path = folder / Format::name;
    for (std::size_t n = 0; n < good.size(); ++n) {
        put(path, good.substr(0, n));
        try {
            const SurfaceFile cut = read_surface_file(path);
            CHECK(!cut.polygons.empty());
        } catch (const FileError& error) {
            CHECK(contains(error.what(), Format::name));
        }
        std::string wrong = good; // and each byte of it is changed
        wrong[n] = static_cast<char>(wrong[n] ^ 0x15);
        put(path, wrong);
        try {
            for (const auto& polygon : read_surface_file(path).polygons) {
                CHECK(polygon.size() >= 3);
            }
        } catch (const FileError& error) {
            CHECK(contains(error.what(), Format::name));
        }
    }
}

TEST_CASE("OFF: every header, with what it says of vertices") {
    const std::string counts = "4 4 6\n";
    for (const auto& [word, behind] : std::vector<std::pair<std::string, std::string>>{
             {"OFF\n# a comment\n\n", ""},
             {"OFF ", ""},
             {"OFF", ""},
             {"\xEF\xBB\xBFOFF\r\n", ""},
             {"nOFF\n3\n", ""},
             {"OFF\n", " 255 0 0 # red"},
             {"COFF\n", " 1 0 0"},
             {"COFF\n", " 255 0 0 255"},
             {"NOFF\n", " 0 0 1"},
             {"CNOFF\n", " 0 0 1 1 0 0"},
             {"STOFF\n", " 0.5 0.5"},
             {"STCNOFF\n", " 0 0 1 1 0 0 1 0.5 0.5"},
         }) {
        const std::string& header = word;
        CAPTURE(header);
        CHECK(is_the_body(read("a.off", header + counts + lines("", behind, "3 ", " 0.1 0.2 0.3"))));
    }
    CHECK(is_the_body(read("a.off", "OFF\n4 4\n" + lines("", "", "3 ", "")))); // no number of edges
    CHECK(is_the_body(read("a.off", BinaryOff::with_header("STCNOFF BINARY\n", 9))));
    const auto with_line = read("a.off", "OFF 4 5 6\n" + lines("", "", "3 ", "") + "2 0 1\n");
    CHECK(is_the_body(with_line)); // a line among the faces is left out
}

TEST_CASE("OFF: what is broken is refused with its line") {
    const std::string good = Off::good();
    CHECK(contains(refusal("a.off", ""), "is empty"));
    CHECK(contains(refusal("a.off", "words\n"), ":1: expected OFF (or COFF, NOFF, ...), found \"words\""));
    CHECK(contains(refusal("a.off", "4OFF\n4 4 6\n"), "found 4OFF"));
    CHECK(contains(refusal("a.off", "OFF\n4 0 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"), "empty surface: 4 vertices, 0 faces"));
    CHECK(contains(refusal("a.off", replaced(good, "4 4 6", "99999999 4 6")), "more than the file can hold"));
    CHECK(contains(refusal("a.off", replaced(good, "4 4 6", "4 99999999999999999 6")), "more than the file can hold"));
    CHECK(contains(refusal("a.off", replaced(good, "3 0 1 2", "42949672959672953 0 1 2")),
                   ":7: 42949672959672953 corners of a face announced"));
    CHECK(contains(refusal("a.off", replaced(good, "3 0 1 2", "3 0 1 4")), ":7: face 0 names vertex 4, there are 4"));
    CHECK(contains(refusal("a.off", replaced(good, "3 0 1 2", "3 0 1 -1")), ":7: face 0 names vertex -1"));
    CHECK(contains(refusal("a.off", replaced(good, "1.5", "nan")), ":4: a coordinate is not finite: nan"));
    CHECK(contains(refusal("a.off", replaced(good, "1.5", "-inf")), ":4: a coordinate is not finite: -inf"));
    CHECK(contains(refusal("a.off", replaced(good, "1.5", "1e300")), ":4: expected coordinates up to 1e+100"));
    CHECK(contains(refusal("a.off", replaced(good, "1.5", "1,5")), ":4: expected a coordinate, found \"1,5\""));
    CHECK(contains(refusal("a.off", "COFF\n4 4 6\n" + lines("", " 251e300", "3 ", "")),
                   ":3: expected a vertex with a colour of 3 or 4 numbers"));
    CHECK(contains(refusal("a.off", replaced(BinaryOff::good(), std::string("\x3f\xc0\0\0", 4), "\x7f\xc0\xff\xff")),
                   "at byte "));
}

TEST_CASE("OBJ: tabs, continued lines, texture and normals, numbers from the end") {
    const std::string vertices = "v\t0 0 0 1\r\nv 1.5 \\\n 0\t0\nv 0 -2 0 0.1 0.2 0.3\nvn 0 0 1\nvt 0 0\nv .25 0. +4\n";
    CHECK(is_the_body(read("a.obj", vertices + "s off\nusemtl \\\n none\nf 1 2 3\nf 1/1 4/1 2/1\nl 1 2\np 1\n"
                                               "f\t2//1 \\\r\n 4//1\\\n 3//1 # a face\nf -2/1/1 -1/1/1 -4/1/1")));
    const auto ahead = read("a.obj", "f 1 2 3\n" + vertices); // a face before its vertices
    CHECK(ahead.polygons == std::vector<std::vector<int>>{{0, 1, 2}});
    CHECK(contains(refusal("a.obj", vertices), "empty surface: 4 vertices, 0 faces"));
    CHECK(contains(refusal("a.obj", vertices + "\nf 1 2 5\n"), ":9: face 1 names vertex 5, there are 4"));
    CHECK(contains(refusal("a.obj", vertices + "f 1 2 0\n"), ":8: expected the number of a vertex, from 1"));
    CHECK(contains(refusal("a.obj", vertices + "f 1 2 -5\n"), "found -5; there are 4 so far"));
    CHECK(contains(refusal("a.obj", vertices + "f 1 2 x\n"), "found \"x\""));
    CHECK(contains(refusal("a.obj", "v 1 2\nv 1 2 3\n"), ":1: expected three coordinates of a vertex"));
    CHECK(contains(refusal("a.obj", "v 1 2 1.#INF\n"), ":1: expected a coordinate, found \"1.#INF\""));
}

TEST_CASE("STL: several solids, any case, no end, bytes behind the last facet") {
    std::string upper = TextStl::good();
    for (char& c : upper) {
        c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    }
    CHECK(is_the_body(read("a.STL", upper)));
    CHECK(is_the_body(read("a.stl", replaced(TextStl::good(), "endsolid facet", "end solid"))));
    CHECK(is_the_body(read("a.stl", replaced(TextStl::good(), "endsolid facet\n", ""))));
    CHECK(is_the_body(read("a.stl", replaced(TextStl::good(), "0 0 nan", "-1.#IND 1 1"))));
    CHECK(read("a.stl", TextStl::good() + TextStl::good()).polygons.size() == 8);
    CHECK(is_the_body(read("a.stl", BinaryStl::with_header("any", 4) + "colours")));
    CHECK(contains(refusal("a.stl", BinaryStl::with_header("any", 5)), "at most the 4 that it has bytes for, found 5"));
    CHECK(contains(refusal("a.stl", "any"), "expected an STL file"));
    CHECK(
        contains(refusal("a.stl", replaced(TextStl::good(), "endloop", "end")), ":7: expected endloop, found \"end\""));
    CHECK(contains(refusal("a.stl", replaced(TextStl::good(), "1.5", "inf")), "a coordinate is not finite: inf"));
    CHECK(contains(refusal("a.stl", "solid\nendsolid\n"), "empty surface"));
    std::string infinite = BinaryStl::good();
    std::memcpy(infinite.data() + 84 + 12, "\0\0\x80\x7f", 4);
    CHECK(contains(refusal("a.stl", infinite), "at byte "));
}

TEST_CASE("PLY: list indices of any type; what the header lacks") {
    using Little = BinaryPly<std::endian::little>;
    CHECK(is_the_body(read("a.ply", Little::with_index<std::uint8_t>("uchar"))));
    CHECK(is_the_body(read("a.ply", Little::with_index<std::int8_t>("char"))));
    CHECK(is_the_body(read("a.ply", Little::with_index<std::int16_t>("short"))));
    CHECK(is_the_body(read("a.ply", Little::with_index<std::uint32_t>("uint32"))));
    CHECK(is_the_body(read("a.ply", Little::with_index<float>("float"))));
    const std::string good = TextPly::good();
    CHECK(contains(refusal("a.ply", replaced(good, "ply", "plyx")), ":1: expected ply: not a PLY file"));
    CHECK(contains(refusal("a.ply", replaced(good, "element vertex 4", "element vertex")),
                   ":4: expected the number of elements \"vertex\", found the end of the line"));
    CHECK(contains(refusal("a.ply", replaced(good, "element vertex 4\n", "")),
                   ":4: expected an element before its first property"));
    CHECK(contains(refusal("a.ply", replaced(good, "property float y\n", "")), "expected a property y"));
    CHECK(contains(refusal("a.ply", replaced(good, "vertex_indices", "corners")), "expected a list vertex_indices"));
    CHECK(contains(refusal("a.ply", replaced(good, "float x", "half x")),
                   ":5: expected a type of number, found \"half\""));
    CHECK(contains(refusal("a.ply", replaced(good, "ascii", "octal")), ":2: expected ascii, binary_little_endian"));
    CHECK(contains(refusal("a.ply", replaced(good, "format ascii 1.0\n", "")), "expected a line with the format"));
    CHECK(contains(refusal("a.ply", replaced(good, "vertex 4", "vertex 9999999")), "more than the file can hold"));
    CHECK(contains(refusal("a.ply", replaced(good, "vertex 4", "vertex -4")), "found -4"));
    CHECK(contains(refusal("a.ply", replaced(good, "3 0 1 2", "-3 0 1 2")), "more than the file can hold"));
    CHECK(contains(refusal("a.ply", replaced(good, "3 0 1 2", "3 0 1 9")), ":17: face 0 names vertex 9, there are 4"));
    CHECK(
        contains(refusal("a.ply", "ply\nformat ascii 1.0\nelement x 99999999999\nend_header\n"), "more than the file"));
}

TEST_CASE("what is no surface file is refused by name") {
    const ScratchFolder folder;
    const auto error = [&](const std::string& name) {
        return test::file_error([&] { (void)read_surface_file(folder / name); });
    };
    CHECK(contains(error("none.off"), "none.off: no such file"));
    CHECK(contains(error("a.xyz"), "unknown kind of surface file '.xyz'; .off, .obj, .stl and .ply are read"));
    std::filesystem::create_directory(folder / "b.off");
    CHECK(contains(error("b.off"), "is a folder"));
    std::filesystem::create_symlink("/dev/zero", folder / "c.off");
    CHECK(contains(error("c.off"), "is a device"));
}

TEST_CASE("outlines of either format, and each beginning of their files") {
    const std::string poly =
        "# a plate\n4 2 0 1\n1 0 0 1\n2 4 0 1 # a corner\n3 4 3 1\n4 0 3 1\n\n4 1\n1 1 2 5\n2 2 3 5\n"
        "3 3 4 5\n4 4 1 5\n1\n1 1.5 1.5\n";
    const std::string wkt =
        "POLYGON((0 0,4 0,\n 4 3, 0 3, 0 0) , (1 1, 2 1, 2\n2, 1 1))\nmultipolygon empty Polygon EMPTY\n"
        "MULTIPOLYGON (((5 0, 6 0, 6 1, 5 0)))";
    for (const auto& [name, good] : {std::pair<std::string, std::string>{"a.poly", poly}, {"a.wkt", wkt}}) {
        const ScratchFolder folder;
        put(folder / name, good);
        const OutlineFile whole = read_outline_file(folder / name);
        CHECK(whole.points[2] == std::array<double, 2>{4, 3});
        CHECK(whole.segments[3] == std::array<int, 2>{3, 0});
        for (std::size_t n = 0; n < good.size(); ++n) {
            put(folder / name, good.substr(0, n));
            try {
                const OutlineFile cut = read_outline_file(folder / name);
                CHECK(!cut.segments.empty());
            } catch (const FileError& error) {
                CHECK(contains(error.what(), name));
            }
        }
    }
    const ScratchFolder folder;
    put(folder / "a.wkt", wkt);
    const OutlineFile outline = read_outline_file(folder / "a.wkt");
    CHECK(outline.areas == std::vector<OutlineFile::Area>{{{0, 1, 2, 3}, {4, 5, 6}}, {{7, 8, 9}}});
    CHECK(outline.segments.size() == 10);
}

TEST_CASE("outlines that are broken are refused with their line") {
    CHECK(contains(outline_refusal("a.svg", "<svg/>"), "unknown kind of outline file '.svg'; .poly and .wkt are read"));
    CHECK(contains(outline_refusal("a.wkt", ""), "is empty"));
    CHECK(contains(outline_refusal("a.wkt", "POLYGON ((0 0, 4 0,\n 1e300 3, 0 0))"),
                   ":2: expected coordinates up to 1e+100, found 1e+300"));
    CHECK(contains(outline_refusal("a.wkt", "POLYGON ((0 0, 4, 4 3, 0 0))"), ":1: expected a coordinate, found \",\""));
    CHECK(contains(outline_refusal("a.wkt", "POLYGON ((0 0, 4 0, 4 3, 0 0)"),
                   ":1: expected ), found the end of the file"));
    CHECK(contains(outline_refusal("a.wkt", "POLYGON Z ((0 0 1))"), ":1: expected (, found \"Z\""));
    CHECK(contains(outline_refusal("a.wkt", "\nPOINT (0 0)"), ":2: expected POLYGON or MULTIPOLYGON, found POINT"));
    CHECK(contains(outline_refusal("a.poly", "99999999 2 0 0\n"), "99999999 vertices announced, more than the file"));
    CHECK(contains(outline_refusal("a.poly", "0 2 0 0\n0\n0\n"), "no vertices here"));
    CHECK(contains(outline_refusal("a.poly", "1 2\n1 0 inf\n"), ":2: a coordinate is not finite: inf"));
}
