// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>

#include <springfit/io/detail/text_scanner.hpp>
#include <springfit/io/mesh_data.hpp>
#include <springfit/mesh/simplex.hpp>

namespace springfit::io::detail {

/// A type of cell that files know, with the kind that it becomes here, if any.
struct FileCell {
    int code; ///< its number in the format
    int dimension;
    int n_nodes;
    const char* plural;
    std::optional<CellKind> kind;
    std::array<int, 10> order{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}; ///< node a of the cell is node order[a] of the file's
};

template <std::size_t N>
[[nodiscard]] const FileCell* find_cell(const std::array<FileCell, N>& cells, long long code) {
    const auto cell = std::find_if(cells.begin(), cells.end(), [code](const FileCell& c) { return c.code == code; });
    return cell == cells.end() ? nullptr : &*cell;
}

/// Gathers points and cells in the order of a file, then sorts out what is to be kept.
class MeshCollector {
public:
    explicit MeshCollector(TextScanner& scanner) : m_scanner(&scanner) {}

    void reserve_points(long long n) {
        m_scanner->check_size(n, "points");
        m_points.reserve(static_cast<std::size_t>(n));
        m_numbers.reserve(static_cast<std::size_t>(n));
    }

    void add_point(long long number, const std::array<double, 3>& position) { add_point(number, position, *m_scanner); }

    /// A point that comes from another file than the cells do.
    void add_point(long long number, const std::array<double, 3>& position, const TextScanner& scanner) {
        if (!m_numbers.emplace(number, static_cast<int>(m_points.size())).second) {
            scanner.refuse(text("point ", number, " is there twice"));
        }
        for (const double coordinate : position) {
            if (!std::isfinite(coordinate)) {
                scanner.refuse(text("point ", number, " is not finite"));
            }
        }
        m_points.push_back(position);
    }

    /// `region`: the number of the part of the body that the cell is in, as far as the format knows such parts.
    void add_cell(const FileCell& type, std::span<const long long> point_numbers, long long region = 0) {
        auto block = std::find_if(m_blocks.begin(), m_blocks.end(), [&](const Block& b) { return b.type == &type; });
        if (block == m_blocks.end()) {
            block = m_blocks.insert(block, Block{&type, {}, 0, {}});
        }
        ++block->n_cells;
        ++block->in_region[region];
        if (!type.kind) {
            return;
        }
        for (int a = 0; a < n_nodes(*type.kind); ++a) {
            const long long number = point_numbers[static_cast<std::size_t>(type.order[static_cast<std::size_t>(a)])];
            const auto found = m_numbers.find(number);
            if (found == m_numbers.end()) {
                m_scanner->refuse(text("a cell names point ", number, ", which the file does not have"));
            }
            block->nodes.push_back(found->second);
        }
    }

    [[nodiscard]] MeshFile finish() &&;

private:
    struct Block {
        const FileCell* type;
        std::vector<int> nodes;
        long long n_cells;
        std::map<long long, long long> in_region; ///< cells of each region
    };
    static double orientation(const MeshFile& mesh, const CellBlock& block, Index cell);
    static void turn(MeshFile& mesh, CellBlock& block);

