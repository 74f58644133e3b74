// SPDX-License-Identifier: BSD-3-Clause
#include "fit_data.hpp"

#undef SPRINGFIT_INSTANTIATION
#define SPRINGFIT_INSTANTIATION template
#include "fit_data.ipp"
