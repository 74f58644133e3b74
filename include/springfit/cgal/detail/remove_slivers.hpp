// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CGAL/exude_mesh_3.h>
#include <CGAL/perturb_mesh_3.h>

#include <springfit/cgal/detail/solid_complex.hpp>

namespace springfit::cgal::detail {

SPRINGFIT_CGAL_INLINE void SolidMesher::remove_slivers(SolidComplex& solid, double angle) {
    without_failure([&] {
        CGAL::perturb_mesh_3(solid.complex, *m_state->domain, CGAL::parameters::sliver_bound = angle);
        CGAL::exude_mesh_3(solid.complex, CGAL::parameters::sliver_bound = angle);
    });
}

} // namespace springfit::cgal::detail
