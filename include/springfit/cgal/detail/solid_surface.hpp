// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <springfit/cgal/surface.hpp>

namespace springfit::cgal::detail {

/// A repaired surface that bounds a solid, with what a mesher asks of it.
struct SolidSurface {
    Surface surface;
    double volume = 0;                           ///< m^3
    double area = 0;                             ///< m^2
    std::vector<std::array<int, 2>> sharp_edges; ///< pairs of points
};

/// Repairs a surface and finds the edges whose faces' normals differ by more than an angle (degrees). Throws as
/// `require_solid`, naming `name`.
[[nodiscard]] SPRINGFIT_CGAL_INLINE SolidSurface solid_surface(const Surface& surface, const RepairOptions& options,
                                                               double sharp_edge_angle, std::string_view name);

/// The same of a file, which messages name. Throws as `read_surface` and `require_solid`.
[[nodiscard]] SPRINGFIT_CGAL_INLINE SolidSurface read_solid_surface(const std::filesystem::path& path,
                                                                    const RepairOptions& options,
                                                                    double sharp_edge_angle);

} // namespace springfit::cgal::detail
