// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cgal/detail/interpolation_impl.hpp>

// What springfit::compiled_cgal holds of the templates in springfit/cgal/interpolation.hpp; it alone includes this.
namespace springfit::cgal {

template Interpolation<double> interpolation(const Mesh<2, double, Tri3>&, const Points<2, double>&, double);
template Interpolation<double> interpolation(const Mesh<3, double, Tet4>&, const Points<3, double>&, double);
template Interpolation<float> interpolation(const Mesh<2, float, Tri3>&, const Points<2, float>&, float);
template Interpolation<float> interpolation(const Mesh<3, float, Tet4>&, const Points<3, float>&, float);

} // namespace springfit::cgal
