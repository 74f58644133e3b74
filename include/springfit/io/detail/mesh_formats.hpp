// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/io/detail/mesh_collector.hpp>
#include <springfit/io/detail/read_text.hpp>

namespace springfit::io::detail {

// MEDIT: words that open a section, numbers from 1, a label behind each point and cell.

inline constexpr std::array<FileCell, 7> medit_cells{{
    {2, 1, 2, "lines", std::nullopt},
    {3, 2, 3, "triangles", CellKind::triangle},
    {4, 2, 4, "quadrilaterals", CellKind::quadrilateral},
    {5, 3, 4, "tetrahedra", CellKind::tetrahedron},
    {6, 3, 8, "hexahedra", CellKind::hexahedron},
    {7, 3, 6, "prisms", std::nullopt},
    {8, 3, 5, "pyramids", std::nullopt},
}};

[[nodiscard]] inline MeshFile read_medit(TextScanner& scanner) {
    constexpr std::array<std::pair<std::string_view, int>, 7> sections{{{"Edges", 2},
                                                                        {"Triangles", 3},
                                                                        {"Quadrilaterals", 4},
                                                                        {"Tetrahedra", 5},
                                                                        {"Hexahedra", 6},
                                                                        {"Prisms", 7},
                                                                        {"Pyramids", 8}}};
    if (!scanner.peek().starts_with("MeshVersion")) {
        scanner.refuse("expected MeshVersionFormatted: not a MEDIT mesh in text form");
    }
    MeshCollector collector(scanner);
    long long dimension = 3;
    std::vector<long long> nodes;
    for (;;) {
        const std::string section(scanner.peek());
        if (section.empty() || section == "End") {
            break;
        }
        (void)scanner.word("a section");
        const auto cells =
            std::find_if(sections.begin(), sections.end(), [&](const auto& s) { return s.first == section; });
        if (section == "Dimension") {
            dimension = scanner.count("the dimension");
            if (dimension != 2 && dimension != 3) {
                scanner.refuse(text("expected dimension 2 or 3, found ", dimension));
            }
        } else if (section == "Vertices") {
            const long long n = scanner.count("the number of vertices");
            collector.reserve_points(n);
            for (long long i = 1; i <= n; ++i) {
                std::array<double, 3> position{};
                for (long long d = 0; d < dimension; ++d) {
                    position[static_cast<std::size_t>(d)] = scanner.number("a coordinate");
                }
                collector.add_point(i, position);
                (void)scanner.whole("the label of a vertex");
            }
        } else if (cells != sections.end()) {
            const FileCell& type = *find_cell(medit_cells, cells->second);
            const long long n = scanner.count("the number of cells");
            for (long long i = 0; i < n; ++i) {
                nodes.clear();
                for (int a = 0; a < type.n_nodes; ++a) {
                    nodes.push_back(scanner.whole("the number of a vertex"));
                }
                (void)scanner.whole("the label of a cell");
                collector.add_cell(type, nodes);
            }
        } else {
            while (scanner.next_is_number()) { // a section of no concern here
                (void)scanner.word("a number");
            }
        }
    }
    return std::move(collector).finish();
}

// TetGen and Triangle: two files, numbers from 0 or 1 as the first point says. The nodes on edges come in an order of
// their own; only corners are taken.

inline constexpr std::array<FileCell, 4> tetgen_cells{{
    {203, 2, 3, "triangles", CellKind::triangle},
    {206, 2, 6, "quadratic triangles", CellKind::triangle},
    {304, 3, 4, "tetrahedra", CellKind::tetrahedron},
    {310, 3, 10, "quadratic tetrahedra", CellKind::tetrahedron},
}};

/// A number that a header may leave out, where it is 0.
[[nodiscard]] inline long long tetgen_count(TextScanner& scanner, std::string_view expected) {
    return scanner.at_line_end() ? 0 : scanner.count(expected);
}

[[nodiscard]] inline MeshFile read_tetgen(const std::filesystem::path& path) {
    auto node_path = path;
    auto cell_path = path;
    node_path.replace_extension(".node");
    cell_path.replace_extension(".ele");
    TextScanner points(node_path.string(), read_text(node_path), {.comment = '#'});
    TextScanner cells(cell_path.string(), read_text(cell_path), {.comment = '#'});

    const long long n_points = points.count("the number of points");
    const long long dimension = points.count("the dimension");
    const long long n_attributes = tetgen_count(points, "the number of attributes");
    const long long attributes = n_attributes + tetgen_count(points, "the number of markers");
    if (dimension != 2 && dimension != 3) {
        points.refuse(text("expected dimension 2 or 3, found ", dimension));
    }
    MeshCollector collector(cells);
    points.check_size(n_points, "points");
    points.check_size(attributes, "attributes");
    for (long long i = 0; i < n_points; ++i) {
        const long long number = points.whole("the number of a point");
        std::array<double, 3> position{};
        for (long long d = 0; d < dimension; ++d) {
            position[static_cast<std::size_t>(d)] = points.number("a coordinate");
        }
        for (long long a = 0; a < attributes; ++a) {
            (void)points.number("an attribute");
        }
        collector.add_point(number, position, points);
    }
    const long long n_cells = cells.count("the number of cells");
    const long long n_nodes = cells.count("the number of nodes of a cell");
    const long long cell_attributes = tetgen_count(cells, "the number of attributes");
    const FileCell* type = find_cell(tetgen_cells, 100 * dimension + n_nodes);
    if (type == nullptr) {
        cells.refuse(text("cells of ", n_nodes, " nodes in dimension ", dimension, " are not known"));
    }
    std::vector<long long> nodes(static_cast<std::size_t>(n_nodes));
    for (long long c = 0; c < n_cells; ++c) {
        (void)cells.whole("the number of a cell");
        for (long long& node : nodes) {
            node = cells.whole("the number of a point");
        }
        for (long long a = 0; a < cell_attributes; ++a) {
            (void)cells.number("an attribute");
        }
        collector.add_cell(*type, nodes);
    }
    MeshFile mesh = std::move(collector).finish();
    if (type->n_nodes != io::n_nodes(*type->kind)) {
        mesh.notes.push_back("left out: the nodes on edges");
    }
    return mesh;
}

} // namespace springfit::io::detail
