// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_domain_with_polyline_features_3.h>
#include <CGAL/Mesh_polyhedron_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polyhedral_mesh_domain_3.h>
#include <CGAL/assertions_behaviour.h>
#include <CGAL/exceptions.h>

#include <springfit/cgal/detail/kernel.hpp>
#include <springfit/cgal/detail/solid_mesher.hpp>

namespace springfit::cgal::detail {

using SolidPolyhedron = CGAL::Mesh_polyhedron_3<Kernel>::type;
/// (CGAL's own domain with features is this one and finds the sharp edges itself, which takes all of its polygon mesh
/// processing to compile.)
using FeaturedDomain = CGAL::Mesh_domain_with_polyline_features_3<
    CGAL::Polyhedral_mesh_domain_3<SolidPolyhedron, Kernel, CGAL::Default, int>>;

/// The domain of a solid, which allows only so many points on sharp edges. Where these nearly meet, CGAL puts ever more
/// points on them, and takes many off again: their number in the mesh tells too late.
class SolidDomain : public FeaturedDomain {
public:
    using FeaturedDomain::FeaturedDomain;

    void allow_points_on_edges(std::size_t n) { m_points_allowed = n; }

    [[nodiscard]] Point_3 construct_point_on_curve(const Point_3& start, const Curve_index& curve, FT distance) const {
        if (m_points_allowed == 0) {
            throw TooManyNodes("sharp edges that nearly meet");
        }
        --m_points_allowed;
        return FeaturedDomain::construct_point_on_curve(start, curve, distance);
    }

private:
    mutable std::size_t m_points_allowed = 0;
};
using SolidTriangulation = CGAL::Mesh_triangulation_3<SolidDomain, CGAL::Default, CGAL::Sequential_tag>::type;

struct SolidComplex {
    using Complex = CGAL::Mesh_complex_3_in_triangulation_3<SolidTriangulation, SolidDomain::Corner_index,
                                                            SolidDomain::Curve_index>;
    Complex complex;
};

struct SolidMesher::State {
    void prepare(const std::vector<SharpLine>& wanted);

    unsigned seed = 0;
    CGAL::Random random{0};
    SolidPolyhedron polyhedron;
    std::vector<int> patches;          ///< numbers of the pieces of the surface, each once
    std::optional<SolidDomain> domain; ///< of the lines
    std::vector<SharpLine> lines;
};

/// While it lives, CGAL does not print what it then throws.
class QuietErrors {
public:
    QuietErrors()
        : m_previous(CGAL::set_error_handler([](const char*, const char*, const char*, int, const char*) {})) {}
    QuietErrors(const QuietErrors&) = delete;
    QuietErrors& operator=(const QuietErrors&) = delete;
    ~QuietErrors() { CGAL::set_error_handler(m_previous); }

private:
    CGAL::Failure_function m_previous;
};

/// Calls `meshing`, whose failures in CGAL become MesherFailure.
template <class Meshing>
void without_failure(const Meshing& meshing) {
    const QuietErrors quiet;
    try {
        meshing();
    } catch (const CGAL::Failure_exception& failure) {
        throw MesherFailure(failure.message());
    }
}

} // namespace springfit::cgal::detail
