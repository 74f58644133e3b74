// SPDX-License-Identifier: BSD-3-Clause
// Models of Tri3 cells.

namespace springfit::fem {

SPRINGFIT_INSTANTIATION class Model<2, double, Tri3, LinearElastic>;
SPRINGFIT_INSTANTIATION class Model<2, double, Tri3, Corotated>;
SPRINGFIT_INSTANTIATION class Model<2, double, Tri3, StVenantKirchhoff>;
SPRINGFIT_INSTANTIATION class Model<2, double, Tri3, NeoHookean>;

} // namespace springfit::fem
