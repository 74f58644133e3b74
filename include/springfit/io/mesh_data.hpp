// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <springfit/io/cell_kind.hpp>

namespace springfit::io {

/// All cells of one kind in a mesh file.
struct CellBlock {
    CellKind kind;
    Eigen::MatrixXi cells; ///< node numbers in the order of the cell type [nodes per cell x n_cells]
};

/// A mesh as a file holds it: its points, and those of its cells that have the highest dimension.
struct MeshFile {
    std::string file;
    Points<3, double> points;       ///< [3 x n_points], as in the file; z = 0 where it is flat
    std::vector<CellBlock> blocks;  ///< one for each kind of cell, most cells first
    std::vector<std::string> notes; ///< what was left out or turned round, in words: "left out: 24 triangles, 8 lines"

    /// 3 for a volume, 2 for a surface or a flat mesh.
    [[nodiscard]] int cell_dimension() const { return dimension(blocks.front().kind); }
    /// True where all points have the same z, to 1e-9 of the size of the mesh.
    [[nodiscard]] bool is_flat() const {
        const Vector<3, double> size = points.rowwise().maxCoeff() - points.rowwise().minCoeff();
        return size(2) <= 1e-9 * size.maxCoeff();
    }

    /// The mesh, where all its cells are of this type. Points that no cell uses are dropped, the others keep their
    /// order. Throws FileError for other or mixed cells, for a surface where a volume is needed, and in the plane for
    /// points that do not have the same z.
    template <int Dim, std::floating_point Scalar, CellType Cell>
    [[nodiscard]] Mesh<Dim, Scalar, Cell> as_mesh() const;
};

namespace detail {

[[nodiscard]] inline std::string kinds_in_words(const std::vector<CellBlock>& blocks) {
    std::string words;
    for (const CellBlock& block : blocks) {
        words += text(words.empty() ? "" : ", ", block.cells.cols(), " cells of kind ", name(block.kind));
    }
    return words;
}

} // namespace detail

template <int Dim, std::floating_point Scalar, CellType Cell>
Mesh<Dim, Scalar, Cell> MeshFile::as_mesh() const {
    if (blocks.size() != 1 || blocks.front().kind != cell_kind<Cell>()) {
        const bool surface = cell_dimension() < Cell::dimension;
        throw FileError(file,
                        text(surface ? "holds a surface where a volume is needed: " : "", "expected cells of kind ",
                             Cell::name, " only, found ", detail::kinds_in_words(blocks)));
    }
    const Eigen::MatrixXi& cells = blocks.front().cells;
    std::vector<int> new_number(static_cast<std::size_t>(points.cols()), -1);
    for (Index i = 0; i < cells.size(); ++i) {
        new_number[static_cast<std::size_t>(cells(i))] = 0;
    }
    int n_used = 0;
    for (int& number : new_number) {
        number = number < 0 ? -1 : n_used++;
    }
    Mesh<Dim, Scalar, Cell> mesh;
    mesh.nodes.resize(Dim, n_used);
    if (Dim == 2 && !is_flat()) {
        throw FileError(file, text("is not flat: z from ", points.row(2).minCoeff(), " to ", points.row(2).maxCoeff()));
    }
    for (Index i = 0; i < points.cols(); ++i) {
        const int number = new_number[static_cast<std::size_t>(i)];
        if (number >= 0) {
            mesh.nodes.col(number) = points.col(i).head<Dim>().template cast<Scalar>();
        }
    }
    mesh.cells = cells.unaryExpr([&](int node) { return new_number[static_cast<std::size_t>(node)]; });
    return mesh;
}

} // namespace springfit::io
