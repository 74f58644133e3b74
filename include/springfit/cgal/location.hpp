// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <springfit/cgal/detail/cell_boxes.hpp>
#include <springfit/cgal/detail/invert_cell.hpp>
#include <springfit/mesh/topology.hpp>
#include <springfit/motion/transfer.hpp>

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

/// Interpolation from the nodes of a mesh at points: by the shape functions of the cell that holds a point, and at the
/// nearest surface point where none does.
///
/// Throws InvalidArgument for a point farther than `max_distance` (m; 0: a tenth of the mesh's diameter) from the mesh.
/// O((cells + points) log cells).
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] Interpolation<Scalar> interpolation(const Mesh<Dim, Scalar, Cell>& mesh,
                                                  const Points<Dim, Scalar>& points, Scalar max_distance = 0) {
    require(max_distance >= 0, "max_distance", "a length not below 0", max_distance);
    const Locator locator(mesh);
    const Scalar farthest = max_distance > 0 ? max_distance : locator.diameter() / 10;
    std::vector<Eigen::Triplet<Scalar>> entries;
    const auto add = [&](Index target, const auto& nodes, const auto& weights) {
        const Scalar negligible = 10 * std::numeric_limits<Scalar>::epsilon();
        Scalar kept = 0;
        for (Index a = 0; a < weights.size(); ++a) {
            kept += std::abs(weights(a)) > negligible ? weights(a) : Scalar(0);
        }
        for (Index a = 0; a < weights.size(); ++a) {
            if (std::abs(weights(a)) > negligible) {
                entries.emplace_back(nodes(a), static_cast<int>(target), weights(a) / kept);
            }
        }
    };
    for (Index target = 0; target < points.cols(); ++target) {
        const Vector<Dim, Scalar> point = points.col(target);
        if (const auto inside = locator.cell_at(point)) {
            add(target, mesh.cells.col(inside->cell), inside->weights);
        } else {
            const auto place = locator.nearest(point);
            if (!(place.distance <= farthest)) {
                throw InvalidArgument("points", text("points at most ", farthest, " m from the mesh"),
                                      text("point ", target, " at ", place.distance, " m"));
            }
            add(target, place.nodes, place.weights);
        }
    }
    Interpolation<Scalar> result;
    result.weights.resize(mesh.n_nodes(), points.cols());
    result.weights.setFromTriplets(entries.begin(), entries.end());
    return result;
}

} // namespace springfit::cgal

#include <springfit/cgal/detail/location.hpp>
