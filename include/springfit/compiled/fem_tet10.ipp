// SPDX-License-Identifier: BSD-3-Clause
// Models of Tet10 cells.

namespace springfit::fem {

SPRINGFIT_INSTANTIATION class Model<3, double, Tet10, LinearElastic>;
SPRINGFIT_INSTANTIATION class Model<3, double, Tet10, Corotated>;
SPRINGFIT_INSTANTIATION class Model<3, double, Tet10, StVenantKirchhoff>;
SPRINGFIT_INSTANTIATION class Model<3, double, Tet10, NeoHookean>;

} // namespace springfit::fem
