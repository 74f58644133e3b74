// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cgal/detail/tetrahedralize_impl.hpp>

// What springfit::compiled_cgal holds of the templates in springfit/cgal/tetrahedralize.hpp; it alone includes this.
namespace springfit::cgal {

template Mesh<3, double, Tet4> tetrahedralize<double>(const Surface&, const TetrahedralizeOptions&);
template Mesh<3, double, Tet4> tetrahedralize<double>(const std::filesystem::path&, const TetrahedralizeOptions&);
template Mesh<3, float, Tet4> tetrahedralize<float>(const Surface&, const TetrahedralizeOptions&);
template Mesh<3, float, Tet4> tetrahedralize<float>(const std::filesystem::path&, const TetrahedralizeOptions&);

} // namespace springfit::cgal
