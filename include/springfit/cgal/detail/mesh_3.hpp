// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <unordered_map>

#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/boost/graph/copy_face_graph.h>
#include <CGAL/exude_mesh_3.h>
#include <CGAL/make_mesh_3.h>
#include <CGAL/perturb_mesh_3.h>

#include <springfit/cgal/detail/sharp_edges.hpp>

namespace springfit::cgal::detail {

/// Delaunay refinement of the inside of one closed surface, its sharp edges kept; meshes it again and again at
/// different sizes. The random numbers start alike for every meshing, so the same size gives the same mesh.
class SolidMesher {
public:
    using Polyhedron = CGAL::Mesh_polyhedron_3<Kernel>::type;
    using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel>;
    using Triangulation = CGAL::Mesh_triangulation_3<Domain, CGAL::Default, CGAL::Sequential_tag>::type;
    using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;

    SolidMesher(const TriangleSurface& surface, double sharp_edge_angle, unsigned seed)
        : m_seed(seed), m_edges(surface, sharp_edge_angle) {
        CGAL::copy_face_graph(surface, m_polyhedron);
    }

    /// Tetrahedra with edges of about `size` and facets within `distance` of the surface. Sharp edges that
    /// make lines shorter than a few cells are left out: such a mesh could not show them.
    [[nodiscard]] Complex refined(double size, double distance) {
        namespace p = CGAL::parameters;
        prepare(size);
        const CGAL::Mesh_criteria_3<Triangulation> criteria(
            p::edge_size = size, p::facet_angle = 25, p::facet_size = circumradius * size, p::facet_distance = distance,
            p::cell_radius_edge_ratio = 2, p::cell_size = circumradius * size);
        return CGAL::make_mesh_3<Complex>(*m_domain, criteria, p::no_perturb(), p::no_exude());
    }

    /// Moves nodes, then weighs them, so that as few dihedral angles as can be had are below `angle` (degrees).
    void remove_slivers(Complex& complex, double angle) {
        CGAL::perturb_mesh_3(complex, *m_domain, CGAL::parameters::sliver_bound = angle);
        CGAL::exude_mesh_3(complex, CGAL::parameters::sliver_bound = angle);
    }

private:
    /// Largest circumradius of facets and cells per wanted edge length, at which the mean edge has that length.
    static constexpr double circumradius = 0.8;
    /// Sharp edges are kept in networks at least this many cells long, without dangling branches shorter than that.
    static constexpr double shortest_network = 4;
    static constexpr double shortest_branch = 1;

    void prepare(double size) {
        SharpEdges edges = m_edges;
        edges.drop_short(shortest_branch * size, shortest_network * size);
        std::vector<SharpLine> kept = edges.lines();
        if (!m_domain || kept != m_kept) {
            m_domain.reset();
            m_domain.emplace(m_polyhedron, &m_random);
            m_domain->detect_features(180); // one patch per piece of the surface, and no features yet
            m_domain->add_features(kept.begin(), kept.end());
            m_kept = std::move(kept);
        }
        m_random = CGAL::Random(m_seed);
        CGAL::get_default_random() = CGAL::Random(m_seed);
    }

    unsigned m_seed;
    CGAL::Random m_random{0};
    SharpEdges m_edges;
    Polyhedron m_polyhedron;
    std::vector<SharpLine> m_kept;
    std::optional<Domain> m_domain;
};

/// Nodes of the cells of a complex; a triangulation holds others too.
inline Index count_nodes(const SolidMesher::Complex& complex) {
    std::unordered_map<const void*, int> seen;
    for (auto c = complex.cells_in_complex_begin(); c != complex.cells_in_complex_end(); ++c) {
        for (int a = 0; a < 4; ++a) {
            seen.emplace(&*c->vertex(a), 0);
        }
    }
    return static_cast<Index>(seen.size());
}

/// The cells of a complex with their nodes numbered as the cells come.
[[nodiscard]] inline Mesh<3, double, Tet4> to_mesh(const SolidMesher::Complex& complex) {
    std::unordered_map<const void*, int> number;
    std::vector<Kernel::Point_3> points;
    Mesh<3, double, Tet4> mesh;
    mesh.cells.resize(4, static_cast<Index>(complex.number_of_cells_in_complex()));
    const auto bare = complex.triangulation().geom_traits().construct_point_3_object();
    Index column = 0;
    for (auto c = complex.cells_in_complex_begin(); c != complex.cells_in_complex_end(); ++c, ++column) {
        for (int a = 0; a < 4; ++a) {
            const auto vertex = c->vertex(a);
            const auto [at, is_new] = number.emplace(&*vertex, static_cast<int>(points.size()));
            if (is_new) {
                points.push_back(bare(vertex->point()));
            }
            mesh.cells(a, column) = at->second;
        }
    }
    mesh.nodes.resize(3, static_cast<Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        mesh.nodes.col(static_cast<Index>(i)) << points[i].x(), points[i].y(), points[i].z();
    }
    return mesh;
}

} // namespace springfit::cgal::detail
