// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cgal/detail/triangulate_impl.hpp>

// What springfit::compiled_cgal holds of the templates in springfit/cgal/triangulate.hpp; it alone includes this.
namespace springfit::cgal {

template Mesh<2, double, Tri3> triangulate<double>(const Outline&, const TriangulateOptions&);
template Mesh<2, double, Tri3> triangulate<double>(const std::filesystem::path&, const TriangulateOptions&);
template Mesh<2, float, Tri3> triangulate<float>(const Outline&, const TriangulateOptions&);
template Mesh<2, float, Tri3> triangulate<float>(const std::filesystem::path&, const TriangulateOptions&);

} // namespace springfit::cgal
