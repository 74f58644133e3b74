// SPDX-License-Identifier: BSD-3-Clause
// Membranes, and models in single precision.

namespace springfit::fem {

SPRINGFIT_INSTANTIATION class Model<3, double, Tri3, LinearElastic>;
SPRINGFIT_INSTANTIATION class Model<3, float, Tri3, LinearElastic>;
SPRINGFIT_INSTANTIATION class Model<2, float, Tri6, LinearElastic>;
SPRINGFIT_INSTANTIATION class Model<3, float, Tet4, LinearElastic>;
SPRINGFIT_INSTANTIATION class Model<3, double, Tri3, Corotated>;
SPRINGFIT_INSTANTIATION class Model<3, float, Tri3, Corotated>;
SPRINGFIT_INSTANTIATION class Model<2, float, Tri6, Corotated>;
SPRINGFIT_INSTANTIATION class Model<3, float, Tet4, Corotated>;
SPRINGFIT_INSTANTIATION class Model<3, double, Tri3, StVenantKirchhoff>;
SPRINGFIT_INSTANTIATION class Model<3, float, Tri3, StVenantKirchhoff>;
SPRINGFIT_INSTANTIATION class Model<2, float, Tri6, StVenantKirchhoff>;
SPRINGFIT_INSTANTIATION class Model<3, float, Tet4, StVenantKirchhoff>;
SPRINGFIT_INSTANTIATION class Model<3, double, Tri3, NeoHookean>;
SPRINGFIT_INSTANTIATION class Model<3, float, Tri3, NeoHookean>;
SPRINGFIT_INSTANTIATION class Model<2, float, Tri6, NeoHookean>;
SPRINGFIT_INSTANTIATION class Model<3, float, Tet4, NeoHookean>;

} // namespace springfit::fem
