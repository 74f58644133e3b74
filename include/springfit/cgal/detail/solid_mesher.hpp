// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <stdexcept>
#include <vector>

#include <springfit/cgal/detail/inline.hpp>

namespace springfit::cgal::detail {

/// Points and cells of `Corners` corners, as they go into and come out of a mesher.
template <std::size_t Corners>
struct CellList {
    std::vector<std::array<double, 3>> points;
    std::vector<std::array<int, Corners>> cells;
};

/// A line of sharp edges that runs from corner to corner, or round to its first point.
using SharpLine = std::vector<std::array<double, 3>>;

/// CGAL cannot go on, and says why.
class MesherFailure : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A mesh would have more nodes than are allowed.
class TooManyNodes : public MesherFailure {
public:
    using MesherFailure::MesherFailure;
};

/// One meshing of a solid: a type of CGAL's.
struct SolidComplex;

/// Delaunay refinement of the inside of one closed surface, its sharp edges kept; meshes it again and again at
/// different sizes. The random numbers start alike for every meshing, so the same size gives the same mesh.
/// Throws MesherFailure where it cannot follow the surface.
class SolidMesher {
public:
    /// `patches`: for each triangle the number of its piece of the surface, from 1.
    SPRINGFIT_CGAL_INLINE SolidMesher(const CellList<3>& surface, const std::vector<int>& patches, unsigned seed);
    SolidMesher(const SolidMesher&) = delete;
    SolidMesher& operator=(const SolidMesher&) = delete;

    /// Tetrahedra with edges of about `size` and facets within `distance` of the surface. Throws TooManyNodes where
    /// that takes `most_nodes`.
    [[nodiscard]] SPRINGFIT_CGAL_INLINE std::shared_ptr<SolidComplex>
    refined(double size, double distance, const std::vector<SharpLine>& lines, std::size_t most_nodes);

    /// Moves nodes, then weighs them, so that as few dihedral angles as can be had are below `angle` (degrees).
    SPRINGFIT_CGAL_INLINE void remove_slivers(SolidComplex& complex, double angle);

private:
    struct State;
    std::shared_ptr<State> m_state;
};

/// Nodes of the cells of a complex; a triangulation holds others too.
[[nodiscard]] SPRINGFIT_CGAL_INLINE long count_nodes(const SolidComplex& complex);

/// The cells of a complex with their nodes numbered as the cells come.
[[nodiscard]] SPRINGFIT_CGAL_INLINE CellList<4> cell_list(const SolidComplex& complex);

} // namespace springfit::cgal::detail
