// SPDX-License-Identifier: BSD-3-Clause
// Linked with the examples that calibrate, where CHOLMOD is there: their sparse factors are then the program's.

#include <springfit/cholmod/supernodal_factor.hpp>

namespace {

[[maybe_unused]] const bool in_use = (springfit::cholmod::use_supernodal_factors(), true);

} // namespace
