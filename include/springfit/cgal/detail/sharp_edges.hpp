// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numeric>

#include <CGAL/Polygon_mesh_processing/detect_features.h>

#include <springfit/cgal/detail/repair_surface.hpp>

namespace springfit::cgal::detail {

/// A line of sharp edges that runs from corner to corner, or round to its first point.
using SharpLine = std::vector<Kernel::Point_3>;

/// The edges of a surface whose faces' normals differ by more than an angle, as a graph on its vertices.
class SharpEdges {
public:
    using Vertex = std::size_t;

    SharpEdges(const TriangleSurface& surface, double angle)
        : m_turn(std::cos(angle * CGAL_PI / 180)), m_points(surface.points().begin(), surface.points().end()),
          m_neighbours(m_points.size()) {
        std::vector<char> sharp(surface.number_of_edges(), 0);
        CGAL::Polygon_mesh_processing::detect_sharp_edges(
            surface, angle,
            boost::make_function_property_map<TriangleSurface::Edge_index, char&>(
                [&](TriangleSurface::Edge_index e) -> char& { return sharp[e]; }));
        for (const auto edge : surface.edges()) {
            if (sharp[edge]) {
                const Vertex a = surface.vertex(edge, 0);
                const Vertex b = surface.vertex(edge, 1);
                m_neighbours[a].push_back(b);
                m_neighbours[b].push_back(a);
            }
        }
    }

    /// Drops dangling branches shorter than `branch`, again and again, then networks shorter than `network` in all.
    void drop_short(double branch, double network) {
        for (bool dropped = true; dropped;) {
            dropped = false;
            for (Vertex v = 0; v < m_neighbours.size(); ++v) {
                if (m_neighbours[v].size() == 1) {
                    const auto line =
                        walk(v, m_neighbours[v][0], [&](Vertex w) { return m_neighbours[w].size() != 2; });
                    if (m_neighbours[line.back()].size() > 2 && length(line) < branch) {
                        drop(line);
                        dropped = true;
                    }
                }
            }
        }
        std::vector<char> visited(m_neighbours.size(), 0);
        for (Vertex v = 0; v < m_neighbours.size(); ++v) {
            std::vector<Vertex> members{v};
            double total = 0;
            for (std::size_t next = 0; next < members.size() && visited[v] == 0; ++next) {
                for (const Vertex w : m_neighbours[members[next]]) {
                    total += length({members[next], w}) / 2;
                    if (w != v && visited[w] == 0) {
                        visited[w] = 1;
                        members.push_back(w);
                    }
                }
            }
            visited[v] = 1;
            if (members.size() > 1 && total < network) {
                for (const Vertex w : members) {
                    m_neighbours[w].clear();
                }
            }
        }
    }

    /// Lines that end where other than two sharp edges meet, and where they turn by more than the angle.
    [[nodiscard]] std::vector<SharpLine> lines() const {
        std::vector<SharpLine> result;
        std::vector<std::vector<char>> walked(m_neighbours.size());
        for (Vertex v = 0; v < m_neighbours.size(); ++v) {
            walked[v].assign(m_neighbours[v].size(), 0);
        }
        const auto mark = [&](Vertex from, Vertex to) {
            const auto at = std::find(m_neighbours[from].begin(), m_neighbours[from].end(), to);
            walked[from][static_cast<std::size_t>(at - m_neighbours[from].begin())] = 1;
        };
        for (const bool rings : {false, true}) { // lines between ends first; what is left are smooth closed loops
            for (Vertex v = 0; v < m_neighbours.size(); ++v) {
                for (std::size_t n = 0; n < m_neighbours[v].size(); ++n) {
                    if (walked[v][n] || !(rings || is_end(v))) {
                        continue;
                    }
                    const auto line = walk(v, m_neighbours[v][n], [&](Vertex w) { return is_end(w); });
                    SharpLine points;
                    for (std::size_t i = 0; i < line.size(); ++i) {
                        points.push_back(m_points[line[i]]);
                        if (i > 0) {
                            mark(line[i - 1], line[i]);
                            mark(line[i], line[i - 1]);
                        }
                    }
                    result.push_back(std::move(points));
                }
            }
        }
        return result;
    }

private:
    [[nodiscard]] bool is_end(Vertex v) const {
        if (m_neighbours[v].size() != 2) {
            return true;
        }
        const auto in = m_points[v] - m_points[m_neighbours[v][0]];
        const auto out = m_points[m_neighbours[v][1]] - m_points[v];
        return in * out < m_turn * std::sqrt(in.squared_length() * out.squared_length());
    }

    /// Vertices from `start` by `next` on to the first where `ends` holds, or back to `start`.
    template <class Ends>
    [[nodiscard]] std::vector<Vertex> walk(Vertex start, Vertex next, const Ends& ends) const {
        std::vector<Vertex> line{start, next};
        while (line.back() != start && !ends(line.back())) {
            const auto& both = m_neighbours[line.back()];
            line.push_back(both[0] == line[line.size() - 2] ? both[1] : both[0]);
        }
        return line;
    }

    [[nodiscard]] double length(const std::vector<Vertex>& line) const {
        double sum = 0;
        for (std::size_t i = 1; i < line.size(); ++i) {
            sum += std::sqrt(CGAL::squared_distance(m_points[line[i - 1]], m_points[line[i]]));
        }
        return sum;
    }

    void drop(const std::vector<Vertex>& line) {
        for (std::size_t i = 1; i < line.size(); ++i) {
            std::erase(m_neighbours[line[i - 1]], line[i]);
            std::erase(m_neighbours[line[i]], line[i - 1]);
        }
    }

    double m_turn;
    std::vector<Kernel::Point_3> m_points;
    std::vector<std::vector<Vertex>> m_neighbours;
};

} // namespace springfit::cgal::detail
