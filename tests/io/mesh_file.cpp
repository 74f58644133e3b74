// SPDX-License-Identifier: BSD-3-Clause
#include "files.hpp"

#include <cstdint>
#include <cstring>

#include <springfit/io/mesh_file.hpp>
#include <springfit/mesh/structured.hpp>

using namespace springfit;
using namespace springfit::io;
using springfit::test::file_error;
using springfit::test::put;
using springfit::test::ScratchFolder;

namespace {

/// The mesh in a file of this name and content.
MeshFile read(const std::string& name, const std::string& content) {
    const ScratchFolder folder;
    put(folder / name, content);
    return read_mesh(folder / name);
}

/// The message with which the file is refused, from the end of its name on.
std::string refusal(const std::string& name, const std::string& content) {
    const ScratchFolder folder;
    put(folder / name, content);
    const std::string message = file_error([&] { (void)read_mesh(folder / name); });
    const std::string path = folder / name;
    return message.starts_with(path) ? message.substr(path.size()) : message;
}

/// Writes a Gmsh file as words or as bytes.
struct GmshText {
    bool binary;
    std::string content{};

    template <class T>
    void put(T value) {
        if (binary) {
            content.append(reinterpret_cast<const char*>(&value), sizeof value);
        } else {
            content += text(value, ' ');
        }
    }
    void start(const char* version) {
        content = text("$MeshFormat\n", version, ' ', binary ? 1 : 0, " 8\n");
        if (binary) {
            put(std::int32_t(1));
        }
        content += "\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"the $Nodes of 2 bodies\"\n$EndPhysicalNames\n";
    }
};

using Position = std::array<double, 3>;
/// Four corners of a box and a fifth point off them, under numbers with gaps; the first is in no cell.
const std::vector<std::pair<int, Position>> numbered_points{{7, {9, 9, 9}}, {100, {0, 0, 0}}, {3, {1, 0, 0}},
                                                            {5, {0, 2, 0}}, {42, {0, 0, 1}},  {43, {2, 2, 2}}};

/// Two tetrahedra in two blocks, a triangle and a line beside them.
std::string gmsh_2(bool binary) {
    GmshText file{binary};
    file.start("2.2");
    file.content += "$Nodes\n6\n";
    for (const auto& [number, position] : numbered_points) {
        file.put(std::int32_t(number));
        for (const double x : position) {
            file.put(x);
        }
    }
    file.content += "\n$EndNodes\n$Elements\n4\n";
    int number = 10;
    const auto element = [&](int type, const std::vector<int>& nodes) {
        if (binary) {
            for (const int value : {type, 1, 2, ++number}) {
                file.put(std::int32_t(value));
            }
        } else {
            for (const int value : {++number, type, 2}) {
                file.put(value);
            }
        }
        file.put(std::int32_t(1)); // tags
        file.put(std::int32_t(1));
        for (const int node : nodes) {
            file.put(std::int32_t(node));
        }
    };
    element(1, {100, 3});
    element(4, {100, 3, 5, 42});
    element(2, {100, 3, 5});
    element(4, {3, 5, 42, 43});
    file.content += "\n$EndElements\n";
    return file.content;
}

std::string gmsh_4(bool binary) {
    GmshText file{binary};
    using Large = std::uint64_t;
    file.start("4.1");
    file.content += "$Nodes\n";
    for (const Large value : {2, 6, 3, 100}) {
        file.put(value);
    }
    for (const std::size_t begin : {0, 3}) {
        const bool parametric = begin == 0; // of a curve: one parameter behind each point
        for (const int value : {1, 1, parametric ? 1 : 0}) {
            file.put(std::int32_t(value));
        }
        file.put(Large(3));
        for (std::size_t i = begin; i < begin + 3; ++i) {
            file.put(Large(numbered_points[i].first));
        }
        for (std::size_t i = begin; i < begin + 3; ++i) {
            for (const double x : numbered_points[i].second) {
                file.put(x);
            }
            if (parametric) {
                file.put(0.5);
            }
        }
    }
    file.content += "\n$EndNodes\n$Elements\n";
    for (const Large value : {4, 4, 1, 4}) {
        file.put(value);
    }
    Large number = 0;
    const auto block = [&](int dimension, int type, const std::vector<int>& nodes) {
        for (const int value : {dimension, 1, type}) {
            file.put(std::int32_t(value));
        }
        file.put(Large(1));
        file.put(++number);
        for (const int node : nodes) {
            file.put(Large(node));
        }
    };
    block(1, 1, {100, 3});
    block(3, 4, {100, 3, 5, 42});
    block(2, 2, {100, 3, 5});
    block(3, 4, {3, 5, 42, 43});
    file.content += "\n$EndElements\n";
    return file.content;
}

void check_two_tetrahedra(const MeshFile& file) {
    CHECK(file.points.cols() == 6);
    CHECK(file.cell_dimension() == 3);
    CHECK(file.notes == std::vector<std::string>{"left out: 1 lines, 1 triangles"});
    const auto mesh = file.as_mesh<3, double, Tet4>();
    CHECK(mesh.nodes == Points<3, double>{{0, 1, 0, 0, 2}, {0, 0, 2, 0, 2}, {0, 0, 0, 1, 2}});
    CHECK(mesh.cells == Mesh<3, double, Tet4>::CellArray{{0, 1}, {1, 2}, {2, 3}, {3, 4}});
    CHECK_NOTHROW(validate(mesh));
}

const std::string gmsh_head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";

} // namespace

