// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <springfit/io/detail/number_type.hpp>
#include <springfit/io/detail/surface_collector.hpp>

namespace springfit::io::detail {

struct PlyProperty {
    std::string name;
    NumberType type;
    std::optional<NumberType> size; ///< of a list: the type of its number of entries
};

struct PlyElement {
    std::string name;
    long long n = 0;
    std::vector<PlyProperty> properties;
};

/// Reads a .ply file: a header that says which elements follow, and which properties each of them has.
class PlyReader {
public:
    explicit PlyReader(TextScanner& scanner) : m_scanner(scanner), m_collector(scanner) {}

    [[nodiscard]] SurfaceFile read() {
        read_header();
        bool has_vertices = false;
        for (const PlyElement& element : m_elements) {
            m_scanner.check_size(element.n, text("elements \"", element.name, '"'));
            if (element.name == "vertex") {
                require(!has_vertices, "one element \"vertex\", found two");
                has_vertices = true;
                read_vertices(element);
            } else if (element.name == "face") {
                read_faces(element);
            } else {
                for (long long i = 0; i < element.n; ++i) {
                    for (const PlyProperty& property : element.properties) {
                        skip(property);
                    }
                }
            }
        }
        return std::move(m_collector).finish();
    }

private:
    void require(bool accepted, std::string_view expected) const {
        if (!accepted) {
            m_scanner.refuse(text("expected ", expected));
        }
    }

    [[nodiscard]] NumberType read_type() {
        m_scanner.require_on_line("the type of a property");
        const std::string_view word = m_scanner.word("");
        const auto type = number_type(word);
        require(type.has_value(), text("a type of number, found \"", word.substr(0, 40), '"'));
        return *type;
    }

    void read_format() {
        m_scanner.require_on_line("ascii, binary_little_endian or binary_big_endian");
        const std::string format(m_scanner.word(""));
        m_is_text = format == "ascii";
        m_order = format == "binary_big_endian" ? std::endian::big : std::endian::little;
        require(m_is_text || format == "binary_little_endian" || format == "binary_big_endian",
                text("ascii, binary_little_endian or binary_big_endian, found \"", format.substr(0, 40), '"'));
    }

    void read_header() {
        require(m_scanner.word("ply") == "ply", "ply: not a PLY file");
        bool has_format = false;
        for (;;) {
            const std::string keyword(m_scanner.word("end_header"));
            if (keyword == "end_header") {
                break;
            }
            if (keyword == "format") {
                read_format();
                has_format = true;
            } else if (keyword == "element") {
                m_scanner.require_on_line("the name of an element");
                PlyElement& element = m_elements.emplace_back();
                element.name = m_scanner.word("");
                m_scanner.require_on_line(text("the number of elements \"", element.name, '"'));
                element.n = m_scanner.count(text("the number of elements \"", element.name, '"'));
            } else if (keyword == "property") {
                require(!m_elements.empty(), "an element before its first property");
                PlyProperty property{};
                m_scanner.require_on_line("the type of a property");
                if (m_scanner.peek() == "list") {
                    (void)m_scanner.word("list");
                    property.size = read_type();
                }
                property.type = read_type();
                m_scanner.require_on_line("the name of a property");
                property.name = m_scanner.word("");
                m_elements.back().properties.push_back(std::move(property));
            } else {
                require(keyword == "comment" || keyword == "obj_info",
                        text("format, element, property, comment or end_header, found \"", keyword.substr(0, 40), '"'));
            }
            m_scanner.skip_line();
        }
        require(has_format, "a line with the format before end_header");
        m_scanner.skip_line();
        if (!m_is_text) {
            m_scanner.begin_binary();
        }
    }

    [[nodiscard]] long long whole(NumberType type, std::string_view expected) {
        return m_is_text ? m_scanner.whole(expected) : binary_whole(m_scanner, type, m_order, expected);
    }

    [[nodiscard]] double coordinate(NumberType type) {
        return m_is_text ? m_scanner.any_number("a coordinate") : binary_number(m_scanner, type, m_order);
    }

    [[nodiscard]] long long read_size(const PlyProperty& list) {
        const long long n = whole(*list.size, "the size of a list");
        m_scanner.check_size(n, "entries of a list");
        return n;
    }

    void skip(const PlyProperty& property) {
        const long long n = property.size ? read_size(property) : 1;
        for (long long i = 0; i < n; ++i) {
            if (m_is_text) {
                (void)m_scanner.word("a number"); // whatever a writer makes of NaN
            } else {
                (void)binary_number(m_scanner, property.type, m_order);
            }
        }
    }

    void read_vertices(const PlyElement& element) {
        constexpr std::array<std::string_view, 3> names{"x", "y", "z"};
        const auto is_coordinate = [&](const PlyProperty& p, std::size_t d) { return !p.size && p.name == names[d]; };
        for (std::size_t d = 0; d < names.size(); ++d) {
            const auto n = std::count_if(element.properties.begin(), element.properties.end(),
                                         [&](const PlyProperty& p) { return is_coordinate(p, d); });
            require(n == 1, text("a property ", names[d], " of the element \"vertex\", found ", n));
        }
        for (long long i = 0; i < element.n; ++i) {
            std::array<double, 3> point{};
            for (const PlyProperty& property : element.properties) {
                std::size_t d = 0;
                while (d < names.size() && !is_coordinate(property, d)) {
                    ++d;
                }
                if (d == names.size()) {
                    skip(property);
                } else {
                    point[d] = coordinate(property.type);
                    check_coordinate(m_scanner, point[d]);
                }
            }
            m_collector.add_point(point);
        }
    }

    void read_faces(const PlyElement& element) {
        const auto is_corners = [](const PlyProperty& p) {
            return p.size && (p.name == "vertex_indices" || p.name == "vertex_index");
        };
        const auto n_lists = std::count_if(element.properties.begin(), element.properties.end(), is_corners);
        require(n_lists == 1, text("a list vertex_indices of the element \"face\", found ", n_lists));
        for (long long f = 0; f < element.n; ++f) {
            for (const PlyProperty& property : element.properties) {
                if (!is_corners(property)) {
                    skip(property);
                    continue;
                }
                const long long n = read_size(property);
                for (long long a = 0; a < n; ++a) {
                    m_collector.add_corner(whole(property.type, "the number of a vertex"));
                }
                m_collector.add_polygon();
            }
        }
    }

    TextScanner& m_scanner;
    SurfaceCollector m_collector;
    std::vector<PlyElement> m_elements;
    bool m_is_text = true;
    std::endian m_order = std::endian::little;
};

} // namespace springfit::io::detail
