// SPDX-License-Identifier: BSD-3-Clause
#include "example.hpp"

#undef SPRINGFIT_INSTANTIATION
#define SPRINGFIT_INSTANTIATION template
#include "example.ipp"
