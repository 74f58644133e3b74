// SPDX-License-Identifier: BSD-3-Clause
#include "body/example.hpp"

#undef SPRINGFIT_INSTANTIATION
#define SPRINGFIT_INSTANTIATION template
#include "example.ipp"