TEST_CASE("Gmsh files of both versions, as text and as bytes, with numbers that have gaps") {
    for (const bool binary : {false, true}) {
        CAPTURE(binary);
        check_two_tetrahedra(read("a.msh", gmsh_2(binary)));
        check_two_tetrahedra(read("a.MSH", gmsh_4(binary)));
    }
}

TEST_CASE("Gmsh files that break off are refused, wherever they do") {
    for (const std::string& whole : {gmsh_2(false), gmsh_2(true), gmsh_4(false), gmsh_4(true)}) {
        for (std::size_t size = 0; size + 1 < whole.size(); size += 7) {
            CHECK_THROWS_AS((void)read("a.msh", whole.substr(0, size)), FileError);
        }
    }
}

TEST_CASE("quadratic and mixed cells of Gmsh") {
    // The ten nodes of the unit tetrahedron in Gmsh's order: the last two are those of edges (2, 3) and (1, 3).
    std::string content = gmsh_head + "$Nodes\n10\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 .5 0 0\n6 .5 .5 0\n7 0 .5 0\n"
                                      "8 0 0 .5\n9 0 .5 .5\n10 .5 0 .5\n$EndNodes\n"
                                      "$Elements\n1\n1 11 0 1 2 3 4 5 6 7 8 9 10\n$EndElements\n";
    const auto tet10 = read("a.msh", content).as_mesh<3, double, Tet10>();
    for (std::size_t e = 0; e < Tet10::edges.size(); ++e) {
        const auto x = tet10.cell_nodes(0);
        const Vector<3, double> middle = (x.col(Tet10::edges[e][0]) + x.col(Tet10::edges[e][1])) / 2;
        CHECK(x.col(4 + static_cast<Index>(e)) == middle);
    }
    content = gmsh_head + "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 2 0 0\n$EndNodes\n"
                          "$Elements\n3\n1 2 2 0 0 2 5 3\n2 3 1 0 1 2 3 4\n3 15 0 1\n$EndElements\n";
    const MeshFile mixed = read("a.msh", content);
    REQUIRE(mixed.blocks.size() == 2);
    CHECK(mixed.blocks[0].kind == CellKind::triangle);
    CHECK(mixed.blocks[1].kind == CellKind::quadrilateral);
    CHECK(mixed.notes == std::vector<std::string>{"left out: 1 points"});
    CHECK(file_error([&] { (void)(mixed.as_mesh<2, double, Quad4>()); })
              .ends_with("a.msh: expected cells of kind quadrilateral only, found 1 cells of kind triangle, 1 cells of "
                         "kind quadrilateral"));
}

