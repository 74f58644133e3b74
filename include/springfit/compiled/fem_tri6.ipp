// SPDX-License-Identifier: BSD-3-Clause
// Models of Tri6 cells.

namespace springfit::fem {

SPRINGFIT_INSTANTIATION class Model<2, double, Tri6, LinearElastic>;
SPRINGFIT_INSTANTIATION class Model<2, double, Tri6, Corotated>;
SPRINGFIT_INSTANTIATION class Model<2, double, Tri6, StVenantKirchhoff>;
SPRINGFIT_INSTANTIATION class Model<2, double, Tri6, NeoHookean>;

} // namespace springfit::fem
