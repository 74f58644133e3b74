// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>

#include <springfit/mesh/mesh.hpp>

namespace springfit::cgal::detail {

using PlainKernel = CGAL::Simple_cartesian<double>;

/// A point in the plane or in space as CGAL's point in space.
template <class Derived>
[[nodiscard]] PlainKernel::Point_3 plain_point(const Eigen::MatrixBase<Derived>& p) {
    return {static_cast<double>(p(0)), static_cast<double>(p(1)),
            p.size() == 3 ? static_cast<double>(p(p.size() - 1)) : 0.};
}

/// The shape of one number in a search tree: a cell's box, a facet's triangle or segment.
template <class Shape>
class NumberedShape {
public:
    using Id = int;
    using Point = PlainKernel::Point_3;
    using Datum = Shape;

    NumberedShape(int number, const Shape& shape, const Point& reference)
        : m_number(number), m_shape(shape), m_reference(reference) {}

    /// How the tree takes it from a range.
    explicit NumberedShape(const NumberedShape* shape) : NumberedShape(*shape) {}

    [[nodiscard]] Id id() const { return m_number; }
    [[nodiscard]] const Datum& datum() const { return m_shape; }
    [[nodiscard]] const Point& reference_point() const { return m_reference; }

private:
    int m_number;
    Shape m_shape;
    Point m_reference;
};

template <class Shape>
using SearchTree = CGAL::AABB_tree<CGAL::AABB_traits<PlainKernel, NumberedShape<Shape>>>;

/// Search tree of the boxes around the cells, widened by `margin` (m).
template <int Dim, std::floating_point Scalar, CellType Cell>
void insert_boxes(const Mesh<Dim, Scalar, Cell>& mesh, double margin, SearchTree<PlainKernel::Iso_cuboid_3>& tree) {
    std::vector<NumberedShape<PlainKernel::Iso_cuboid_3>> boxes;
    boxes.reserve(static_cast<std::size_t>(mesh.n_cells()));
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const auto x = mesh.cell_nodes(c);
        const Vector<Dim, double> low = x.rowwise().minCoeff().template cast<double>().array() - margin;
        const Vector<Dim, double> high = x.rowwise().maxCoeff().template cast<double>().array() + margin;
        const auto corner = plain_point(low);
        boxes.emplace_back(static_cast<int>(c), PlainKernel::Iso_cuboid_3(corner, plain_point(high)), corner);
    }
    tree.insert(boxes.data(), boxes.data() + boxes.size());
    tree.build();
}

} // namespace springfit::cgal::detail
