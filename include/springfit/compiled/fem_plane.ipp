// SPDX-License-Identifier: BSD-3-Clause
// Models of plane elements.

namespace springfit::fem {

SPRINGFIT_INSTANTIATION class Model<2, double, Tri3, LinearElastic>;
SPRINGFIT_INSTANTIATION class Model<2, double, Tri3, Corotated>;
SPRINGFIT_INSTANTIATION class Model<2, double, Tri3, StVenantKirchhoff>;
SPRINGFIT_INSTANTIATION class Model<2, double, Tri3, NeoHookean>;
SPRINGFIT_INSTANTIATION class Model<2, double, Tri6, LinearElastic>;
SPRINGFIT_INSTANTIATION class Model<2, double, Tri6, Corotated>;
SPRINGFIT_INSTANTIATION class Model<2, double, Tri6, StVenantKirchhoff>;
SPRINGFIT_INSTANTIATION class Model<2, double, Tri6, NeoHookean>;
SPRINGFIT_INSTANTIATION class Model<2, double, Quad4, LinearElastic>;
SPRINGFIT_INSTANTIATION class Model<2, double, Quad4, Corotated>;
SPRINGFIT_INSTANTIATION class Model<2, double, Quad4, StVenantKirchhoff>;
SPRINGFIT_INSTANTIATION class Model<2, double, Quad4, NeoHookean>;

} // namespace springfit::fem
