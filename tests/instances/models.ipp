// SPDX-License-Identifier: BSD-3-Clause
// Membranes that several tests compare with.

namespace springfit::fem {

SPRINGFIT_INSTANTIATION class Model<3, double, Tri3, StVenantKirchhoff>;

} // namespace springfit::fem
