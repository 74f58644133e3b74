// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/io/detail/mesh_collector.hpp>
#include <springfit/io/detail/number_type.hpp>

namespace springfit::io::detail {

inline constexpr std::array<FileCell, 11> vtk_cells{{
    {1, 0, 1, "points", std::nullopt},
    {3, 1, 2, "lines", std::nullopt},
    {5, 2, 3, "triangles", CellKind::triangle},
    {9, 2, 4, "quadrilaterals", CellKind::quadrilateral},
    {10, 3, 4, "tetrahedra", CellKind::tetrahedron},
    {12, 3, 8, "hexahedra", CellKind::hexahedron},
    {13, 3, 6, "prisms", std::nullopt},
    {14, 3, 5, "pyramids", std::nullopt},
    {21, 1, 3, "quadratic lines", std::nullopt},
    {22, 2, 6, "quadratic triangles", CellKind::quadratic_triangle},
    {24, 3, 10, "quadratic tetrahedra", CellKind::quadratic_tetrahedron},
}};

/// The nodes of all cells in a row, and where each cell begins and the last one ends.
struct VtkCells {
    std::vector<long long> offsets{0};
    std::vector<long long> nodes;
};

/// Reads VTK's legacy files: POINTS, CELLS (with offsets from version 5 on), CELL_TYPES; keywords in any case; numbers
/// as words, or as bytes with the highest first.
class VtkReader {
public:
    explicit VtkReader(TextScanner& scanner) : m_scanner(scanner), m_collector(scanner) {}

    [[nodiscard]] MeshFile read() {
        read_header();
        for (;;) {
            const std::string section = lower_case(m_scanner.peek());
            if (section.empty() || section == "cell_data" || section == "point_data") {
                throw FileError(m_scanner.file(), "has no section CELL_TYPES");
            }
            (void)m_scanner.word("a section");
            if (section == "points") {
                read_points();
            } else if (section == "cells") {
                read_cells();
            } else if (section == "cell_types") {
                read_cell_types();
                return std::move(m_collector).finish();
            } else {
                m_scanner.skip_line(); // METADATA and the like
            }
        }
    }

private:
    void expect(const std::string& keyword) {
        const std::string_view found = m_scanner.word(keyword);
        if (lower_case(found) != lower_case(keyword)) {
            m_scanner.refuse(text("expected ", keyword, ", found ", found.substr(0, 40)));
        }
    }

    void read_header() {
        if (!lower_case(m_scanner.line()).starts_with("# vtk datafile")) {
            throw FileError(m_scanner.file(), 1, "expected # vtk DataFile: not a VTK legacy file");
        }
        (void)m_scanner.line(); // the title
        const std::string form(m_scanner.word("ASCII or BINARY"));
        m_is_binary = lower_case(form) == "binary";
        if (!m_is_binary && lower_case(form) != "ascii") {
            m_scanner.refuse(text("expected ASCII or BINARY, found ", form.substr(0, 40)));
        }
        expect("DATASET");
        expect("UNSTRUCTURED_GRID");
    }

    /// Bytes begin on the line after the text.
    void begin_numbers() {
        if (m_is_binary) {
            m_scanner.skip_line();
        }
    }

    /// The type of the numbers of this section, which follow.
    [[nodiscard]] NumberType read_type() {
        const std::string_view word = m_scanner.word("a type of number");
        const auto type = number_type(word);
        if (!type) {
            m_scanner.refuse(text("expected a type of number, found ", word.substr(0, 40)));
        }
        begin_numbers();
        return *type;
    }

    [[nodiscard]] long long whole(NumberType type, std::string_view expected) {
        return m_is_binary ? binary_whole(m_scanner, type, std::endian::big, expected) : m_scanner.whole(expected);
    }
    [[nodiscard]] long long count(NumberType type, std::string_view expected) {
        const long long n = whole(type, expected);
        if (n < 0) {
            m_scanner.refuse(text("expected ", expected, ", found ", n));
        }
        return n;
    }

    void read_points() {
        const long long n = m_scanner.count("the number of points");
        const NumberType type = read_type();
        m_collector.reserve_points(n);
        for (long long i = 0; i < n; ++i) {
            std::array<double, 3> point{};
            for (double& x : point) {
                x = m_is_binary ? binary_number(m_scanner, type, std::endian::big) : m_scanner.number("a coordinate");
            }
            m_collector.add_point(i, point);
        }
    }

    void read_cells() {
        const long long n = m_scanner.count("the number of cells");
        const long long size = m_scanner.count("the size of the list of cells");
        m_scanner.check_size(n, "cells");
        m_scanner.check_size(size, "numbers of nodes");
        begin_numbers();
        m_cells = {};
        if (lower_case((m_is_binary ? m_scanner.rest() : m_scanner.peek()).substr(0, 7)) == "offsets") {
            read_cells_by_offsets(n, size);
            return;
        }
        for (long long c = 0; c < n; ++c) {
            const long long n_nodes = count(NumberType::int32, "the number of nodes of a cell");
            m_scanner.check_size(n_nodes, "nodes of a cell");
            for (long long a = 0; a < n_nodes; ++a) {
                m_cells.nodes.push_back(whole(NumberType::int32, "the number of a node"));
            }
            m_cells.offsets.push_back(static_cast<long long>(m_cells.nodes.size()));
        }
    }

    void read_cells_by_offsets(long long n, long long size) {
        expect("OFFSETS");
        const NumberType offset_type = read_type();
        m_cells.offsets.clear();
        for (long long c = 0; c < n; ++c) {
            const long long offset = count(offset_type, "an offset");
            if (offset > size || (c > 0 && offset < m_cells.offsets.back())) {
                m_scanner.refuse(text("expected offsets that ascend to ", size, ", found ", offset));
            }
            m_cells.offsets.push_back(offset);
        }
        expect("CONNECTIVITY");
        const NumberType node_type = read_type();
        for (long long a = 0; a < size; ++a) {
            m_cells.nodes.push_back(whole(node_type, "the number of a node"));
        }
    }

    void read_cell_types() {
        const long long n = m_scanner.count("the number of cells");
        if (n + 1 > static_cast<long long>(m_cells.offsets.size())) {
            m_scanner.refuse(text("expected the types of ", std::max<std::size_t>(m_cells.offsets.size(), 1) - 1,
                                  " cells, found ", n));
        }
        begin_numbers();
        for (std::size_t c = 0; c < static_cast<std::size_t>(n); ++c) {
            const long long code = whole(NumberType::int32, "the type of a cell");
            const FileCell* type = find_cell(vtk_cells, code);
            if (type == nullptr) {
                m_scanner.refuse(text("cells of VTK's type ", code, " are not known"));
            }
            const auto n_nodes = m_cells.offsets[c + 1] - m_cells.offsets[c];
            if (n_nodes != type->n_nodes) {
                m_scanner.refuse(text("cell ", c, ", one of the ", type->plural, ", has ", n_nodes, " nodes"));
            }
            m_collector.add_cell(
                *type, std::span(m_cells.nodes)
                           .subspan(static_cast<std::size_t>(m_cells.offsets[c]), static_cast<std::size_t>(n_nodes)));
        }
    }

    TextScanner& m_scanner;
    MeshCollector m_collector;
    VtkCells m_cells;
    bool m_is_binary = false;
};

} // namespace springfit::io::detail
