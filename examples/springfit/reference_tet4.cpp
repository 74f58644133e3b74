// SPDX-License-Identifier: BSD-3-Clause
#include "fem_reference.hpp"

namespace program {

std::unique_ptr<FemReference<3>> reference_tet4(const springfit::Mesh<3, double, springfit::Tet4>& mesh,
                                                const FitOptions& options, springfit::fem::Dilatation dilatation) {
    const bool mean = dilatation == springfit::fem::Dilatation::mean;
    return make_for_material<3, springfit::Tet4>(mesh, options, dilatation, mean ? "tet4-mean-dilatation" : "tet4");
}

} // namespace program
