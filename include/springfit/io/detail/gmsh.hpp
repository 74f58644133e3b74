// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <springfit/io/detail/mesh_collector.hpp>

namespace springfit::io::detail {

/// Gmsh's types of cell. Its quadratic tetrahedron has the nodes on edges 4 and 5 exchanged.
inline constexpr std::array<FileCell, 19> gmsh_cells{{
    {15, 0, 1, "points", std::nullopt},
    {1, 1, 2, "lines", std::nullopt},
    {8, 1, 3, "quadratic lines", std::nullopt},
    {2, 2, 3, "triangles", CellKind::triangle},
    {3, 2, 4, "quadrilaterals", CellKind::quadrilateral},
    {9, 2, 6, "quadratic triangles", CellKind::quadratic_triangle},
    {10, 2, 9, "quadrilaterals of 9 nodes", std::nullopt},
    {16, 2, 8, "quadrilaterals of 8 nodes", std::nullopt},
    {4, 3, 4, "tetrahedra", CellKind::tetrahedron},
    {5, 3, 8, "hexahedra", CellKind::hexahedron},
    {6, 3, 6, "prisms", std::nullopt},
    {7, 3, 5, "pyramids", std::nullopt},
    {11, 3, 10, "quadratic tetrahedra", CellKind::quadratic_tetrahedron, {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}},
    {12, 3, 27, "hexahedra of 27 nodes", std::nullopt},
    {13, 3, 18, "prisms of 18 nodes", std::nullopt},
    {14, 3, 14, "pyramids of 14 nodes", std::nullopt},
    {17, 3, 20, "hexahedra of 20 nodes", std::nullopt},
    {18, 3, 15, "prisms of 15 nodes", std::nullopt},
    {19, 3, 13, "pyramids of 13 nodes", std::nullopt},
}};

/// Reads the numbers of a .msh file, which are words or bytes.
class GmshReader {
public:
    explicit GmshReader(TextScanner& scanner) : m_scanner(scanner), m_collector(scanner) {}

    [[nodiscard]] MeshFile read() {
        read_format();
        bool nodes = false;
        bool elements = false;
        for (;;) {
            while (!m_scanner.peek().empty() && !m_scanner.peek().starts_with('$')) {
                m_scanner.skip_line();
            }
            if (m_scanner.peek().empty()) {
                break;
            }
            const std::string section(m_scanner.word("a section"));
            if (section == (m_version == 1 ? "$NOD" : "$Nodes")) {
                m_version < 4 ? read_nodes_2() : read_nodes_4();
                nodes = true;
            } else if (section == "$ParametricNodes") {
                m_scanner.refuse("$ParametricNodes; save the mesh without parametric coordinates");
            } else if (section == (m_version == 1 ? "$ELM" : "$Elements")) {
                if (!nodes) {
                    m_scanner.refuse(text(section, " before ", m_version == 1 ? "$NOD" : "$Nodes"));
                }
                m_version == 1 ? read_elements_1() : m_version == 2 ? read_elements_2() : read_elements_4();
                elements = true;
            }
            m_scanner.skip_past((m_version == 1 ? "$END" : "$End") + section.substr(1));
        }
        if (!elements) {
            const bool is_1 = m_version == 1;
            throw FileError(m_scanner.file(), text("has no section ",
                                                   nodes ? (is_1 ? "$ELM" : "$Elements") : (is_1 ? "$NOD" : "$Nodes")));
        }
        return std::move(m_collector).finish();
    }

private:
    void read_format() {
        if (m_scanner.peek() == "$NOD") {
            m_version = 1; // which has no section on its format
            return;
        }
        if (m_scanner.peek() != "$MeshFormat") {
            m_scanner.refuse("expected $MeshFormat, or $NOD of version 1: not a Gmsh file");
        }
        m_scanner.skip_line();
        const std::string version(m_scanner.word("the version"));
        const bool is_2 = version == "2" || version.starts_with("2.");
        if (!is_2 && version != "4.1") {
            m_scanner.refuse(text("Gmsh version ", version, "; save it as version 4.1 or 2.2"));
        }
        m_version = is_2 ? 2 : 4;
        m_binary = m_scanner.count("0 for text, 1 for binary") == 1;
        if (m_scanner.count("the size of numbers") != 8) {
            m_scanner.refuse("expected numbers of 8 bytes");
        }
        m_scanner.skip_line();
        if (m_binary && m_scanner.bytes<std::int32_t>() != 1) {
            m_scanner.refuse("binary numbers in the byte order of another machine");
        }
        m_scanner.skip_past("$EndMeshFormat");
    }

