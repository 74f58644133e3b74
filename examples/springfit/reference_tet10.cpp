// SPDX-License-Identifier: BSD-3-Clause
#include "fem_reference.hpp"

namespace program {

std::unique_ptr<FemReference<3>> reference_tet10(const springfit::Mesh<3, double, springfit::Tet4>& mesh,
                                                 const FitOptions& options) {
    return make_for_material<3, springfit::Tet10>(mesh, options, springfit::fem::Dilatation::pointwise, "tet10");
}

} // namespace program
