// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <map>

#include <springfit/cgal/detail/mesh_2.hpp>
#include <springfit/cgal/detail/outline_file.hpp>
#include <springfit/cgal/detail/pieces.hpp>
#include <springfit/cgal/detail/size_search.hpp>
#include <springfit/core/progress.hpp>

namespace springfit::cgal {

/// What bounds a plane body: closed rings of segments, and a point in every region that is to stay empty.
struct Outline {
    Points<2, double> points; ///< [2 x n_points], m; those that no segment uses are left out
    NodePairs segments;       ///< point numbers [2 x n_segments]; segments inside the body become edges of the mesh
    Points<2, double> holes;  ///< [2 x n_holes], m
};

/// How a plane body is cut into triangles. Give `cell_size` or `n_nodes`, not both.
struct TriangulateOptions {
    double cell_size = 0;        ///< wanted mean edge length, m, > 0
    Index n_nodes = 0;           ///< wanted number of nodes, >= 3; met within 10 % where the outline allows
    bool several_pieces = false; ///< accept a mesh of several pieces that no edge joins
    ProgressCallback progress{}; ///< called after each meshing; returning false takes the best mesh so far
};

/// An outline with points given twice merged, segments given twice and those without length dropped.
///
/// Throws InvalidArgument, naming `name`: for an outline that is empty, that has a coordinate that is not finite, that
/// is open (how many loose ends), or whose segments cross, touch or overlap (how many pairs). O(n log n).
[[nodiscard]] inline Outline checked(const Outline& outline, std::string_view name = "outline") {
    require(outline.points.allFinite() && outline.holes.allFinite(), name, "finite coordinates",
            "one that is not finite");
    std::map<std::array<double, 2>, int> number;
    std::vector<std::array<int, 2>> segments;
    std::map<int, int> n_segments_at;
    for (Index s = 0; s < outline.segments.cols(); ++s) {
        std::array<int, 2> ends{};
        for (const int e : {0, 1}) {
            const int i = outline.segments(e, s);
            if (!(i >= 0 && i < outline.points.cols())) {
                throw InvalidArgument(name, text("point numbers in [0, ", outline.points.cols(), ")"),
                                      text(i, " in segment ", s));
            }
            ends[static_cast<std::size_t>(e)] =
                number.insert({{outline.points(0, i), outline.points(1, i)}, static_cast<int>(number.size())})
                    .first->second;
        }
        if (ends[0] != ends[1]) {
            segments.push_back(ends);
        }
    }
    const NodePairs unique = springfit::detail::sorted_unique_pairs(segments);
    require(unique.cols() >= 3, name, "an outline of at least three segments", unique.cols());

    detail::PlaneGraph graph;
    graph.points.resize(number.size());
    Outline result;
    result.points.resize(2, static_cast<Index>(number.size()));
    for (const auto& [point, i] : number) {
        graph.points[static_cast<std::size_t>(i)] = {point[0], point[1]};
        result.points.col(i) << point[0], point[1];
    }
    for (Index s = 0; s < unique.cols(); ++s) {
        graph.segments.push_back({unique(0, s), unique(1, s)});
        ++n_segments_at[unique(0, s)];
        ++n_segments_at[unique(1, s)];
    }
    const auto loose =
        std::count_if(n_segments_at.begin(), n_segments_at.end(), [](const auto& at) { return at.second == 1; });
    if (loose > 0) {
        const int first = std::find_if(n_segments_at.begin(), n_segments_at.end(), [](const auto& at) {
                              return at.second == 1;
                          })->first;
        throw InvalidArgument(name, "a closed outline",
                              text("an open one: ", loose, loose == 1 ? " loose end" : " loose ends",
                                   ", the first at (", result.points.col(first).transpose(), ")"));
    }
    const Index crossings = detail::count_crossings(graph);
    require(crossings == 0, name, "segments that meet at their ends only",
            text(crossings, crossings == 1 ? " pair" : " pairs", " that cross, touch or overlap"));
    result.segments = unique;
    result.holes = outline.holes;
    return result;
}

/// Reads an outline: Triangle's .poly (numbered from 0 or 1) or .wkt (POLYGON and MULTIPOLYGON with holes).
///
/// Throws FileError, with the line where there is one, for what cannot be read, and InvalidArgument as `checked`.
[[nodiscard]] Outline read_outline(const std::filesystem::path& path);

/// Cuts the inside of an outline into triangles by constrained Delaunay refinement.
///
/// No angle comes out below 20.7 degrees except at sharper corners of the outline. The same input gives the same mesh.
/// Throws InvalidArgument for an option out of range, as `checked`, for a hole's point that lies outside, and where the
/// mesh falls into pieces. O(n_nodes log n_nodes) per meshing.
template <std::floating_point Scalar>
[[nodiscard]] Mesh<2, Scalar, Tri3> triangulate(const Outline& outline, const TriangulateOptions& options);

/// Reads an outline (.poly, .wkt) and cuts its inside into triangles:
///
///     auto mesh = springfit::cgal::triangulate<double>("plate.wkt", {.cell_size = 0.01});
template <std::floating_point Scalar>
[[nodiscard]] Mesh<2, Scalar, Tri3> triangulate(const std::filesystem::path& path, const TriangulateOptions& options);

} // namespace springfit::cgal

#include <springfit/cgal/detail/triangulate.hpp>