    [[nodiscard]] double number() { return m_binary ? m_scanner.bytes<double>() : m_scanner.number("a coordinate"); }
    [[nodiscard]] long long small(std::string_view expected) {
        return m_binary ? m_scanner.bytes<std::int32_t>() : m_scanner.whole(expected);
    }
    [[nodiscard]] long long large(std::string_view expected) {
        return m_binary ? static_cast<long long>(m_scanner.bytes<std::uint64_t>()) : m_scanner.whole(expected);
    }
    [[nodiscard]] std::array<double, 3> position() {
        const double x = number();
        const double y = number();
        return {x, y, number()};
    }
    [[nodiscard]] const FileCell& cell_type(long long code) {
        const FileCell* type = find_cell(gmsh_cells, code);
        if (type == nullptr) {
            m_scanner.refuse(text("cells of Gmsh's type ", code, " are not known"));
        }
        return *type;
    }

    void read_nodes_2() {
        const long long n = m_scanner.count("the number of nodes");
        m_scanner.skip_line();
        m_collector.reserve_points(n);
        for (long long i = 0; i < n; ++i) {
            const long long tag = small("the number of a node");
            m_collector.add_point(tag, position());
        }
    }

    void read_elements_1() {
        const long long n = m_scanner.count("the number of elements");
        std::vector<long long> nodes;
        for (long long read = 0; read < n; ++read) {
            (void)small("the number of an element");
            const FileCell& type = cell_type(small("the type of an element"));
            const long long region = small("the number of a physical group");
            (void)small("the number of an entity");
            if (const long long n_nodes = small("the number of nodes"); n_nodes != type.n_nodes) {
                m_scanner.refuse(text("expected ", type.n_nodes, " nodes, as ", type.plural, " have, found ", n_nodes));
            }
            nodes.clear();
            for (int a = 0; a < type.n_nodes; ++a) {
                nodes.push_back(small("the number of a node"));
            }
            m_collector.add_cell(type, nodes, region);
        }
    }

    void read_elements_2() {
        const long long n = m_scanner.count("the number of elements");
        m_scanner.skip_line();
        std::vector<long long> nodes;
        for (long long read = 0; read < n;) {
            if (!m_binary) {
                (void)small("the number of an element");
            }
            const FileCell& type = cell_type(small("the type of an element"));
            const long long in_block = m_binary ? small("") : 1;
            const long long tags = small("the number of tags");
            if (in_block < 1 || in_block > n - read || tags < 0) {
                m_scanner.refuse("a block of elements of impossible size");
            }
            for (long long i = 0; i < in_block; ++i, ++read) {
                if (m_binary) {
                    (void)small("");
                }
                long long region = 0; // the first tag: the physical group
                for (long long tag = 0; tag < tags; ++tag) {
                    const long long value = small("a tag");
                    region = tag == 0 ? value : region;
                }
                nodes.clear();
                for (int a = 0; a < type.n_nodes; ++a) {
                    nodes.push_back(small("the number of a node"));
                }
                m_collector.add_cell(type, nodes, region);
            }
        }
    }

    void read_nodes_4() {
        m_scanner.skip_line();
        const long long blocks = large("the number of blocks");
        m_collector.reserve_points(large("the number of nodes"));
        (void)large("the lowest number");
        (void)large("the highest number");
        std::vector<long long> tags;
        for (long long block = 0; block < blocks; ++block) {
            const long long dimension = small("a dimension");
            (void)small("the number of an entity");
            const bool parametric = small("0 or 1") != 0;
            const long long n = large("the number of nodes");
            m_scanner.check_size(n, "nodes");
            tags.clear();
            for (long long i = 0; i < n; ++i) {
                tags.push_back(large("the number of a node"));
            }
            for (const long long tag : tags) {
                m_collector.add_point(tag, position());
                for (long long parameter = 0; parametric && parameter < dimension; ++parameter) {
                    (void)number();
                }
            }
        }
    }

    void read_elements_4() {
        m_scanner.skip_line();
        const long long blocks = large("the number of blocks");
        (void)large("the number of elements");
        (void)large("the lowest number");
        (void)large("the highest number");
        std::vector<long long> nodes;
        for (long long block = 0; block < blocks; ++block) {
            (void)small("a dimension");
            const long long entity = small("the number of an entity");
            const FileCell& type = cell_type(small("the type of an element"));
            const long long n = large("the number of elements");
            m_scanner.check_size(n, "elements");
            for (long long i = 0; i < n; ++i) {
                (void)large("the number of an element");
                nodes.clear();
                for (int a = 0; a < type.n_nodes; ++a) {
                    nodes.push_back(large("the number of a node"));
                }
                m_collector.add_cell(type, nodes, entity);
            }
        }
    }

    TextScanner& m_scanner;
    MeshCollector m_collector;
    int m_version = 0;
    bool m_binary = false;
};

} // namespace springfit::io::detail