TEST_CASE("what is wrong in a Gmsh file is named with its line") {
    const auto with = [](const std::string& nodes, const std::string& elements) {
        return refusal("a.msh",
                       gmsh_head + "$Nodes\n" + nodes + "\n$EndNodes\n$Elements\n" + elements + "\n$EndElements\n");
    };
    const std::string good = "3\n1 0 0 0\n2 1 0 0\n3 0 1 0";
    CHECK(with(good, "1\n1 2 0 1 2 3") == "no FileError");
    CHECK(with("3\n1 0 0 0\n2 x 0 0\n3 0 1 0", "") == ":7: expected a coordinate, found \"x\"");
    CHECK(with("3\n1 0 0 0\n2 nan 0 0\n3 0 1 0", "") == ":7: expected a coordinate, found nan");
    CHECK(with("3\n1 0 0 0\n1 1 0 0\n3 0 1 0", "") == ":7: point 1 is there twice");
    CHECK(with("999\n1 0 0 0", "") == ":6: 999 points announced, more than the file can hold");
    CHECK(with(good, "1\n1 2 0 1 2 4") == ":12: a cell names point 4, which the file does not have");
    CHECK(with(good, "1\n1 99 0 1 2 3") == ":12: cells of Gmsh's type 99 are not known");
    CHECK(with(good, "1\n1 1 0 1 2") == ": holds no cells but points and lines");
    CHECK(with(good, "1\n1 6 0 1 2 3 1 2 3") == ": holds 1 prisms, for which springfit has no kind of cell");
    CHECK(with("0", "0") == ": holds no points");
    CHECK(refusal("a.msh", "$NODES\n") == ":1: expected $MeshFormat, or $NOD of version 1: not a Gmsh file");
    CHECK(refusal("a.msh", "$MeshFormat\n4 0 8\n") == ":2: Gmsh version 4; save it as version 4.1 or 2.2");
    CHECK(refusal("a.msh", gmsh_head) == ": has no section $Nodes");
    CHECK(refusal("a.msh", gmsh_head + "$ParametricNodes\n0\n$EndParametricNodes\n") ==
          ":4: $ParametricNodes; save the mesh without parametric coordinates");
    CHECK(refusal("a.msh", gmsh_head + "$Elements\n0\n$EndElements\n") == ":4: $Elements before $Nodes");
    std::string other = gmsh_2(true);
    std::swap(other[other.find("8\n") + 2], other[other.find("8\n") + 5]);
    CHECK(refusal("a.msh", other) == ":3: binary numbers in the byte order of another machine");
}

TEST_CASE("MEDIT meshes, with sections of no concern") {
    const std::string head = "MeshVersionFormatted 2\n# a comment 3\nDimension\n3\n";
    const MeshFile file =
        read("a.mesh", head + "Vertices\n4\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1e0 1\nCorners\n2\n1\n2\n"
                              "Triangles\n1\n1 2 3 7\nTetrahedra\n1\n1 2 3 4 0\nNormals\n1\n0. 0 -1\nEnd\n");
    CHECK(file.as_mesh<3, float, Tet4>().cells == Mesh<3, float, Tet4>::CellArray{{0}, {1}, {2}, {3}});
    CHECK(file.notes == std::vector<std::string>{"left out: 1 triangles"});
    const MeshFile flat = read("a.mesh", "MeshVersionFormatted 2 Dimension 2 Vertices 4 0 0 0 1 0 0 1 2 0 0 2 0 "
                                         "Quadrilaterals 1 1 2 3 4 0 End");
    CHECK(flat.as_mesh<2, double, Quad4>().nodes == Points<2, double>{{0, 1, 1, 0}, {0, 0, 2, 2}});
    CHECK(refusal("a.mesh", head + "Vertices\n1\n0 0 0\nTriangles\n0\nEnd\n") ==
          ":8: expected the label of a vertex, found \"Triangles\"");
    CHECK(refusal("a.mesh", "solid\n") == ":1: expected MeshVersionFormatted: not a MEDIT mesh in text form");
    CHECK(refusal("a.mesh", head + "Vertices\n0\nEnd\n") == ": holds no points");
}

