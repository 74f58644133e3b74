// SPDX-License-Identifier: BSD-3-Clause
// Statics and dynamics of elastic bodies, and the load cases that both are asked for.

namespace springfit::fem {

SPRINGFIT_INSTANTIATION class Statics<2, double>;
SPRINGFIT_INSTANTIATION class Statics<2, float>;
SPRINGFIT_INSTANTIATION class Statics<3, double>;
SPRINGFIT_INSTANTIATION class Statics<3, float>;
SPRINGFIT_INSTANTIATION class Dynamics<2, double>;
SPRINGFIT_INSTANTIATION class Dynamics<2, float>;
SPRINGFIT_INSTANTIATION class Dynamics<3, double>;
SPRINGFIT_INSTANTIATION class Dynamics<3, float>;

} // namespace springfit::fem
