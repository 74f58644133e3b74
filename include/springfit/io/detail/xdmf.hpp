// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <charconv>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <springfit/io/cell_kind.hpp>
#include <springfit/io/detail/file_reference.hpp>
#include <springfit/io/detail/read_text.hpp>

namespace springfit::io::detail {

inline constexpr std::array<std::pair<char, std::string_view>, 5> xml_entities{
    {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&apos;"}}};

[[nodiscard]] inline std::string xml_escaped(std::string_view plain) {
    std::string result;
    for (const char c : plain) {
        const auto* entity =
            std::find_if(xml_entities.begin(), xml_entities.end(), [c](const auto& e) { return e.first == c; });
        entity == xml_entities.end() ? result += c : result += entity->second;
    }
    return result;
}

[[nodiscard]] inline std::string xml_unescaped(std::string_view escaped) {
    std::string result;
    while (!escaped.empty()) {
        const auto* entity = std::find_if(xml_entities.begin(), xml_entities.end(),
                                          [&](const auto& e) { return escaped.starts_with(e.second); });
        result += entity == xml_entities.end() ? escaped.front() : entity->first;
        escaped.remove_prefix(entity == xml_entities.end() ? 1 : entity->second.size());
    }
    return result;
}

/// XDMF's name of a linear cell.
[[nodiscard]] inline std::string_view xdmf_topology(CellKind kind) {
    switch (kind) {
    case CellKind::triangle: return "Triangle";
    case CellKind::quadrilateral: return "Quadrilateral";
    case CellKind::tetrahedron: return "Tetrahedron";
    case CellKind::hexahedron: return "Hexahedron";
    default: break;
    }
    throw InvalidArgument("cells", "a linear kind of cell", name(kind));
}

/// `/reference/displacement` as it is called in ParaView: `reference_displacement`.
[[nodiscard]] inline std::string attribute_name(const std::string& dataset) {
    std::string result = dataset.substr(1);
    std::replace(result.begin(), result.end(), '/', '_');
    return result;
}

/// The view of one frame of a dataset by itself, with three components: not every reader of XDMF takes a slice of an
/// array, or vectors of two components.
[[nodiscard]] inline std::string frame_view(const std::string& dataset, std::size_t frame) {
    return text("/frames/", frame, '/', attribute_name(dataset));
}

/// The XDMF file of a motion, as far as it describes its HDF5 file.
struct XdmfMotion {
    std::string h5_name; ///< relative to the XDMF file
    int dimension;
    Index n_nodes;
    std::optional<CellKind> kind;
    Index n_cells;
    Index n_springs;
    std::vector<double> times;
    std::vector<std::string> vectors; ///< datasets [T x n x Dim], "/reference/displacement"
};

/// The shortest text that reads back as the same double.
[[nodiscard]] inline std::string shortest(double value) {
    std::array<char, 32> digits{};
    return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

/// Two animations over the same nodes at rest, the mesh and the springs, with one set of vectors per frame.
[[nodiscard]] inline std::string xdmf_text(const XdmfMotion& motion) {
    const std::string h5 = xml_escaped(motion.h5_name);
    const auto item = [&](std::string_view dataset, const std::string& dimensions, std::string_view number) {
        return text("<DataItem Format=\"HDF\" ", number, " Dimensions=\"", dimensions, "\">", h5, ":", dataset,
                    "</DataItem>");
    };
    constexpr std::string_view float64 = "NumberType=\"Float\" Precision=\"8\"";
    constexpr std::string_view int32 = "NumberType=\"Int\" Precision=\"4\"";
    const std::string points = text(motion.n_nodes, ' ', motion.dimension);
    const std::string geometry = text("<Geometry GeometryType=\"", motion.dimension == 2 ? "XY" : "XYZ", "\">",
                                      item("/mesh/points", points, float64), "</Geometry>\n");

    std::string result = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n";
    const auto append_grid = [&](std::string_view name, const std::string& topology) {
        result += text("<Grid Name=\"", name, "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
        for (std::size_t t = 0; t < motion.times.size(); ++t) {
            result += text("<Grid Name=\"", name, "\" GridType=\"Uniform\">\n<Time Value=\"", shortest(motion.times[t]),
                           "\"/>\n", topology, geometry);
            for (const std::string& dataset : motion.vectors) {
                result +=
                    text("<Attribute Name=\"", attribute_name(dataset), "\" AttributeType=\"Vector\" Center=\"Node\">",
                         item(frame_view(dataset, t), text(motion.n_nodes, " 3"), float64), "</Attribute>\n");
            }
            result += "</Grid>\n";
        }
        result += "</Grid>\n";
    };
    if (motion.kind) {
        append_grid("mesh", text("<Topology TopologyType=\"", xdmf_topology(*motion.kind), "\" NumberOfElements=\"",
                                 motion.n_cells, "\">",
                                 item("/mesh/cells", text(motion.n_cells, ' ', n_corners(*motion.kind)), int32),
                                 "</Topology>\n"));
    }
    if (motion.n_springs > 0) {
        append_grid("springs", text("<Topology TopologyType=\"Polyline\" NodesPerElement=\"2\" NumberOfElements=\"",
                                    motion.n_springs, "\">", item("/springs", text(motion.n_springs, " 2"), int32),
                                    "</Topology>\n"));
    }
    return result + "</Domain>\n</Xdmf>\n";
}

/// The HDF5 file that an XDMF file of any program points to, and the kind of cells that it names, if one that is known.
struct XdmfTarget {
    std::filesystem::path h5;
    std::optional<CellKind> kind;
};

/// Calls `visit(file, dataset)` for every text between two tags of the form `file.h5:/dataset`.
template <class Visit>
void for_each_reference(const std::string& content, const Visit& visit) {
    for (auto begin = content.find('>'); begin != std::string::npos; begin = content.find('>', begin + 1)) {
        const auto end = content.find_first_of("<>", begin + 1);
        if (end == std::string::npos || content[end] == '>') {
            continue;
        }
        const std::string_view item(content.data() + begin + 1, end - begin - 1);
        const auto colon = item.find(":/");
        const auto first = item.find_first_not_of(" \t\r\n");
        if (colon != std::string_view::npos && colon != first) {
            visit(xml_unescaped(item.substr(first, colon - first)), item.substr(colon + 1));
        }
    }
}

[[nodiscard]] inline XdmfTarget follow_xdmf(const std::filesystem::path& path, const std::string& content) {
    std::set<std::string> files;
    std::set<std::string> reference_files;
    for_each_reference(content, [&](const std::string& file, std::string_view dataset) {
        files.insert(file);
        if (dataset.starts_with("/reference/")) {
            reference_files.insert(file);
        }
    });
    const auto& candidates = reference_files.empty() ? files : reference_files;
    if (candidates.empty()) {
        throw FileError(path.string(), "points to no HDF5 file");
    }
    if (candidates.size() != 1) {
        std::string names;
        for (auto name = candidates.begin(); name != candidates.end() && names.size() < 200; ++name) {
            names += (names.empty() ? ": " : ", ") + *name;
        }
        throw FileError(path.string(), text("points to ", candidates.size(), " HDF5 files", names));
    }
    if (!stays_below(*candidates.begin())) {
        throw FileError(path.string(), text("points to ", *candidates.begin(),
                                            "; only files in the same folder or below it are read"));
    }
    XdmfTarget target{path.parent_path() / *candidates.begin(), std::nullopt};
    for (const CellKind kind : cell_kinds) {
        if (n_corners(kind) == n_nodes(kind) &&
            content.find(text("Type=\"", xdmf_topology(kind), '"')) != std::string::npos) {
            target.kind = kind;
        }
    }
    return target;
}

} // namespace springfit::io::detail
