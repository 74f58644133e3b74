// SPDX-License-Identifier: BSD-3-Clause
#include "fem_reference.hpp"

namespace program {

std::unique_ptr<FemReference<3>> reference_hex8(const springfit::Mesh<3, double, springfit::Hex8>& mesh,
                                                const FitOptions& options) {
    return make_for_material<3, springfit::Hex8>(mesh, options, springfit::fem::Dilatation::mean, "hex8");
}

} // namespace program
