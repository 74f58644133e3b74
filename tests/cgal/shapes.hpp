// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <random>
#include <string>

#include <springfit/mesh/mesh.hpp>

namespace springfit::test {

using Triangles = Mesh<3, double, Tri3>;

inline Triangles triangles(const std::vector<std::array<double, 3>>& points,
                           const std::vector<std::vector<int>>& polygons) {
    Triangles mesh;
    mesh.nodes.resize(3, static_cast<Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        mesh.nodes.col(static_cast<Index>(i)) << points[i][0], points[i][1], points[i][2];
    }
    std::vector<std::array<int, 3>> cells;
    for (const auto& polygon : polygons) {
        for (std::size_t a = 2; a < polygon.size(); ++a) {
            cells.push_back({polygon[0], polygon[a - 1], polygon[a]});
        }
    }
    mesh.cells.resize(3, static_cast<Index>(cells.size()));
    for (std::size_t c = 0; c < cells.size(); ++c) {
        mesh.cells.col(static_cast<Index>(c)) << cells[c][0], cells[c][1], cells[c][2];
    }
    return mesh;
}

/// A box from the origin.
inline Triangles box(double x, double y, double z) {
    return triangles({{0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0}, {0, 0, z}, {x, 0, z}, {x, y, z}, {0, y, z}},
                     {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
}

/// An L of three unit squares, one unit thick: volume 3.
inline Triangles l_shape() {
    std::vector<std::array<double, 3>> points;
    for (const double z : {0., 1.}) {
        for (const auto& p : {std::array{0., 0.}, {2., 0.}, {2., 1.}, {1., 1.}, {1., 2.}, {0., 2.}}) {
            points.push_back({p[0], p[1], z});
        }
    }
    std::vector<std::vector<int>> polygons{{3, 2, 1, 0}, {3, 0, 5, 4}, {9, 6, 7, 8}, {9, 10, 11, 6}};
    for (int i = 0; i < 6; ++i) {
        const int j = (i + 1) % 6;
        polygons.push_back({i, j, 6 + j, 6 + i});
    }
    return triangles(points, polygons);
}

/// A ring of circles of radius `thick`, `around` of them of `across` points, about a circle of radius `wide`.
inline Triangles torus(double wide, double thick, int around, int across) {
    std::vector<std::array<double, 3>> points;
    std::vector<std::vector<int>> polygons;
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < across; ++j) {
            const double a = 2 * std::numbers::pi * i / around;
            const double b = 2 * std::numbers::pi * j / across;
            const double r = wide + thick * std::cos(b);
            points.push_back({r * std::cos(a), r * std::sin(a), thick * std::sin(b)});
            const int next = (i + 1) % around * across;
            const int up = (j + 1) % across;
            polygons.push_back({i * across + j, next + j, next + up, i * across + up});
        }
    }
    return triangles(points, polygons);
}

/// An octahedron whose faces are cut in four again and again, its points on the unit sphere.
inline Triangles sphere(int cuts) {
    std::vector<std::array<double, 3>> points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<std::vector<int>> faces{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                        {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int cut = 0; cut < cuts; ++cut) {
        std::map<std::array<int, 2>, int> middle;
        const auto between = [&](int a, int b) {
            const auto [at, is_new] =
                middle.insert({{std::min(a, b), std::max(a, b)}, static_cast<int>(points.size())});
            if (is_new) {
                const auto& p = points[static_cast<std::size_t>(a)];
                const auto& q = points[static_cast<std::size_t>(b)];
                const double norm = std::hypot(p[0] + q[0], p[1] + q[1], p[2] + q[2]);
                points.push_back({(p[0] + q[0]) / norm, (p[1] + q[1]) / norm, (p[2] + q[2]) / norm});
            }
            return at->second;
        };
        std::vector<std::vector<int>> finer;
        for (const auto& f : faces) {
            const int ab = between(f[0], f[1]);
            const int bc = between(f[1], f[2]);
            const int ca = between(f[2], f[0]);
            finer.insert(finer.end(), {{f[0], ab, ca}, {f[1], bc, ab}, {f[2], ca, bc}, {ab, bc, ca}});
        }
        faces = finer;
    }
    return triangles(points, faces);
}

/// Two surfaces side by side in one, the second moved by `shift`.
inline Triangles both(const Triangles& a, const Triangles& b, const Vector<3, double>& shift) {
    Triangles mesh;
    mesh.nodes.resize(3, a.n_nodes() + b.n_nodes());
    mesh.nodes << a.nodes, b.nodes.colwise() + shift;
    mesh.cells.resize(3, a.n_cells() + b.n_cells());
    mesh.cells << a.cells, (b.cells.array() + static_cast<int>(a.n_nodes())).matrix();
    return mesh;
}

/// A folder that goes away with its owner.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::random_device random;
        m_path = std::filesystem::temp_directory_path() / ("springfit-test-" + std::to_string(random()));
        std::filesystem::create_directory(m_path);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(m_path, ignored);
    }

    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return m_path / name; }

    /// Writes a file of this text and returns its path.
    [[nodiscard]] std::filesystem::path file(const std::string& name, const std::string& content) const {
        std::ofstream(m_path / name, std::ios::binary) << content;
        return m_path / name;
    }

