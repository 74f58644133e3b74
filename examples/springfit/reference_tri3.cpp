// SPDX-License-Identifier: BSD-3-Clause
#include "fem_reference.hpp"

namespace program {

std::unique_ptr<FemReference<2>> reference_tri3(const springfit::Mesh<2, double, springfit::Tri3>& mesh,
                                                const FitOptions& options) {
    return make_for_material<2, springfit::Tri3>(mesh, options, springfit::fem::Dilatation::pointwise, "tri3");
}

} // namespace program