    TextScanner* m_scanner;
    std::vector<std::array<double, 3>> m_points;
    std::unordered_map<long long, int> m_numbers;
    std::vector<Block> m_blocks;
};

/// A number whose sign is that of the cell's volume, or of its area in the plane, at its first corner.
inline double MeshCollector::orientation(const MeshFile& mesh, const CellBlock& block, Index cell) {
    const auto side = [&](int a) -> Vector<3, double> {
        return mesh.points.col(block.cells(a, cell)) - mesh.points.col(block.cells(0, cell));
    };
    const int last = n_corners(block.kind) - 1;
    std::array<Vector<3, double>, 3> sides{side(1), side(last), {0, 0, 1}}; // in the plane
    if (dimension(block.kind) == 3) {
        const bool hexahedron = block.kind == CellKind::hexahedron;
        sides = {side(1), side(hexahedron ? 3 : 2), side(hexahedron ? 4 : 3)};
    }
    std::array<Vector<3, double>, 3> gradient;
    return springfit::detail::spanned_volume<3>(sides, gradient);
}

/// Renumbers cells that are all inside out or, in the plane, clockwise: a convention of the writer.
inline void MeshCollector::turn(MeshFile& mesh, CellBlock& block) {
    for (Index c = 0; c < block.cells.cols(); ++c) {
        if (!(orientation(mesh, block, c) < 0)) {
            return;
        }
    }
    const auto order = [&]() -> std::vector<int> {
        switch (block.kind) {
        case CellKind::triangle: return {0, 2, 1};
        case CellKind::quadratic_triangle: return {0, 2, 1, 5, 4, 3};
        case CellKind::quadrilateral: return {0, 3, 2, 1};
        case CellKind::tetrahedron: return {0, 2, 1, 3};
        case CellKind::quadratic_tetrahedron: return {0, 2, 1, 3, 6, 5, 4, 7, 9, 8};
        case CellKind::hexahedron: break;
        }
        return {0, 3, 2, 1, 4, 7, 6, 5};
    }();
    block.cells = Eigen::MatrixXi(block.cells(order, Eigen::all));
    mesh.notes.push_back(text("turned round: all cells of kind ", name(block.kind)));
}

inline MeshFile MeshCollector::finish() && {
    int highest = 0;
    for (const Block& block : m_blocks) {
        highest = std::max(highest, block.type->dimension);
    }
    if (highest < 2) {
        throw FileError(m_scanner->file(),
                        m_points.empty() ? "holds no points" : "holds no cells but points and lines");
    }
    MeshFile mesh;
    mesh.file = m_scanner->file();
    mesh.points.resize(3, static_cast<Index>(m_points.size()));
    for (std::size_t i = 0; i < m_points.size(); ++i) {
        mesh.points.col(static_cast<Index>(i)) << m_points[i][0], m_points[i][1], m_points[i][2];
    }
    std::string left_out;
    std::map<long long, long long> regions;
    for (const Block& block : m_blocks) {
        for (const auto& [region, n_cells] : block.in_region) {
            regions[region] += block.type->dimension == highest ? n_cells : 0;
        }
        if (block.type->dimension < highest) {
            left_out += text(left_out.empty() ? "left out: " : ", ", block.n_cells, ' ', block.type->plural);
            continue;
        }
        if (!block.type->kind) {
            throw FileError(mesh.file, text("holds ", block.n_cells, ' ', block.type->plural,
                                            ", for which springfit has no kind of cell"));
        }
        // Types of the format that become the same kind here go together.
        const CellKind kind = *block.type->kind;
        const Index rows = n_nodes(kind);
        const Eigen::Map<const Eigen::MatrixXi> cells(block.nodes.data(), rows, block.n_cells);
        auto same = std::find_if(mesh.blocks.begin(), mesh.blocks.end(), [&](const auto& b) { return b.kind == kind; });
        if (same == mesh.blocks.end()) {
            same = mesh.blocks.insert(same, {kind, Eigen::MatrixXi(rows, 0)});
        }
        const Index before = same->cells.cols();
        same->cells.conservativeResize(rows, before + cells.cols());
        same->cells.rightCols(cells.cols()) = cells;
    }
    std::stable_sort(mesh.blocks.begin(), mesh.blocks.end(),
                     [](const CellBlock& a, const CellBlock& b) { return a.cells.cols() > b.cells.cols(); });
    if (!left_out.empty()) {
        mesh.notes.push_back(left_out);
    }
    std::erase_if(regions, [](const auto& region) { return region.second == 0; });
    if (regions.size() > 1) {
        std::string list;
        for (const auto& [region, n_cells] : regions) {
            list += text(list.empty() ? "" : ", ", "region ", region, " of ", n_cells, " cells");
        }
        mesh.notes.push_back(text("one material for all of ", regions.size(), " regions: ", list));
    }
    if (highest == 3 || mesh.is_flat()) {
        for (CellBlock& block : mesh.blocks) {
            turn(mesh, block);
        }
    }
    return mesh;
}

} // namespace springfit::io::detail
