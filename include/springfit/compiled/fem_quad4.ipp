// SPDX-License-Identifier: BSD-3-Clause
// Models of Quad4 cells.

namespace springfit::fem {

SPRINGFIT_INSTANTIATION class Model<2, double, Quad4, LinearElastic>;
SPRINGFIT_INSTANTIATION class Model<2, double, Quad4, Corotated>;
SPRINGFIT_INSTANTIATION class Model<2, double, Quad4, StVenantKirchhoff>;
SPRINGFIT_INSTANTIATION class Model<2, double, Quad4, NeoHookean>;

} // namespace springfit::fem
