// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include <springfit/cgal/detail/solid_mesher.hpp>
#include <springfit/cgal/detail/solid_surface.hpp>

namespace springfit::cgal::detail {

/// The sharp edges of a surface as a graph on its vertices.
class SharpEdges {
public:
    using Vertex = std::size_t;

    /// `angle` (degrees): where a line turns by more, it ends.
    SharpEdges(const SolidSurface& solid, double angle)
        : m_turn(std::cos(angle * EIGEN_PI / 180)), m_points(solid.surface.nodes),
          m_neighbours(static_cast<std::size_t>(solid.surface.n_nodes())) {
        for (const auto& [a, b] : solid.sharp_edges) {
            m_neighbours[static_cast<std::size_t>(a)].push_back(static_cast<Vertex>(b));
            m_neighbours[static_cast<std::size_t>(b)].push_back(static_cast<Vertex>(a));
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
                        const auto p = point(line[i]);
                        points.push_back({p.x(), p.y(), p.z()});
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
    [[nodiscard]] Vector<3, double> point(Vertex v) const { return m_points.col(static_cast<Index>(v)); }

    [[nodiscard]] bool is_end(Vertex v) const {
        if (m_neighbours[v].size() != 2) {
            return true;
        }
        const Vector<3, double> in = point(v) - point(m_neighbours[v][0]);
        const Vector<3, double> out = point(m_neighbours[v][1]) - point(v);
        return in.dot(out) < m_turn * std::sqrt(in.squaredNorm() * out.squaredNorm());
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
            sum += (point(line[i]) - point(line[i - 1])).norm();
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
    Points<3, double> m_points;
    std::vector<std::vector<Vertex>> m_neighbours;
};

} // namespace springfit::cgal::detail
