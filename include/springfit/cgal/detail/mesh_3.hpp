// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <unordered_map>

#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/make_mesh_3.h>

#include <springfit/cgal/detail/solid_complex.hpp>
#include <springfit/core/error.hpp>

namespace springfit::cgal::detail {

using SolidCriteria = CGAL::Mesh_criteria_3<SolidTriangulation>;

/// The domain with these lines, and the random numbers as at the start of every meshing.
inline void SolidMesher::State::prepare(const std::vector<SharpLine>& wanted) {
    if (!domain || wanted != lines) {
        std::vector<std::vector<Kernel::Point_3>> polylines;
        for (const SharpLine& line : wanted) {
            auto& polyline = polylines.emplace_back();
            for (const auto& p : line) {
                polyline.emplace_back(p[0], p[1], p[2]);
            }
        }
        domain.reset();
        domain.emplace(polyhedron, &random);
        domain->add_features_and_incidences(polylines.begin(), polylines.end(),
                                            boost::typed_identity_property_map<std::vector<Kernel::Point_3>>(),
                                            boost::static_property_map<std::vector<int>>(patches)); // any may be near
        lines = wanted;
    }
    random = CGAL::Random(seed);
    CGAL::get_default_random() = CGAL::Random(seed);
}

/// Points on the surface to begin with, until a facet of their triangulation follows it: CGAL's own dozen, which miss a
/// thin ring, then more.
inline constexpr std::array<int, 4> initial_points{-1, 100, 1000, 10000};

/// Delaunay refinement alone. CGAL's `make_mesh_3` does the same where it is asked for no optimisation, but has all of
/// its optimisers compiled. Ends, unfinished, where there are `most_nodes`.
inline void refine(SolidComplex& complex, const SolidDomain& domain, const SolidCriteria& criteria,
                   std::size_t most_nodes) {
    using Complex = SolidComplex::Complex;
#if CGAL_VERSION_NR < CGAL_VERSION_NUMBER(5, 6, 0)
    for (const int n_points : initial_points) {
        CGAL::parameters::internal::Mesh_3_options options;
        options.number_of_initial_points = n_points;
        options.maximal_number_of_vertices = most_nodes;
        complex.complex = Complex();
        CGAL::Mesh_3::internal::C3t3_initializer<Complex, SolidDomain, SolidCriteria, true>()(complex.complex, domain,
                                                                                              criteria, true, options);
        if (complex.complex.triangulation().number_of_vertices() >= most_nodes) {
            return;
        }
        Complex facets = complex.complex;
        CGAL::Mesh_3::C3T3_helpers<Complex, SolidDomain>(facets, domain).update_restricted_facets();
        if (facets.number_of_facets() > 0) {
            break;
        }
    }
    CGAL::Mesh_3::Mesher_3<Complex, SolidCriteria, SolidDomain>(complex.complex, domain, criteria,
                                                                CGAL::FACET_VERTICES_ON_SURFACE, most_nodes)
        .refine_mesh();
    complex.complex.clear_manifold_info();
#else
    for (const int n_points : initial_points) {
        complex.complex = CGAL::make_mesh_3<Complex>(
            domain, criteria, CGAL::parameters::no_perturb(), CGAL::parameters::no_exude(),
            CGAL::parameters::mesh_3_options(
                CGAL::parameters::number_of_initial_points(n_points).maximal_number_of_vertices(most_nodes)));
        if (complex.complex.number_of_facets() > 0) {
            break;
        }
    }
#endif
}

SPRINGFIT_CGAL_INLINE SolidMesher::SolidMesher(const CellList<3>& surface, const std::vector<int>& patches,
                                               unsigned seed)
    : m_state(std::make_shared<State>()) {
    m_state->seed = seed;
    const auto point = [&](int i) {
        const auto& p = surface.points[static_cast<std::size_t>(i)];
        return Kernel::Point_3(p[0], p[1], p[2]);
    };
    // The domain looks at triangles one by one: how they hang together does not matter to it.
    for (std::size_t f = 0; f < surface.cells.size(); ++f) {
        const auto& [a, b, c] = surface.cells[f];
        m_state->polyhedron.make_triangle(point(c), point(a), point(b))->face()->set_patch_id(patches[f]);
    }
    m_state->patches = patches;
    std::sort(m_state->patches.begin(), m_state->patches.end());
    m_state->patches.erase(std::unique(m_state->patches.begin(), m_state->patches.end()), m_state->patches.end());
}

SPRINGFIT_CGAL_INLINE std::shared_ptr<SolidComplex>
SolidMesher::refined(double size, double distance, const std::vector<SharpLine>& lines, std::size_t most_nodes) {
    constexpr double circumradius = 0.8; // largest of facets and cells per edge length wanted, to give that mean length
    const auto result = std::make_shared<SolidComplex>();
    without_failure([&] {
        m_state->prepare(lines);
        m_state->domain->allow_points_on_edges(2 * most_nodes);
        refine(*result, *m_state->domain,
               SolidCriteria(SolidCriteria::Edge_criteria(size),
                             SolidCriteria::Facet_criteria(25, circumradius * size, distance),
                             SolidCriteria::Cell_criteria(2, circumradius * size)),
               most_nodes);
    });
    if (result->complex.triangulation().number_of_vertices() >= most_nodes) {
        throw TooManyNodes(text("thin parts and sharp edges that take more than ", most_nodes));
    }
    return result;
}

SPRINGFIT_CGAL_INLINE long count_nodes(const SolidComplex& solid) {
    std::unordered_map<const void*, int> seen;
    const auto& complex = solid.complex;
    for (auto c = complex.cells_in_complex_begin(); c != complex.cells_in_complex_end(); ++c) {
        for (int a = 0; a < 4; ++a) {
            seen.emplace(&*c->vertex(a), 0);
        }
    }
    return static_cast<long>(seen.size());
}

SPRINGFIT_CGAL_INLINE CellList<4> cell_list(const SolidComplex& solid) {
    std::unordered_map<const void*, int> number;
    CellList<4> list;
    const auto& complex = solid.complex;
    const auto bare = complex.triangulation().geom_traits().construct_point_3_object();
    for (auto c = complex.cells_in_complex_begin(); c != complex.cells_in_complex_end(); ++c) {
        auto& cell = list.cells.emplace_back();
        for (int a = 0; a < 4; ++a) {
            const auto vertex = c->vertex(a);
            const auto [at, is_new] = number.emplace(&*vertex, static_cast<int>(list.points.size()));
            if (is_new) {
                const Kernel::Point_3 p = bare(vertex->point());
                list.points.push_back({p.x(), p.y(), p.z()});
            }
            cell[static_cast<std::size_t>(a)] = at->second;
        }
    }
    return list;
}

} // namespace springfit::cgal::detail
