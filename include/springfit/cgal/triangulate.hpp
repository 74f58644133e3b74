// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

#include <springfit/cgal/detail/inline.hpp>
#include <springfit/core/progress.hpp>
#include <springfit/mesh/mesh.hpp>
#include <springfit/mesh/topology.hpp>

namespace springfit::cgal {

/// The boundary of a plane body: closed rings of segments, and a point in every region that is to stay empty.
struct Outline {
    Points<2, double> points; ///< [2 x n_points], m; those that no segment uses are left out
    NodePairs segments;       ///< point numbers [2 x n_segments]; segments inside the body become edges of the mesh
    Points<2, double> holes;  ///< [2 x n_holes], m
};

/// How a plane body is cut into triangles. Give `cell_size` or `n_nodes`, not both.
struct TriangulateOptions {
    double cell_size = 0;        ///< wanted mean edge length, m, > 0
    Index n_nodes = 0;           ///< wanted number of nodes, 3 to 2e7; met within 10 % where the outline allows
    bool several_pieces = false; ///< accept a mesh of several pieces that no edge joins
    ProgressCallback progress{}; ///< called after each meshing; returning false takes the best mesh so far
};

/// An outline with points nearer than 1e-6 of its extent merged, segments given twice and those without length dropped.
///
/// Throws InvalidArgument, naming `name`: for an outline that is empty, that has a coordinate that is not finite, that
/// is open (how many loose ends), or whose segments cross, touch or overlap to within
/// that distance (how many pairs). O(n log n).
[[nodiscard]] SPRINGFIT_CGAL_INLINE Outline checked(const Outline& outline, std::string_view name = "outline");

/// Reads an outline: Triangle's .poly (numbered from 0 or 1) or .wkt (POLYGON and MULTIPOLYGON with holes).
///
/// Throws FileError as `io::read_outline_file`, and InvalidArgument as `checked`.
[[nodiscard]] SPRINGFIT_CGAL_INLINE Outline read_outline(const std::filesystem::path& path);

/// Cuts the inside of an outline into triangles by constrained Delaunay refinement.
///
/// No angle comes out below 20.7 degrees except at sharper corners of the outline. The same input gives the same mesh.
/// Throws InvalidArgument for an option out of range, as `checked`, for a hole's point that lies outside, for parts so
/// thin that they take ten times the nodes wanted, and where the mesh falls into pieces. O(n_nodes log n_nodes) per
/// meshing.
template <std::floating_point Scalar>
[[nodiscard]] Mesh<2, Scalar, Tri3> triangulate(const Outline& outline, const TriangulateOptions& options);

/// Reads an outline (.poly, .wkt) and cuts its inside into triangles:
///
///     auto mesh = springfit::cgal::triangulate<double>("plate.wkt", {.cell_size = 0.01});
template <std::floating_point Scalar>
[[nodiscard]] Mesh<2, Scalar, Tri3> triangulate(const std::filesystem::path& path, const TriangulateOptions& options);

} // namespace springfit::cgal

#ifndef SPRINGFIT_COMPILED_CGAL
#include <springfit/cgal/detail/triangulate_impl.hpp>
#endif
