// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numeric>

#include <CGAL/Polygon_mesh_processing/detect_features.h>

#include <springfit/cgal/detail/repair_surface.hpp>

namespace springfit::cgal::detail {

/// A line of sharp edges that runs from corner to corner, or round to its first point.
struct SharpLine {
    std::vector<Kernel::Point_3> points;
    double network_length = 0; ///< of all lines joined to this one, itself included, m
};

/// Lines along the edges whose faces' normals differ by more than `angle` (degrees). A line ends where other than two
/// sharp edges meet, and where it turns by more than `angle`.
inline std::vector<SharpLine> sharp_lines(const TriangleSurface& surface, double angle) {
    using Vertex = TriangleSurface::Vertex_index;
    namespace pmp = CGAL::Polygon_mesh_processing;
    std::vector<char> sharp(surface.number_of_edges(), 0);
    pmp::detect_sharp_edges(surface, angle,
                            boost::make_function_property_map<TriangleSurface::Edge_index, char&>(
                                [&](TriangleSurface::Edge_index e) -> char& { return sharp[e]; }));

    std::vector<std::vector<Vertex>> neighbours(surface.number_of_vertices());
    std::vector<std::size_t> network(surface.number_of_vertices());
    std::iota(network.begin(), network.end(), std::size_t{0});
    const auto root = [&](std::size_t i) {
        while (network[i] != i) {
            i = network[i] = network[network[i]];
        }
        return i;
    };
    for (const auto edge : surface.edges()) {
        if (sharp[edge]) {
            const Vertex a = surface.vertex(edge, 0);
            const Vertex b = surface.vertex(edge, 1);
            neighbours[a].push_back(b);
            neighbours[b].push_back(a);
            network[root(a)] = root(b);
        }
    }
    std::vector<double> length(surface.number_of_vertices(), 0);
    for (const auto edge : surface.edges()) {
        if (sharp[edge]) {
            length[root(surface.vertex(edge, 0))] += pmp::edge_length(edge, surface);
        }
    }

    const double turn = std::cos(angle * CGAL_PI / 180);
    const auto is_end = [&](Vertex v) {
        if (neighbours[v].size() != 2) {
            return true;
        }
        const auto in = surface.point(v) - surface.point(neighbours[v][0]);
        const auto out = surface.point(neighbours[v][1]) - surface.point(v);
        return in * out < turn * std::sqrt(in.squared_length() * out.squared_length());
    };
    std::vector<SharpLine> lines;
    std::vector<std::vector<char>> walked(neighbours.size());
    for (std::size_t v = 0; v < neighbours.size(); ++v) {
        walked[v].assign(neighbours[v].size(), 0);
    }
    const auto mark = [&](Vertex from, Vertex to) {
        const auto at = std::find(neighbours[from].begin(), neighbours[from].end(), to) - neighbours[from].begin();
        walked[from][static_cast<std::size_t>(at)] = 1;
    };
    const auto walk = [&](Vertex start, std::size_t first) {
        SharpLine line{{surface.point(start)}, length[root(start)]};
        Vertex from = start;
        Vertex to = neighbours[start][first];
        while (true) {
            mark(from, to);
            mark(to, from);
            line.points.push_back(surface.point(to));
            if (to == start || is_end(to)) {
                break;
            }
            const Vertex next = neighbours[to][neighbours[to][0] == from ? 1 : 0];
            from = to;
            to = next;
        }
        lines.push_back(std::move(line));
    };
    for (const bool rings : {false, true}) { // lines between ends first; what is left are smooth closed loops
        for (const auto v : surface.vertices()) {
            for (std::size_t n = 0; n < neighbours[v].size(); ++n) {
                if (!walked[v][n] && (rings || is_end(v))) {
                    walk(v, n);
                }
            }
        }
    }
    return lines;
}

} // namespace springfit::cgal::detail
