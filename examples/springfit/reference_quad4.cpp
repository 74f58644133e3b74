// SPDX-License-Identifier: BSD-3-Clause
#include "fem_reference.hpp"

namespace program {

std::unique_ptr<FemReference<2>> reference_quad4(const springfit::Mesh<2, double, springfit::Quad4>& mesh,
                                                 const FitOptions& options) {
    return make_for_material<2, springfit::Quad4>(mesh, options, springfit::fem::Dilatation::pointwise, "quad4");
}

} // namespace program
