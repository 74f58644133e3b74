// SPDX-License-Identifier: BSD-3-Clause
// Statics and dynamics of elastic bodies.

namespace springfit::fem {

SPRINGFIT_INSTANTIATION class Statics<2, double>;
SPRINGFIT_INSTANTIATION class Statics<3, double>;
SPRINGFIT_INSTANTIATION class Dynamics<2, double>;
SPRINGFIT_INSTANTIATION class Dynamics<3, double>;

} // namespace springfit::fem