private:
    std::filesystem::path m_path;
};

inline std::string off(const Triangles& mesh) {
    std::ostringstream out;
    out.precision(17);
    out << "OFF\n" << mesh.n_nodes() << ' ' << mesh.n_cells() << " 0\n" << mesh.nodes.transpose() << '\n';
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        out << "3 " << mesh.cells.col(c).transpose() << '\n';
    }
    return out.str();
}

inline std::string obj(const Triangles& mesh) {
    std::ostringstream out;
    out.precision(17);
    out << "# nan in a comment is nobody's business\n";
    for (Index i = 0; i < mesh.n_nodes(); ++i) {
        out << "v " << mesh.nodes.col(i).transpose() << '\n';
    }
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        out << "f " << (mesh.cells.col(c).array() + 1).transpose() << '\n';
    }
    return out.str();
}

inline std::string ply(const Triangles& mesh, bool binary) {
    std::ostringstream out;
    out.precision(17);
    out << "ply\nformat " << (binary ? "binary_little_endian" : "ascii") << " 1.0\nelement vertex " << mesh.n_nodes()
        << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << mesh.n_cells()
        << "\nproperty list uchar int vertex_indices\nend_header\n";
    for (Index i = 0; i < mesh.n_nodes(); ++i) {
        if (binary) {
            out.write(reinterpret_cast<const char*>(mesh.nodes.col(i).data()), 3 * sizeof(double));
        } else {
            out << mesh.nodes.col(i).transpose() << '\n';
        }
    }
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        if (binary) {
            out.put(3).write(reinterpret_cast<const char*>(mesh.cells.col(c).data()), 3 * sizeof(int));
        } else {
            out << "3 " << mesh.cells.col(c).transpose() << '\n';
        }
    }
    return out.str();
}

inline std::string stl(const Triangles& mesh, bool binary) {
    std::ostringstream out;
    out.precision(17);
    const auto n = static_cast<std::uint32_t>(mesh.n_cells());
    if (binary) {
        out << std::string(80, ' ');
        out.write(reinterpret_cast<const char*>(&n), sizeof n);
    } else {
        out << "solid nan\n";
    }
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const Eigen::Matrix3f corners = mesh.cell_nodes(c).cast<float>();
        if (binary) {
            out << std::string(12, '\0');
            out.write(reinterpret_cast<const char*>(corners.data()), 9 * sizeof(float)) << std::string(2, '\0');
        } else {
            out << "facet normal 0 0 0\nouter loop\n";
            for (int a = 0; a < 3; ++a) {
                out << "vertex " << corners.col(a).transpose() << '\n';
            }
            out << "endloop\nendfacet\n";
        }
    }
    if (!binary) {
        out << "endsolid nan\n";
    }
    return out.str();
}

} // namespace springfit::test
