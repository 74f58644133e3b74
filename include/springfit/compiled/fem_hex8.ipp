// SPDX-License-Identifier: BSD-3-Clause
// Models of Hex8 cells.

namespace springfit::fem {

SPRINGFIT_INSTANTIATION class Model<3, double, Hex8, LinearElastic>;
SPRINGFIT_INSTANTIATION class Model<3, double, Hex8, Corotated>;
SPRINGFIT_INSTANTIATION class Model<3, double, Hex8, StVenantKirchhoff>;
SPRINGFIT_INSTANTIATION class Model<3, double, Hex8, NeoHookean>;

} // namespace springfit::fem
