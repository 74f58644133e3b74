// SPDX-License-Identifier: BSD-3-Clause
// Models of Tet4 cells.

namespace springfit::fem {

SPRINGFIT_INSTANTIATION class Model<3, double, Tet4, LinearElastic>;
SPRINGFIT_INSTANTIATION class Model<3, double, Tet4, Corotated>;
SPRINGFIT_INSTANTIATION class Model<3, double, Tet4, StVenantKirchhoff>;
SPRINGFIT_INSTANTIATION class Model<3, double, Tet4, NeoHookean>;

} // namespace springfit::fem
