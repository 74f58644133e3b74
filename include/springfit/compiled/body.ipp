// SPDX-License-Identifier: BSD-3-Clause
// Bodies laid out for real time.

namespace springfit {

SPRINGFIT_INSTANTIATION class SpringBody<2, double>;
SPRINGFIT_INSTANTIATION class SpringBody<3, double>;
SPRINGFIT_INSTANTIATION class SpringBatch<2, double>;
SPRINGFIT_INSTANTIATION class SpringBatch<3, double>;
SPRINGFIT_INSTANTIATION class ImplicitBody<2, double>;
SPRINGFIT_INSTANTIATION class ImplicitBody<3, double>;
SPRINGFIT_INSTANTIATION class ProjectiveBody<2, double>;
SPRINGFIT_INSTANTIATION class ProjectiveBody<3, double>;

} // namespace springfit