TEST_CASE("VTK legacy grids, with cells as lists and with offsets") {
    const std::string head =
        "# vtk DataFile Version 5.1\nany title\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n"
        "0 0 0 1 0 0 1 1 0 0 1 0\n0 0 1 1 0 1 1 1 1 0 1 1\nMETADATA\nINFORMATION 0\n\n";
    const auto check = [](const MeshFile& file) {
        CHECK(file.as_mesh<3, double, Hex8>().cells.col(0) == Eigen::Matrix<int, 8, 1>{0, 1, 2, 3, 4, 5, 6, 7});
        CHECK(file.notes == std::vector<std::string>{"left out: 1 quadrilaterals"});
    };
    check(read("a.vtk", head + "CELLS 2 14\n8 0 1 2 3 4 5 6 7\n4 0 1 2 3\nCELL_TYPES 2\n12\n9\n"));
    check(read("a.vtk", head + "CELLS 3 12\nOFFSETS vtktypeint64\n0 8 12\nCONNECTIVITY vtktypeint64\n"
                               "0 1 2 3 4 5 6 7\n0 1 2 3\nCELL_TYPES 2\n12\n9\n"));
    CHECK(refusal("a.vtk", head + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n12\n") ==
          ":14: cell 0, one of the hexahedra, has 4 nodes");
    CHECK(refusal("a.vtk", head + "CELLS 1 5\n4 0 1 2 8\nCELL_TYPES 1\n10\n") ==
          ":14: a cell names point 8, which the file does not have");
    CHECK(refusal("a.vtk", head + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n77\n") ==
          ":14: cells of VTK's type 77 are not known");
    CHECK(refusal("a.vtk", head) == ": has no section CELL_TYPES");
    CHECK(refusal("a.vtk", "# vtk DataFile Version 3.0\nx\nXML\n") == ":3: expected ASCII or BINARY, found XML");
    CHECK(refusal("a.vtk", "<VTKFile/>\n") == ":1: expected # vtk DataFile: not a VTK legacy file");
}

TEST_CASE("TetGen's two files, numbered from 0 and from 1") {
    for (const int first : {0, 1}) {
        const ScratchFolder folder;
        std::string nodes = "# made by hand\n4 3 1 1\n";
        const std::array<const char*, 4> positions{"0 0 0", "1 0 0", "0 1 0", "0 0 1"};
        std::string cell = text(first, "  ");
        for (int i = 0; i < 4; ++i) {
            nodes += text(first + i, ' ', positions[static_cast<std::size_t>(i)], " 0.5 -1 # here\n");
            cell += text(first + i, ' ');
        }
        put(folder / "a.node", nodes);
        put(folder / "a.ele", "1 4 1\n" + cell + " 3\n");
        for (const char* name : {"a.node", "a.ele"}) {
            const auto mesh = read_mesh(folder / name).as_mesh<3, double, Tet4>();
            CHECK(mesh.cells == Mesh<3, double, Tet4>::CellArray{{0}, {1}, {2}, {3}});
        }
        put(folder / "a.ele", text("1 4 0\n", cell, "\n9"));
        CHECK_NOTHROW((void)read_mesh(folder / "a.ele"));
        put(folder / "a.ele", "1 5 0\n");
        CHECK(file_error([&] { (void)read_mesh(folder / "a.node"); }) ==
              (folder / "a.ele").string() + ":1: cells of 5 nodes in dimension 3 are not known");
        std::filesystem::remove(folder / "a.ele");
        CHECK(file_error([&] { (void)read_mesh(folder / "a.node"); }) ==
              (folder / "a.ele").string() + ": no such file");
    }
}

TEST_CASE("cells that all go the other way round are turned, single ones are not") {
    const std::string head = "MeshVersionFormatted 2 Dimension 3 Vertices 5 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0 1 1 1 0 ";
    const MeshFile turned = read("a.mesh", head + "Tetrahedra 2 2 1 3 4 0 3 2 4 5 0 End");
    CHECK(turned.notes == std::vector<std::string>{"turned round: all cells of kind tetrahedron"});
    const auto mesh = turned.as_mesh<3, double, Tet4>();
    for (Index c = 0; c < 2; ++c) {
        const auto x = mesh.cell_nodes(c);
        CHECK((x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).dot(x.col(3) - x.col(0)) > 0);
    }
    CHECK(read("a.mesh", head + "Tetrahedra 2 2 1 3 4 0 2 3 4 5 0 End").notes.empty());
    const MeshFile clockwise = read("a.mesh", "MeshVersionFormatted 2 Dimension 2 Vertices 3 0 0 0 1 0 0 0 1 0 "
                                              "Triangles 1 1 3 2 0 End");
    CHECK(clockwise.as_mesh<2, double, Tri3>().cells == Mesh<2, double, Tri3>::CellArray{{0}, {1}, {2}});
    // A quadratic tetrahedron, inside out: its nodes on edges go along.
    auto quadratic_mesh = quadratic(tetrahedron_grid<double>({1, 1, 1}, {1., 1., 1.}));
    std::string vtk = text("# vtk DataFile Version 2.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS ",
                           quadratic_mesh.n_nodes(), " float\n");
    for (Index i = 0; i < quadratic_mesh.n_nodes(); ++i) {
        vtk +=
            text(-quadratic_mesh.nodes(0, i), ' ', quadratic_mesh.nodes(1, i), ' ', quadratic_mesh.nodes(2, i), '\n');
    }
    vtk += "CELLS 6 66\n";
    for (Index c = 0; c < 6; ++c) {
        vtk += text("10 ", quadratic_mesh.cells.col(c).transpose(), '\n');
    }
    vtk += "CELL_TYPES 6 24 24 24 24 24 24\n";
    const auto mirrored = read("a.vtk", vtk).as_mesh<3, double, Tet10>();
    for (Index c = 0; c < 6; ++c) {
        const auto x = mirrored.cell_nodes(c);
        CHECK((x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).dot(x.col(3) - x.col(0)) > 0);
        for (std::size_t e = 0; e < Tet10::edges.size(); ++e) {
            const Vector<3, double> middle = (x.col(Tet10::edges[e][0]) + x.col(Tet10::edges[e][1])) / 2;
            CHECK((x.col(4 + static_cast<Index>(e)) - middle).norm() < 1e-15);
        }
    }
}

TEST_CASE("a surface is no volume, and space is no plane") {
    const MeshFile surface = read("skin.mesh", "MeshVersionFormatted 2 Dimension 3 Vertices 3 0 0 0 0 1 0 1 0 0 1 0 0 "
                                               "Triangles 1 1 2 3 0 End");
    CHECK(surface.cell_dimension() == 2);
    CHECK_FALSE(surface.is_flat());
    CHECK(
        file_error([&] { (void)(surface.as_mesh<3, double, Tet4>()); })
            .ends_with("skin.mesh: holds a surface where a volume is needed: expected cells of kind tetrahedron only, "
                       "found 1 cells of kind triangle"));
    CHECK(file_error([&] { (void)(surface.as_mesh<2, double, Tri3>()); }).ends_with("is not flat: z from 0 to 1"));
    CHECK(surface.as_mesh<3, double, Tri3>().n_cells() == 1);
    CHECK(refusal("a.stl", "solid") == ": has no ending of a mesh: .msh, .mesh, .vtk, .node or .ele");
    const ScratchFolder folder;
    CHECK(file_error([&] { (void)read_mesh(folder / "none.msh"); }) ==
          (folder / "none.msh").string() + ": no such file");
}

namespace {

/// A tetrahedron and a point that no cell uses, as a VTK file with keywords in this case, of words or of bytes.
std::string vtk(bool binary, bool lower_case, bool offsets) {
    std::string content = "# vtk DataFile Version 5.1\na title\n";
    const auto keywords = [&](std::string words) {
        for (char& c : words) {
            c = lower_case && c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        }
        content += words + '\n';
    };
    const auto put = [&]<class T>(std::initializer_list<T> numbers) {
        for (const T number : numbers) {
            std::array<char, sizeof(T)> raw{};
            std::memcpy(raw.data(), &number, sizeof(T));
            std::reverse(raw.begin(), raw.end()); // the highest byte first
            content += binary ? std::string(raw.data(), raw.size()) : text(number, ' ');
        }
        content += '\n';
    };
    keywords(binary ? "BINARY" : "ASCII");
    keywords("DATASET UNSTRUCTURED_GRID");
    keywords("POINTS 5 float");
    put({0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 9.F, 9.F, 9.F, 0.F, 2.F, 0.F, 0.F, 0.F, 1.F});
    if (offsets) {
        keywords("CELLS 2 4");
        keywords("OFFSETS vtktypeint64");
        put({std::int64_t(0), std::int64_t(4)});
        keywords("CONNECTIVITY vtktypeint64");
        put({std::int64_t(0), std::int64_t(1), std::int64_t(3), std::int64_t(4)});
    } else {
        keywords("CELLS 1 5");
        put({std::int32_t(4), std::int32_t(0), std::int32_t(1), std::int32_t(3), std::int32_t(4)});
    }
    keywords("CELL_TYPES 1");
    put({std::int32_t(10)});
    return content;
}

} // namespace

TEST_CASE("VTK: words and bytes, keywords in either case; each beginning of a file is refused") {
    for (const bool binary : {false, true}) {
        for (const bool lower_case : {false, true}) {
            for (const bool offsets : {false, true}) {
                const std::string good = vtk(binary, lower_case, offsets);
                const auto mesh = read("a.vtk", good).as_mesh<3, double, Tet4>();
                CHECK(mesh.nodes.col(2) == Vector<3, double>(0, 2, 0));
                CHECK(mesh.cells == Eigen::Vector4i(0, 1, 2, 3));
                for (std::size_t n = 0; n + 3 < good.size(); ++n) {
                    CHECK(refusal("a.vtk", good.substr(0, n)).find("no FileError") == std::string::npos);
                }
            }
        }
    }
}

TEST_CASE("Gmsh 1: nodes and elements under their old names") {
    const std::string good = "$NOD\n4\n7 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$ENDNOD\n$ELM\n2\n1 2 5 1 3 7 2 3\n"
                             "2 4 5 1 4 7 2 3 4\n$ENDELM\n";
    const auto mesh = read("a.msh", good).as_mesh<3, double, Tet4>();
    CHECK(mesh.n_nodes() == 4);
    CHECK(mesh.cells == Eigen::Vector4i(0, 1, 2, 3));
    std::string wrong = good;
    wrong.replace(wrong.find("2 4 5 1 4"), 9, "2 4 5 1 5");
    CHECK(refusal("a.msh", wrong) == ":11: expected 4 nodes, as tetrahedra have, found 5");
    CHECK(refusal("a.msh", good.substr(0, good.find("$ELM"))) == ": has no section $ELM");
}

TEST_CASE("TetGen: headers that leave out zeros; a number given twice is an error of the .node file") {
    const ScratchFolder folder;
    put(folder / "a.node", "4 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n");
    put(folder / "a.ele", "1 4\n0 0 1 2 3\n");
    CHECK(read_mesh(folder / "a.ele").points.cols() == 4);
    put(folder / "a.node", "4 3\n0 0 0 0\n1 1 0 0\n1 0 1 0\n3 0 0 1\n");
    const std::string message = file_error([&] { (void)read_mesh(folder / "a.ele"); });
    CHECK(message.ends_with("a.node:4: point 1 is there twice"));
}
