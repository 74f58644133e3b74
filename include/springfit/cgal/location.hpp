// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <springfit/cgal/detail/cell_boxes.hpp>
#include <springfit/cgal/detail/invert_cell.hpp>
#include <springfit/mesh/topology.hpp>

namespace springfit::cgal {

/// A cell that holds a point.
template <std::floating_point Scalar, CellType Cell>
struct CellPlace {
    int cell = -1;
    /// Shape functions at the point `[Cell::n_nodes]`, which sum to 1: barycentric coordinates in linear simplices.
    Eigen::Matrix<Scalar, Cell::n_nodes, 1> weights;
};

/// The point of a mesh's surface nearest to some point.
template <int Dim, std::floating_point Scalar>
struct SurfacePlace {
    int cell = -1;
    int facet = -1;                                            ///< number in `Cell::facets`; -1 on a membrane
    Eigen::Matrix<int, Eigen::Dynamic, 1, 0, 4, 1> nodes;      ///< corners of the facet, or of the membrane's cell
    Eigen::Matrix<Scalar, Eigen::Dynamic, 1, 0, 4, 1> weights; ///< of these corners, >= 0; they sum to 1
    Vector<Dim, Scalar> point;                                 ///< the nearest point, m
    Scalar distance = 0;                                       ///< to it, m
};

/// Answers where points lie in a mesh: which cell holds a point, and which point of the surface is nearest.
///
/// The surface is the boundary of a mesh that fills its dimension, and the whole of a membrane; four-cornered facets
/// are taken as two triangles, curved ones by their corners. It keeps a copy of the mesh and two search trees: building
/// is O(cells log cells), a query O(log cells) as a rule; queries from several threads at once are fine.
template <int Dim, std::floating_point Scalar, CellType Cell>
class Locator {
public:
    /// Throws InvalidArgument for a mesh that is not valid.
    explicit Locator(const Mesh<Dim, Scalar, Cell>& mesh);

    Locator(const Locator&) = delete;
    Locator& operator=(const Locator&) = delete;

    [[nodiscard]] const Mesh<Dim, Scalar, Cell>& mesh() const { return m_mesh; }

    /// Longest distance between two corners of the box around the mesh, m.
    [[nodiscard]] Scalar diameter() const { return m_diameter; }

    /// The cell that holds a point (on a shared face: the one it lies deepest in), or none. A membrane holds the points
    /// that lie on it to rounding.
    [[nodiscard]] std::optional<CellPlace<Scalar, Cell>> cell_at(const Vector<Dim, Scalar>& point) const;

    /// The nearest point of the surface. Throws InvalidArgument for a point that is not finite.
    [[nodiscard]] SurfacePlace<Dim, Scalar> nearest(const Vector<Dim, Scalar>& point) const;

private:
    static constexpr bool membrane = is_membrane<Dim, Scalar, Cell>;
    static constexpr int n_piece_corners = Cell::dimension == 2 && !membrane ? 2 : 3;
    using Piece =
        std::conditional_t<n_piece_corners == 2, detail::PlainKernel::Segment_3, detail::PlainKernel::Triangle_3>;

    /// A triangle or segment of a facet: three (two) of the facet's corners.
    struct FacetPiece {
        int facet;
        std::array<int, n_piece_corners> corners;
    };

    void add_facet(int cell, int local, const std::vector<int>& corners);
    void build_surface();

    Mesh<Dim, Scalar, Cell> m_mesh;
    Scalar m_diameter = 0;
    double m_tolerance = 1000 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());
    std::vector<SurfacePlace<Dim, Scalar>> m_facets;
    std::vector<FacetPiece> m_pieces;
    detail::SearchTree<detail::PlainKernel::Iso_cuboid_3> m_boxes;
    detail::SearchTree<Piece> m_surface;
};

} // namespace springfit::cgal

#include <springfit/cgal/detail/interpolation_impl.hpp>
#include <springfit/cgal/detail/location_impl.hpp>
