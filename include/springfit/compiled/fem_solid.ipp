// SPDX-License-Identifier: BSD-3-Clause
// Models of solid elements.

namespace springfit::fem {

SPRINGFIT_INSTANTIATION class Model<3, double, Tet4, LinearElastic>;
SPRINGFIT_INSTANTIATION class Model<3, double, Tet4, Corotated>;
SPRINGFIT_INSTANTIATION class Model<3, double, Tet4, StVenantKirchhoff>;
SPRINGFIT_INSTANTIATION class Model<3, double, Tet4, NeoHookean>;
SPRINGFIT_INSTANTIATION class Model<3, double, Tet10, LinearElastic>;
SPRINGFIT_INSTANTIATION class Model<3, double, Tet10, Corotated>;
SPRINGFIT_INSTANTIATION class Model<3, double, Tet10, StVenantKirchhoff>;
SPRINGFIT_INSTANTIATION class Model<3, double, Tet10, NeoHookean>;
SPRINGFIT_INSTANTIATION class Model<3, double, Hex8, LinearElastic>;
SPRINGFIT_INSTANTIATION class Model<3, double, Hex8, Corotated>;
SPRINGFIT_INSTANTIATION class Model<3, double, Hex8, StVenantKirchhoff>;
SPRINGFIT_INSTANTIATION class Model<3, double, Hex8, NeoHookean>;

} // namespace springfit::fem
