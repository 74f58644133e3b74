// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/mesh/mesh.hpp>
#include <springfit/motion/transfer.hpp>

namespace springfit::cgal {

/// Interpolation from the nodes of a mesh at points: by the shape functions of the cell that holds a point, and at the
/// nearest surface point where none does.
///
/// Throws InvalidArgument for a point farther than `max_distance` (m; 0: a tenth of the mesh's diameter) from the mesh.
/// O((cells + points) log cells).
///
/// springfit::compiled_cgal holds it for triangles in the plane and tetrahedra, in double and float;
/// `cgal/location.hpp` has it for all cells.
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] Interpolation<Scalar> interpolation(const Mesh<Dim, Scalar, Cell>& mesh,
                                                  const Points<Dim, Scalar>& points, Scalar max_distance = 0);

} // namespace springfit::cgal

#ifndef SPRINGFIT_COMPILED_CGAL
#include <springfit/cgal/location.hpp>
#endif
